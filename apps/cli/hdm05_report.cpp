#include "cli/hdm05_report.h"

#include <algorithm>
#include <set>

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace kinebase::cli {
namespace {

constexpr std::size_t kNamesShown = 5;      // Of what is missing, unless all are asked for.
constexpr std::size_t kFindingsShown = 20;  // Of one kind of little concern.

int CountPresent(const std::vector<Hdm05Presence>& files) {
  return static_cast<int>(std::ranges::count(files, Hdm05Presence::kFound));
}

std::vector<int> AllParts() {
  std::set<int> parts;
  for (const Hdm05Take& take : Hdm05().takes) parts.insert(take.part);
  return {parts.begin(), parts.end()};
}

std::string Share(int found, int expected) {
  return expected == 0 ? "" : fmt::format("{}/{}", found, expected);
}

bool HasAny(const Hdm05Report& report, Hdm05Format format) {
  return report.TakesFound(format) > 0 || report.ClipsFound(format) > 0;
}

// Takes by actor and part, clips by actor; empty without any file of the format.
std::string ShareTable(const Hdm05Report& report, Hdm05Format format) {
  if (!HasAny(report, format)) return "";
  std::vector<std::string> titles = {std::string(ToString(format))};
  for (const int part : AllParts()) titles.push_back(fmt::format(">part {}", part));
  titles.insert(titles.end(), {">takes", ">clips"});
  TextTable table(titles);
  for (std::size_t actor = 0; actor < Hdm05().actors.size(); ++actor) {
    const std::string& id = Hdm05().actors[actor].id;
    std::vector<std::string> cells = {id};
    for (const int part : AllParts()) {
      cells.push_back(Share(report.TakesFound(format, id, part), Hdm05().TakeCount(id, part)));
    }
    cells.push_back(Share(report.TakesFound(format, id), Hdm05().TakeCount(id)));
    cells.push_back(Share(report.ClipsFound(format, actor), Hdm05().ClipCount(actor)));
    table.Add(std::move(cells));
  }
  return '\n' + table.ToString();
}

// Classes of which some clips are there and some are not; the complete ones are only counted.
std::string ClassTable(const Hdm05Report& report, Hdm05Format format) {
  if (report.ClipsFound(format) == 0) return "";
  std::vector<std::string> titles = {fmt::format("incomplete as {}", ToString(format)), ">clips"};
  for (const Hdm05Actor& actor : Hdm05().actors) titles.push_back('>' + actor.id);
  TextTable table(titles);
  int complete = 0;
  int begun = 0;
  for (const Hdm05ClassStatus& status : report.classes) {
    if (status.found(format) == 0) continue;
    if (status.complete(format)) {
      ++complete;
      continue;
    }
    ++begun;
    std::vector<std::string> cells = {status.motion_class->name,
                                      Share(status.found(format), status.motion_class->clip_count)};
    for (std::size_t actor = 0; actor < Hdm05().actors.size(); ++actor) {
      cells.push_back(
          Share(status.found(format, actor), status.motion_class->clips_of_actor[actor]));
    }
    table.Add(std::move(cells));
  }
  const auto all = static_cast<int>(report.classes.size());
  return fmt::format("\nclasses as {}: {} complete, {} incomplete, {} not there\n{}",
                     ToString(format), complete, begun, all - complete - begun,
                     begun == 0 ? "" : table.ToString());
}

std::string MissingText(const Hdm05Report& report, Hdm05Format format, bool list_all) {
  if (!HasAny(report, format)) return "";
  std::string text;
  const auto add = [&](std::string_view what, const std::vector<std::string>& names) {
    if (names.empty()) return;
    text += fmt::format("\n{} missing as {}: {}\n", what, ToString(format), names.size());
    const std::size_t shown = list_all ? names.size() : std::min(names.size(), kNamesShown);
    for (std::size_t i = 0; i < shown; ++i) text += "  " + names[i] + '\n';
    if (shown < names.size()) text += "  … (--missing lists all)\n";
  };
  // Of what is not there at all the summary has said enough.
  if (list_all || report.TakesFound(format) > 0) add("takes", report.MissingTakes(format));
  if (list_all || report.ClipsFound(format) > 0) add("clips", report.MissingClips(format));
  return text;
}

std::string FindingsText(const Hdm05Report& report) {
  std::string text;
  for (const auto kind : {Hdm05FindingKind::kUnreadable, Hdm05FindingKind::kWrongFrameCount,
                          Hdm05FindingKind::kDamaged, Hdm05FindingKind::kExtra,
                          Hdm05FindingKind::kDuplicate, Hdm05FindingKind::kKnownDefect}) {
    const auto findings = report.FindingsOf(kind);
    if (findings.empty()) continue;
    text += fmt::format("\n{}: {}\n", ToString(kind), findings.size());
    const std::size_t shown = kind <= Hdm05FindingKind::kDamaged
                                  ? findings.size()
                                  : std::min(findings.size(), kFindingsShown);
    for (std::size_t i = 0; i < shown; ++i) {
      const bool names_file = kind == Hdm05FindingKind::kUnreadable;  // The reader's message does.
      text += names_file ? "  " + OnOneLine(findings[i]->message) + '\n'
                         : fmt::format("  {}: {}\n", OnOneLine(findings[i]->file.string()),
                                       OnOneLine(findings[i]->message));
    }
    if (shown < findings.size()) text += "  … (--json lists all)\n";
  }
  return text;
}

std::string Summary(const Hdm05Report& report) {
  std::string text = OnOneLine(report.folder.string()) + '\n';
  const auto line = [&](std::string_view name, const std::string& value) {
    text += fmt::format("  {:<11}{}\n", name, value);
  };
  const auto both = [&](auto count, int expected) {
    return fmt::format("{} of {} as AMC, {} as C3D", count(Hdm05Format::kAmc), expected,
                       count(Hdm05Format::kC3d));
  };
  line("takes",
       both([&](Hdm05Format format) { return report.TakesFound(format); }, Hdm05().TakeCount()));
  line("clips",
       both([&](Hdm05Format format) { return report.ClipsFound(format); }, Hdm05().ClipCount()));
  const auto missing = report.MissingSkeletons();
  line("skeletons",
       fmt::format("{} of {}{}", CountPresent(report.skeletons), report.skeletons.size(),
                   missing.empty() ? ""
                                   : fmt::format("; the AMC files here also need HDM_{}.asf",
                                                 fmt::join(missing, ".asf, HDM_"))));
  line("videos", fmt::format("{} of {}", CountPresent(report.videos), report.videos.size()));
  line("result", report.HasFaults() ? "some files are not as documented"
                                    : "all that is there is as documented");
  return text;
}

Json FindingsJson(const Hdm05Report& report, Hdm05FindingKind kind) {
  Json list = Json::array();
  for (const Hdm05Finding* finding : report.FindingsOf(kind)) {
    Json entry = {{"file", finding->file.string()}, {"message", finding->message}};
    if (finding->expected_frames) {
      entry["expected_frames"] = *finding->expected_frames;
      entry["frames"] = *finding->found_frames;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

// {"expected": 9, "amc": 3, "c3d": 0}
template <typename Count>
Json CountsJson(int expected, Count count) {
  return {
      {"expected", expected}, {"amc", count(Hdm05Format::kAmc)}, {"c3d", count(Hdm05Format::kC3d)}};
}

Json ActorsJson(const Hdm05Report& report) {
  Json actors = Json::array();
  for (std::size_t actor = 0; actor < Hdm05().actors.size(); ++actor) {
    const std::string& id = Hdm05().actors[actor].id;
    Json parts = Json::array();
    for (const int part : AllParts()) {
      if (Hdm05().TakeCount(id, part) == 0) continue;
      Json counts = {{"part", part}};
      counts.update(CountsJson(Hdm05().TakeCount(id, part), [&](Hdm05Format format) {
        return report.TakesFound(format, id, part);
      }));
      parts.push_back(std::move(counts));
    }
    actors.push_back(
        {{"actor", id},
         {"name", Hdm05().actors[actor].name},
         {"skeleton", report.skeletons[actor] == Hdm05Presence::kFound},
         {"takes", CountsJson(Hdm05().TakeCount(id),
                              [&](Hdm05Format format) { return report.TakesFound(format, id); })},
         {"parts", std::move(parts)},
         {"clips", CountsJson(Hdm05().ClipCount(actor), [&](Hdm05Format format) {
            return report.ClipsFound(format, actor);
          })}});
  }
  return actors;
}

Json ClassesJson(const Hdm05Report& report) {
  Json classes = Json::array();
  for (const Hdm05ClassStatus& status : report.classes) {
    Json actors = Json::object();
    for (std::size_t actor = 0; actor < Hdm05().actors.size(); ++actor) {
      actors[Hdm05().actors[actor].id] =
          CountsJson(status.motion_class->clips_of_actor[actor],
                     [&](Hdm05Format format) { return status.found(format, actor); });
    }
    Json entry = {{"class", status.motion_class->name}};
    entry.update(CountsJson(status.motion_class->clip_count,
                            [&](Hdm05Format format) { return status.found(format); }));
    entry["complete"] = {{"amc", status.complete(Hdm05Format::kAmc)},
                         {"c3d", status.complete(Hdm05Format::kC3d)}};
    entry["actors"] = std::move(actors);
    classes.push_back(std::move(entry));
  }
  return classes;
}

}  // namespace

Json Hdm05ReportJson(const Hdm05Report& report, double elapsed_s) {
  const auto missing = [&](Hdm05Format format) {
    return Json{{"takes", report.MissingTakes(format)}, {"clips", report.MissingClips(format)}};
  };
  Json json = {
      {"folder", report.folder.string()},
      {"as_documented", !report.HasFaults()},
      {"takes", CountsJson(Hdm05().TakeCount(),
                           [&](Hdm05Format format) { return report.TakesFound(format); })},
      {"clips", CountsJson(Hdm05().ClipCount(),
                           [&](Hdm05Format format) { return report.ClipsFound(format); })},
      {"videos", {{"expected", report.videos.size()}, {"found", CountPresent(report.videos)}}},
      {"actors", ActorsJson(report)},
      {"classes", ClassesJson(report)},
      {"missing",
       {{"amc", missing(Hdm05Format::kAmc)},
        {"c3d", missing(Hdm05Format::kC3d)},
        {"skeletons", report.MissingSkeletons()}}},
      {"wrong_frame_count", FindingsJson(report, Hdm05FindingKind::kWrongFrameCount)},
      {"damaged", FindingsJson(report, Hdm05FindingKind::kDamaged)},
      {"extra", FindingsJson(report, Hdm05FindingKind::kExtra)},
      {"duplicates", FindingsJson(report, Hdm05FindingKind::kDuplicate)},
      {"known_defects", FindingsJson(report, Hdm05FindingKind::kKnownDefect)},
      {"elapsed_s", elapsed_s}};
  Json failed = FindingsJson(report, Hdm05FindingKind::kUnreadable);
  if (!failed.empty()) json["failed"] = std::move(failed);
  return json;
}

std::string Hdm05ReportText(const Hdm05Report& report, bool list_all_missing) {
  std::string text = Summary(report);
  for (const Hdm05Format format : kHdm05Formats) text += ShareTable(report, format);
  for (const Hdm05Format format : kHdm05Formats) text += ClassTable(report, format);
  for (const Hdm05Format format : kHdm05Formats) {
    text += MissingText(report, format, list_all_missing);
  }
  return text + FindingsText(report);
}

}  // namespace kinebase::cli
