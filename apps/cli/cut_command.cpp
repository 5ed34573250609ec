// kinebase cut: clips out of takes, as cut files say.

#include <algorithm>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "kinebase/library/cutting.h"

namespace kinebase::cli {
namespace {

struct CutCommandOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> lists;
  CutListOptions list;
  CutOptions cut;
  std::string type;
};

std::string_view ToString(ClipState state) {
  switch (state) {
    case ClipState::kNew:
      return "new";
    case ClipState::kUnchanged:
      return "unchanged";
    case ClipState::kReplaced:
      return "replaced";
  }
  return "";
}

Json ToJson(const CutReport& report, bool dry_run) {
  Json clips = Json::array();
  for (const CutClip& clip : report.clips) {
    clips.push_back({{"file", clip.file.string()},
                     {"source", clip.source.string()},
                     {"first_frame", clip.first_frame},
                     {"last_frame", clip.last_frame},
                     {"state", ToString(clip.state)}});
  }
  Json skeletons = Json::array();
  for (const auto& file : report.skeletons) skeletons.push_back(file.string());
  Json json = {
      {"clips", std::move(clips)}, {"skeletons", std::move(skeletons)}, {"dry_run", dry_run}};
  if (report.failures.empty()) return json;
  Json failed = Json::array();
  for (const auto& [file, error] : report.failures) {
    failed.push_back({{"file", file.string()}, {"message", error.what()}});
  }
  json["failed"] = std::move(failed);
  return json;
}

std::string ToText(const CutReport& report) {
  TextTable table({"clip", ">frames", "source", "state"});
  for (const CutClip& clip : report.clips) {
    table.Add({clip.file.string(), fmt::format("{}-{}", clip.first_frame, clip.last_frame),
               clip.source.string(), std::string(ToString(clip.state))});
  }
  return table.ToString();
}

std::string Summary(const CutReport& report, bool dry_run) {
  const auto count = [&](ClipState state) {
    return std::ranges::count(report.clips, state, &CutClip::state);
  };
  std::string text = FormatCount(std::ssize(report.clips), "clip", "clips");
  text += fmt::format(": {} new", count(ClipState::kNew));
  for (const ClipState state : {ClipState::kUnchanged, ClipState::kReplaced}) {
    if (count(state) > 0) text += fmt::format(", {} {}", count(state), ToString(state));
  }
  if (!report.failures.empty()) text += fmt::format("; {} failed", report.failures.size());
  return text + (dry_run ? "; nothing was written, as asked" : "");
}

int Run(CutCommandOptions& options) {
  const CutList list = ReadCutLists(options.lists, options.list);
  if (list.unquoted_lines > 0) {
    PrintNote(options.common,
              fmt::format("{}: {} without quotes from here on passed over; --unquoted takes them",
                          list.first_unquoted_line.ToString(),
                          FormatCount(list.unquoted_lines, "line that looks like a cut",
                                      "lines that look like cuts")));
  }
  if (!options.type.empty()) {
    options.cut.type = options.type == "amc" ? ClipType::kAmc : ClipType::kC3d;
  }
  options.cut.skeleton = options.common.load.skeleton;
  options.cut.strict = options.common.load.strict;
  options.cut.overwrite = options.common.overwrite();
  options.cut.threads = options.common.threads;
  options.cut.progress = MakeProgress(options.common);
  const CutReport report = CutClips(list, options.cut);

  for (const auto& [file, diagnostic] : report.notes) {
    PrintDiagnostics(options.common, file, {diagnostic});
  }
  for (const CutFailure& failure : report.failures) PrintError(failure.error.what());
  if (report.clips.empty()) return kCouldNot;
  if (options.common.json) {
    PrintJson(ToJson(report, options.cut.dry_run));
  } else {
    Print(ToText(report));
    PrintNote(options.common, Summary(report, options.cut.dry_run));
  }
  return report.failures.empty() ? kDone : kPartFailed;
}

}  // namespace

void AddCutCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<CutCommandOptions>();
  CLI::App* command = program.add_subcommand("cut", "Cut clips out of takes by HDM05 cut files");
  command->add_option("CUTS", options->lists, "Cut files, or folders with *.txt files")->required();
  command->add_option("--in", options->cut.in, "Folder that the takes' names begin in")
      ->required()
      ->type_name("FOLDER");
  command->add_option("--out", options->cut.out, "Folder for the clips")
      ->required()
      ->type_name("FOLDER");
  command
      ->add_option("--type", options->type,
                   "Only clips of this type (default: all that a take has)")
      ->check(OneOf({"amc", "c3d"}))
      ->type_name("amc|c3d");
  command->add_flag("--unquoted", options->list.unquoted, "Also take lines without quotes");
  command->add_flag("--dry-run", options->cut.dry_run, "Do everything but write");
  command->add_option("--skeleton", options->common.load.skeleton, "Skeleton of all takes (ASF)")
      ->type_name("FILE");
  command->add_flag("--strict", options->common.load.strict, "Refuse takes that would be repaired");
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddForceOption(*command, options->common);
  command->footer("Example:\n  kinebase cut cuts.txt --in HDM05 --out clips --dry-run");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
