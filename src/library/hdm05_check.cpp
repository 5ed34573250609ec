#include "kinebase/library/hdm05_check.h"

#include <algorithm>
#include <map>
#include <new>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/motion_file.h"
#include "library/files_below.h"
#include "library/hdm05_file_names.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Hdm05File;
using internal::Hdm05FileNames;
using Kind = Hdm05File::Kind;

std::size_t Index(Hdm05Format format) { return static_cast<std::size_t>(format); }

// A file of the copy: what it is by its name, and what reading it gave.
struct CopyFile {
  fs::path path;
  Hdm05File what;
  std::optional<std::int64_t> frame_count;  // Of a take or clip.
  std::optional<Error> error;
  Diagnostics diagnostics;
};

void CountAmcFrames(CopyFile& file) {
  AmcMotion amc = ReadAmc(file.path);
  file.frame_count = static_cast<std::int64_t>(amc.frame_count());
  file.diagnostics = std::move(amc.diagnostics);
}

void CountC3dFrames(CopyFile& file) { file.frame_count = LoadRecording(file.path).frame_count(); }

bool IsRead(const Hdm05File& what) {
  return what.kind == Kind::kTake || what.kind == Kind::kClip || what.kind == Kind::kSkeleton;
}

void Inspect(CopyFile& file) {
  try {
    if (file.what.kind == Kind::kSkeleton) {
      (void)ReadAsf(file.path);
    } else if (file.what.format == Hdm05Format::kAmc) {
      CountAmcFrames(file);
    } else {
      CountC3dFrames(file);
    }
  } catch (const Error& error) {
    file.error = error;
  } catch (const std::bad_alloc&) {
    file.error = Error(ErrorCode::kIoFailure, "needs more memory than there is", {file.path});
  }
}

std::vector<CopyFile> FindCopyFiles(const fs::path& folder) {
  std::error_code unreachable;
  if (!fs::exists(folder, unreachable)) {
    throw Error(ErrorCode::kNotFound, "does not exist", {folder});
  }
  if (!fs::is_directory(folder, unreachable)) {
    throw Error(ErrorCode::kInvalidArgument, "is no folder; name the one with the copy of HDM05",
                {folder});
  }
  const Hdm05FileNames names;
  std::vector<CopyFile> files;
  for (fs::path& path : internal::FilesBelow(folder, &Hdm05FileNames::IsCandidate)) {
    Hdm05File what = names.Identify(path);
    files.push_back({.path = std::move(path), .what = std::move(what)});
  }
  if (std::ranges::all_of(files, [](const auto& f) { return f.what.kind == Kind::kExtra; })) {
    throw Error(ErrorCode::kNotFound,
                "holds no file of HDM05; looked in it and below for names like "
                "HDM_bd_01-01_01_120.amc, HDM_bd_squat1Reps_001_120.c3d and HDM_bd.asf",
                {folder});
  }
  return files;
}

Hdm05Report EmptyReport(const fs::path& folder) {
  const Hdm05Catalogue& catalogue = Hdm05();
  Hdm05Report report{.folder = folder};
  for (const Hdm05Take& take : catalogue.takes) report.takes.push_back({.take = &take});
  for (const Hdm05Class& motion_class : catalogue.classes) {
    const std::vector<Hdm05Presence> none(static_cast<std::size_t>(motion_class.clip_count));
    report.classes.push_back({.motion_class = &motion_class, .clips = {none, none}});
  }
  report.skeletons.resize(catalogue.actors.size());
  report.videos.resize(catalogue.videos.size());
  return report;
}

// Where the report says whether a file is there.
Hdm05Presence& PresenceOf(Hdm05Report& report, const Hdm05File& what) {
  switch (what.kind) {
    case Kind::kTake:
      return report.takes[what.index].files[Index(what.format)];
    case Kind::kClip:
      return report.classes[what.index]
          .clips[Index(what.format)][static_cast<std::size_t>(what.number) - 1];
    case Kind::kSkeleton:
      return report.skeletons[what.index];
    default:
      return report.videos[what.index];
  }
}

void AddWrongFrameCount(const CopyFile& file, Hdm05Report& report) {
  if (file.what.kind != Kind::kTake) return;  // Of clips no lengths are documented.
  const auto expected = report.takes[file.what.index].take->frame_count;
  if (!expected || expected == file.frame_count) return;
  report.findings.push_back(
      {.kind = Hdm05FindingKind::kWrongFrameCount,
       .file = file.path,
       .message = fmt::format("{} frames; HDM05 has {}", *file.frame_count, *expected),
       .expected_frames = expected,
       .found_frames = file.frame_count});
}

void AddKnownDefect(const CopyFile& file, Hdm05Report& report) {
  const Hdm05File& what = file.what;
  if (what.kind != Kind::kTake && what.kind != Kind::kClip) return;
  const Hdm05Defect& defect = what.kind == Kind::kTake
                                  ? report.takes[what.index].take->defect
                                  : report.classes[what.index].motion_class->defect;
  if (defect.text.empty() || !defect.formats[Index(what.format)]) return;
  if (defect.clip != 0 && defect.clip != what.number) return;
  report.findings.push_back(
      {.kind = Hdm05FindingKind::kKnownDefect, .file = file.path, .message = defect.text});
}

void AddToReport(const CopyFile& file, Hdm05Report& report) {
  const auto add = [&](Hdm05FindingKind kind, std::string message) {
    report.findings.push_back({.kind = kind, .file = file.path, .message = std::move(message)});
  };
  if (file.what.kind == Kind::kExtra) return add(Hdm05FindingKind::kExtra, file.what.why_extra);
  Hdm05Presence& presence = PresenceOf(report, file.what);
  if (file.error) {
    presence = std::max(presence, Hdm05Presence::kUnreadable);
    return add(Hdm05FindingKind::kUnreadable, file.error->what());
  }
  if (IsRead(file.what)) ++report.readable_count;
  presence = Hdm05Presence::kFound;
  AddWrongFrameCount(file, report);
  for (const Diagnostic& diagnostic : file.diagnostics) {
    if (diagnostic.severity != Severity::kWarning) continue;
    const std::string line = diagnostic.line > 0 ? fmt::format("line {}: ", diagnostic.line) : "";
    add(Hdm05FindingKind::kDamaged, line + diagnostic.message);
  }
  AddKnownDefect(file, report);
}

// A copy keeps a skeleton in each folder of clips; takes and clips are there once.
void AddDuplicates(const std::vector<CopyFile>& files, Hdm05Report& report) {
  std::map<const Hdm05Presence*, const CopyFile*> first;
  for (const CopyFile& file : files) {
    if (file.what.kind != Kind::kTake && file.what.kind != Kind::kClip) continue;
    const auto [earlier, is_new] = first.emplace(&PresenceOf(report, file.what), &file);
    if (is_new) continue;
    report.findings.push_back({.kind = Hdm05FindingKind::kDuplicate,
                               .file = file.path,
                               .message = "is also " + earlier->second->path.string()});
  }
}

int CountFound(const std::vector<Hdm05Presence>& clips, Hdm05ClipNumbers numbers) {
  const auto begin = clips.begin() + (numbers.first - 1);
  return static_cast<int>(std::count(begin, begin + numbers.count(), Hdm05Presence::kFound));
}

}  // namespace

std::string_view ToString(Hdm05FindingKind kind) {
  switch (kind) {
    case Hdm05FindingKind::kUnreadable:
      return "unreadable";
    case Hdm05FindingKind::kWrongFrameCount:
      return "wrong frame count";
    case Hdm05FindingKind::kDamaged:
      return "damaged";
    case Hdm05FindingKind::kExtra:
      return "extra";
    case Hdm05FindingKind::kDuplicate:
      return "duplicate";
    default:
      return "known defect";
  }
}

int Hdm05ClassStatus::found(Hdm05Format format) const {
  return CountFound(clips[Index(format)], {1, motion_class->clip_count});
}

int Hdm05ClassStatus::found(Hdm05Format format, std::size_t actor) const {
  return CountFound(clips[Index(format)], ClipNumbers(*motion_class, actor));
}

bool Hdm05ClassStatus::complete(Hdm05Format format) const {
  return found(format) == motion_class->clip_count;
}

int Hdm05Report::TakesFound(Hdm05Format format, std::string_view actor, int part) const {
  return static_cast<int>(std::ranges::count_if(takes, [&](const Hdm05TakeStatus& status) {
    return status.files[Index(format)] == Hdm05Presence::kFound &&
           (actor.empty() || status.take->actor == actor) &&
           (part == 0 || status.take->part == part);
  }));
}

int Hdm05Report::ClipsFound(Hdm05Format format) const {
  int count = 0;
  for (const Hdm05ClassStatus& status : classes) count += status.found(format);
  return count;
}

int Hdm05Report::ClipsFound(Hdm05Format format, std::size_t actor) const {
  int count = 0;
  for (const Hdm05ClassStatus& status : classes) count += status.found(format, actor);
  return count;
}

std::vector<std::string> Hdm05Report::MissingTakes(Hdm05Format format) const {
  std::vector<std::string> names;
  for (const Hdm05TakeStatus& status : takes) {
    if (status.files[Index(format)] == Hdm05Presence::kMissing) {
      names.push_back(status.take->name());
    }
  }
  return names;
}

std::vector<std::string> Hdm05Report::MissingClips(Hdm05Format format) const {
  std::vector<std::string> names;
  for (const Hdm05ClassStatus& status : classes) {
    for (std::size_t actor = 0; actor < skeletons.size(); ++actor) {
      const Hdm05ClipNumbers numbers = ClipNumbers(*status.motion_class, actor);
      for (int number = numbers.first; number <= numbers.last; ++number) {
        const auto place = static_cast<std::size_t>(number) - 1;
        if (status.clips[Index(format)][place] == Hdm05Presence::kMissing) {
          names.push_back(Hdm05ClipName(*status.motion_class, actor, number));
        }
      }
    }
  }
  return names;
}

std::vector<std::string> Hdm05Report::MissingSkeletons() const {
  std::vector<std::string> missing;
  for (std::size_t actor = 0; actor < skeletons.size(); ++actor) {
    const std::string& id = Hdm05().actors[actor].id;
    const bool is_needed =
        TakesFound(Hdm05Format::kAmc, id) > 0 || ClipsFound(Hdm05Format::kAmc, actor) > 0;
    if (is_needed && skeletons[actor] == Hdm05Presence::kMissing) missing.push_back(id);
  }
  return missing;
}

std::vector<const Hdm05Finding*> Hdm05Report::FindingsOf(Hdm05FindingKind kind) const {
  std::vector<const Hdm05Finding*> found;
  for (const Hdm05Finding& finding : findings) {
    if (finding.kind == kind) found.push_back(&finding);
  }
  return found;
}

bool Hdm05Report::HasFaults() const {
  return std::ranges::any_of(findings, [](const Hdm05Finding& finding) {
    return finding.kind <= Hdm05FindingKind::kDamaged;
  });
}

Hdm05Report CheckHdm05(const fs::path& folder, int threads, const ProgressCallback& progress) {
  std::vector<CopyFile> files = FindCopyFiles(folder);
  std::vector<CopyFile*> to_read;
  for (CopyFile& file : files) {
    if (IsRead(file.what)) to_read.push_back(&file);
  }
  ParallelFor(to_read.size(), threads, "checking", progress,
              [&](std::size_t i) { Inspect(*to_read[i]); });
  Hdm05Report report = EmptyReport(folder);
  for (const CopyFile& file : files) AddToReport(file, report);
  AddDuplicates(files, report);
  std::ranges::stable_sort(report.findings, {}, &Hdm05Finding::kind);
  return report;
}

}  // namespace kinebase
