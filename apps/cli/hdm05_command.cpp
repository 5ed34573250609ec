// kinebase hdm05: what HDM05 holds, and whether a copy of it does.

#include <algorithm>
#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/hdm05_report.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/library/hdm05.h"
#include "kinebase/library/hdm05_check.h"

namespace kinebase::cli {
namespace {

constexpr double kRateHz = 120;

struct Hdm05Options {
  CommonOptions common;
  std::vector<std::string> words;
  std::string actor;
  int part = 0;  // 0: all.
  std::filesystem::path folder;
  bool missing = false;

  [[nodiscard]] Hdm05Query query() const {
    return {.words = fmt::format("{}", fmt::join(words, " ")),
            .actor = actor,
            .part = part == 0 ? std::nullopt : std::optional(part)};
  }
};

Json NumberOrNull(std::optional<std::int64_t> number) { return number ? Json(*number) : Json(); }

std::string NumberOrBlank(std::optional<std::int64_t> number) {
  return number ? std::to_string(*number) : "";
}

// "2-3 Shelf (while standing)"; "6-1" for freestyle.
std::string TitleOf(const Hdm05Match& match) {
  return fmt::format("{}-{}{}{}", match.part, match.scene, match.script == nullptr ? "" : " ",
                     match.script == nullptr ? "" : match.script->title);
}

std::vector<int> NumbersOf(const std::vector<const Hdm05Step*>& steps) {
  std::vector<int> numbers;
  numbers.reserve(steps.size());
  for (const Hdm05Step* step : steps) numbers.push_back(step->number);
  return numbers;
}

Json ToJson(const Hdm05Match& match, const Hdm05Take& take) {
  return {{"take", take.name()},
          {"actor", take.actor},
          {"part", take.part},
          {"scene", take.scene},
          {"number", take.take},
          {"frames", NumberOrNull(take.frame_count)},
          {"title", match.script == nullptr ? "" : match.script->title},
          {"steps", NumbersOf(match.steps)},
          {"description", take.description},
          {"comment", take.defect.text}};
}

// What to say where nothing has the words: results stay empty.
void PrintNothingFound(const Hdm05Options& options, std::string_view what) {
  PrintNote(options.common,
            fmt::format("no {} has all of these words: {}", what, fmt::join(options.words, " ")));
}

int PrintTakes(const Hdm05Options& options) {
  TextTable table({"take", ">frames", ">s", "scene", "steps", "about"});
  Json takes = Json::array();
  for (const Hdm05Match& match : FindHdm05Takes(options.query())) {
    for (const Hdm05Take* take : match.takes) {
      takes.push_back(ToJson(match, *take));
      const auto frames = take->frame_count;
      const bool both = !take->description.empty() && !take->defect.text.empty();
      table.Add({take->name(), NumberOrBlank(frames),
                 frames ? fmt::format("{:.1f}", static_cast<double>(*frames) / kRateHz) : "",
                 TitleOf(match), fmt::format("{}", fmt::join(NumbersOf(match.steps), ", ")),
                 take->description + (both ? "; " : "") + take->defect.text});
    }
  }
  const bool none = takes.empty();
  if (options.common.json) {
    PrintJson({{"takes", std::move(takes)}});
  } else if (none) {
    PrintNothingFound(options, "take");
  } else {
    Print(table.ToString());
  }
  return kDone;
}

std::string PartTitle(int part) {
  const auto& parts = Hdm05().parts;
  const auto found = std::ranges::find(parts, part, &Hdm05Part::part);
  return found == parts.end() ? "" : found->title;
}

Json ToJson(const Hdm05Match& match) {
  Json steps = Json::array();
  for (const Hdm05Step& step : match.script->steps) {
    steps.push_back({{"step", step.number}, {"text", step.text}, {"classes", step.classes}});
  }
  Json takes = Json::array();
  for (const Hdm05Take* take : match.takes) takes.push_back(take->name());
  return {{"part", match.part},        {"part_title", PartTitle(match.part)},
          {"scene", match.scene},      {"title", match.script->title},
          {"steps", std::move(steps)}, {"found_steps", NumbersOf(match.steps)},
          {"takes", std::move(takes)}};
}

// A scene with all its steps, or those where the words are.
std::string Describe(const Hdm05Match& match) {
  std::string text = fmt::format("{}, {}\n", TitleOf(match),
                                 FormatCount(std::ssize(match.takes), "take", "takes"));
  for (const Hdm05Step& step : match.script->steps) {
    if (!match.steps.empty() && std::ranges::find(match.steps, &step) == match.steps.end()) {
      continue;
    }
    text += fmt::format("  {:>2}  {}\n", step.number, step.text);
    if (!step.classes.empty()) text += fmt::format("        {}\n", fmt::join(step.classes, " "));
  }
  return text;
}

int PrintScenes(const Hdm05Options& options) {
  Json scenes = Json::array();
  std::string text;
  for (const Hdm05Match& match : FindHdm05Takes(options.query())) {
    if (match.script == nullptr) continue;  // Freestyle has no scenes.
    if (scenes.empty() || scenes.back()["part"] != match.part) {
      text += fmt::format("Part {}: {}\n", match.part, PartTitle(match.part));
    }
    scenes.push_back(ToJson(match));
    text += Describe(match);
  }
  if (options.common.json) {
    PrintJson({{"scenes", std::move(scenes)}});
  } else if (text.empty()) {
    PrintNothingFound(options, "scene");
  } else {
    Print(text);
  }
  return kDone;
}

std::vector<std::string> ActorIds() {
  std::vector<std::string> ids;
  for (const Hdm05Actor& actor : Hdm05().actors) ids.push_back(actor.id);
  return ids;
}

int PrintClasses(const Hdm05Options& options) {
  std::vector<std::string> titles = {"class", ">clips"};
  for (const std::string& id : ActorIds()) titles.push_back('>' + id);
  titles.insert(titles.end(), {"description", "comment"});
  TextTable table(titles);
  Json classes = Json::array();
  for (const Hdm05Class* motion_class : FindHdm05Classes(options.query().words)) {
    Json actors = Json::object();
    std::vector<std::string> cells = {motion_class->name, std::to_string(motion_class->clip_count)};
    for (std::size_t i = 0; i < ActorIds().size(); ++i) {
      actors[ActorIds()[i]] = motion_class->clips_of_actor[i];
      cells.push_back(std::to_string(motion_class->clips_of_actor[i]));
    }
    cells.insert(cells.end(), {motion_class->description, motion_class->defect.text});
    table.Add(std::move(cells));
    classes.push_back({{"class", motion_class->name},
                       {"clips", motion_class->clip_count},
                       {"actors", std::move(actors)},
                       {"description", motion_class->description},
                       {"comment", motion_class->defect.text}});
  }
  const bool none = classes.empty();
  if (options.common.json) {
    PrintJson({{"classes", std::move(classes)}});
  } else if (none) {
    PrintNothingFound(options, "motion class");
  } else {
    Print(table.ToString());
  }
  return kDone;
}

int PrintVideos(const Hdm05Options& options) {
  TextTable table({"video", "take", ">first", ">last", "comment"});
  Json videos = Json::array();
  for (const Hdm05Video& video : Hdm05().videos) {
    table.Add({video.file, video.take, NumberOrBlank(video.first_frame),
               NumberOrBlank(video.last_frame), video.comment});
    videos.push_back({{"video", video.file},
                      {"take", video.take.empty() ? Json() : Json(video.take)},
                      {"first_frame", NumberOrNull(video.first_frame)},
                      {"last_frame", NumberOrNull(video.last_frame)},
                      {"comment", video.comment}});
  }
  if (options.common.json) {
    PrintJson({{"videos", std::move(videos)}});
  } else {
    Print(table.ToString());
  }
  return kDone;
}

int Check(const Hdm05Options& options) {
  const Stopwatch watch;
  const Hdm05Report report =
      CheckHdm05(options.folder, options.common.threads, MakeProgress(options.common));
  for (const Hdm05Finding* finding : report.FindingsOf(Hdm05FindingKind::kUnreadable)) {
    PrintError(finding->message);
  }
  const bool usable =
      report.readable_count > 0 || report.FindingsOf(Hdm05FindingKind::kUnreadable).empty();
  if (!usable) return kCouldNot;
  if (options.common.json) {
    PrintJson(Hdm05ReportJson(report, watch.seconds()));
  } else {
    Print(Hdm05ReportText(report, options.missing));
  }
  return report.HasFaults() ? kPartFailed : kDone;
}

using Action = int (*)(const Hdm05Options&);

CLI::App* AddAction(CLI::App& parent, const std::shared_ptr<Hdm05Options>& options, int& exit_code,
                    const char* name, const char* description, Action action) {
  CLI::App* command = parent.add_subcommand(name, description);
  AddOutputOptions(*command, options->common);
  command->callback([options, &exit_code, action] { exit_code = action(*options); });
  return command;
}

void AddWords(CLI::App& command, Hdm05Options& options, const char* what) {
  command.add_option("WORDS", options.words, what);
}

void AddTakeFilter(CLI::App& command, Hdm05Options& options) {
  command.add_option("--actor", options.actor, "Takes of this actor only")
      ->check(OneOf(ActorIds()))
      ->type_name("ACTOR");
  command.add_option("--part", options.part, "This part of the script only; 6 to 8 are freestyle")
      ->check(WholeNumber(1, 8))
      ->type_name("N");
}

}  // namespace

void AddHdm05Command(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<Hdm05Options>();
  CLI::App* command =
      program.add_subcommand("hdm05", "What the HDM05 database holds, and whether a copy does");
  command->require_subcommand(1);
  command->footer("Example:\n  kinebase hdm05 check ~/HDM05");

  CLI::App* check = AddAction(*command, options, exit_code, "check",
                              "Compare a copy, whole or in part, with the documentation", &Check);
  check->add_option("FOLDER", options->folder, "Folder with the copy")->required();
  check->add_flag("--missing", options->missing, "List all files that are missing");
  AddThreadsOption(*check, options->common);
  check->footer("Example:\n  kinebase hdm05 check ~/HDM05 --missing");

  CLI::App* takes = AddAction(*command, options, exit_code, "takes",
                              "List takes, all or those whose script has some words", &PrintTakes);
  AddWords(*takes, *options, "Words of the script; the beginning of a word will do");
  AddTakeFilter(*takes, *options);
  takes->footer("Example:\n  kinebase hdm05 takes grab item from shelf --actor bd");

  CLI::App* scenes = AddAction(*command, options, exit_code, "scenes",
                               "Show the script, step by step", &PrintScenes);
  AddWords(*scenes, *options, "Words of the script; the beginning of a word will do");
  AddTakeFilter(*scenes, *options);
  scenes->footer("Example:\n  kinebase hdm05 scenes rotate arms");

  CLI::App* classes = AddAction(*command, options, exit_code, "classes",
                                "List motion classes with their clips", &PrintClasses);
  AddWords(*classes, *options, "Words of a class's name or description");
  classes->footer("Example:\n  kinebase hdm05 classes kick");

  CLI::App* videos = AddAction(*command, options, exit_code, "videos",
                               "List videos with the frames that they show", &PrintVideos);
  videos->footer("Example:\n  kinebase hdm05 videos");
}

}  // namespace kinebase::cli
