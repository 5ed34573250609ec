// kinebase library templates, annotations: what is kept in a library beside its takes.

#include <algorithm>

#include "cli/library_actions.h"
#include "fmt/format.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_templates.h"
#include "kinebase/templates/template_file.h"

namespace kinebase::cli {
namespace {

int AddTemplates(const LibraryOptions& options) {
  std::vector<MotionTemplate> templates;
  templates.reserve(options.add.size());
  for (const std::string& file : options.add) templates.push_back(ReadTemplate(file));
  StoreTemplates(options.library, templates, options.common.overwrite());
  if (options.common.json) {
    PrintJson({{"stored", templates.size()}});
  } else {
    Print(fmt::format("{} stored\n", FormatCount(std::ssize(templates), "template", "templates")));
  }
  return kDone;
}

int RemoveTemplates(const LibraryOptions& options) {
  kinebase::RemoveTemplates(options.library, options.remove);
  if (options.common.json) {
    PrintJson({{"removed", options.remove}});
  } else {
    Print(fmt::format("{} removed\n",
                      FormatCount(std::ssize(options.remove), "template", "templates")));
  }
  return kDone;
}

int ExportTemplate(const LibraryOptions& options) {
  const bool is_printed = IsStandardOutput(options.output);
  if (!is_printed) CheckWritable(options.output, options.common.overwrite());
  const std::string json = FormatTemplate(LoadTemplate(options.library, options.name));
  WriteTextOrPrint(options.output, json, options.common);
  if (!is_printed && options.common.json) {
    PrintJson({{"file", options.output.string()}});
  } else if (!is_printed) {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

int ShowTemplates(const LibraryOptions& options) {
  const std::vector<StoredTemplate> templates = ListTemplates(options.library);
  Json json = {{"templates", Json::array()}};
  TextTable table({"template", "feature set", ">columns", "stored"});
  std::vector<TakeFailure> failures;
  for (const StoredTemplate& stored : templates) {
    try {
      const MotionTemplate read = ParseStoredTemplate(stored, options.library);
      json["templates"].push_back({{"name", stored.name},
                                   {"feature_set", read.feature_set},
                                   {"columns", read.matrix.column_count()},
                                   {"stored", TextOrNull(FormatDate(stored.stored_s))}});
      table.Add({stored.name, read.feature_set, std::to_string(read.matrix.column_count()),
                 FormatDate(stored.stored_s)});
    } catch (const Error& error) {
      failures.push_back({"", error});
    }
  }
  PrintFailures(failures);
  if (options.common.json) {
    AddFailures(failures, json);
    PrintJson(json);
  } else if (failures.size() < templates.size()) {
    Print(table.ToString());
  }
  PrintNote(options.common, FormatCount(std::ssize(templates), "template", "templates"));
  return ExitCodeOf(failures);
}

int Templates(const LibraryOptions& options) {
  if (!options.add.empty()) return AddTemplates(options);
  if (!options.remove.empty()) return RemoveTemplates(options);
  if (!options.name.empty()) return ExportTemplate(options);
  if (!options.output.empty()) throw UsageError("-o needs --export NAME");
  return ShowTemplates(options);
}

int AddAnnotations(const LibraryOptions& options) {
  const MappedFile file(options.table);
  const AnnotationReport report =
      StoreAnnotations(options.library, options.choice,
                       ParseAnnotationTable(file.text(), options.table), options.table);
  if (options.common.json) {
    PrintJson({{"stored", report.stored}, {"passed_over", report.passed_over}});
    return kDone;
  }
  Print(fmt::format("{} stored\n", FormatCount(report.stored, "annotation", "annotations")));
  if (report.passed_over > 0) {
    PrintNote(options.common, fmt::format("{} of recordings that are not among these takes",
                                          FormatCount(report.passed_over, "row", "rows")));
  }
  return kDone;
}

int DropAnnotations(const LibraryOptions& options) {
  const std::int64_t removed = RemoveAnnotations(options.library, options.choice, options.remove);
  if (options.common.json) {
    PrintJson({{"removed", removed}});
  } else {
    Print(fmt::format("{} removed\n", FormatCount(removed, "annotation", "annotations")));
  }
  return kDone;
}

Json ToJson(const StoredAnnotation& annotation) {
  const auto number_or_null = [](const std::optional<double>& number) {
    return number ? Json(*number) : Json();
  };
  return {{"file", annotation.path.string()},
          {"class", annotation.class_name},
          {"first_frame", annotation.first_frame},
          {"last_frame", annotation.last_frame},
          {"cost", number_or_null(annotation.cost)},
          {"confidence", number_or_null(annotation.confidence)},
          {"template", TextOrNull(annotation.template_name)},
          {"stored", TextOrNull(FormatDate(annotation.stored_s))}};
}

std::string AnnotationTable(std::span<const StoredAnnotation> annotations) {
  TextTable table({"class", ">frames", ">cost", ">confidence", "template", "file"});
  const auto number = [](const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string();
  };
  for (const StoredAnnotation& each : annotations) {
    table.Add({each.class_name, fmt::format("{}-{}", each.first_frame, each.last_frame),
               number(each.cost, 4), number(each.confidence, 2), each.template_name,
               each.path.string()});
  }
  return table.ToString();
}

int ShowAnnotations(const LibraryOptions& options) {
  const bool is_printed = IsStandardOutput(options.output);
  if (!is_printed) CheckWritable(options.output, options.common.overwrite());
  const auto [annotations, failures] = ListAnnotations(options.library, options.choice);
  PrintFailures(failures);
  if (!options.output.empty()) {
    WriteTextOrPrint(options.output,
                     FormatAnnotationTable(annotations, TakeLibrary(options.library).takes()),
                     options.common);
    if (!is_printed && !options.common.json) PrintWritten(options.common, options.output);
  }
  if (options.common.json) {
    Json json = {{"annotations", Json::array()}};
    for (const StoredAnnotation& each : annotations) json["annotations"].push_back(ToJson(each));
    AddFailures(failures, json);
    PrintJson(json);
  } else if (options.output.empty()) {
    if (!annotations.empty()) Print(AnnotationTable(annotations));
    PrintNote(options.common, FormatCount(std::ssize(annotations), "annotation", "annotations"));
  }
  return ExitCodeOf(failures);
}

int Annotations(const LibraryOptions& options) {
  if (!options.table.empty()) return AddAnnotations(options);
  if (options.is_removing) return DropAnnotations(options);
  if (options.common.json && IsStandardOutput(options.output) && !options.output.empty()) {
    throw UsageError("--json needs -o FILE");
  }
  return ShowAnnotations(options);
}

void AddTemplatesAction(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                        int& exit_code) {
  CLI::App* templates = AddLibraryAction(command, options, exit_code, "templates", &Templates);
  templates->description("Motion templates that are kept in the library: list, add, take out");
  CLI::Option* add = templates->add_option("--add", options->add, "Template files to store");
  add->type_name("FILE...");
  CLI::Option* remove =
      templates->add_option("--remove", options->remove, "Names of templates to remove: a,b");
  remove->delimiter(',')->type_name("NAMES")->excludes(add);
  templates->add_option("--export", options->name, "Write the template of this name")
      ->type_name("NAME")
      ->excludes(add)
      ->excludes(remove);
  templates->add_option("-o,--output", options->output, "Its file (default, or -: standard output)")
      ->type_name("FILE");
  AddForceOption(*templates, options->common);
  templates->footer(
      "Examples:\n"
      "  kinebase library templates motion.kinebase\n"
      "  kinebase library templates motion.kinebase --add squat.template.json\n"
      "  kinebase library templates motion.kinebase --export squat -o squat.template.json");
}

void AddAnnotationsAction(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                          int& exit_code) {
  CLI::App* annotations =
      AddLibraryAction(command, options, exit_code, "annotations", &Annotations);
  annotations->description("What templates found in the takes: list, add, remove, export");
  AddTakeChoiceOptions(*annotations, options->choice);
  CLI::Option* from = annotations->add_option(
      "--from", options->table, "Add those of a table, as 'annotate --format csv' writes it");
  from->type_name("FILE");
  CLI::Option* remove =
      annotations->add_flag("--remove", options->is_removing, "Remove those of the takes");
  remove->excludes(from);
  annotations
      ->add_option("--of", options->remove, "With --remove: only those of these classes: a,b")
      ->delimiter(',')
      ->type_name("NAMES")
      ->needs(remove);
  annotations
      ->add_option("-o,--output", options->output,
                   "Write them as such a table (-: standard output)")
      ->type_name("FILE")
      ->excludes(from)
      ->excludes(remove);
  AddForceOption(*annotations, options->common);
  annotations->footer(
      "Examples:\n"
      "  kinebase library annotations motion.kinebase --from annotations.csv\n"
      "  kinebase library annotations motion.kinebase --actors bd -o annotations.csv\n"
      "  kinebase library annotations motion.kinebase --remove --of squat1Reps");
}

}  // namespace

void AddRecordActions(CLI::App& command, const std::shared_ptr<LibraryOptions>& options,
                      int& exit_code) {
  AddTemplatesAction(command, options, exit_code);
  AddAnnotationsAction(command, options, exit_code);
}

}  // namespace kinebase::cli
