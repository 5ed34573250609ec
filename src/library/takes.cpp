#include "kinebase/library/takes.h"

#include <algorithm>
#include <map>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/parallel.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/take_library.h"
#include "library/files_below.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::FilesBelow;

std::string KnownFormats() {
  std::string text;
  for (const MotionFormat& format : MotionFormats()) {
    if (format.load == nullptr) continue;
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", format.extension, format.name);
  }
  return text;
}

bool IsReadable(const fs::path& file) {
  const MotionFormat* format = FindMotionFormat(file);
  return format != nullptr && format->load != nullptr;
}

std::string JoinPaths(const std::vector<fs::path>& paths) {
  std::string text;
  for (const fs::path& path : paths) text += (text.empty() ? "" : ", ") + path.string();
  return text;
}

// The list's folder, then others.
std::vector<fs::path> PlacesOf(const fs::path& list, std::span<const fs::path> folders) {
  std::vector<fs::path> places = {fs::absolute(list).parent_path()};
  places.insert(places.end(), folders.begin(), folders.end());
  return places;
}

// Where the files of a list are: by name below its folder, then below others.
class FileIndex {
 public:
  explicit FileIndex(std::span<const fs::path> folders) {
    for (const fs::path& folder : folders) {
      std::error_code unreachable;
      if (fs::is_regular_file(folder, unreachable)) {
        files_.try_emplace(folder.filename().string(), folder);
      }
      for (fs::path& file : FilesBelow(folder, IsReadable)) {
        std::string name = file.filename().string();
        files_.try_emplace(std::move(name), std::move(file));  // Earlier folders win.
      }
    }
  }

  const fs::path* Find(const std::string& name) const {
    const auto found = files_.find(name);
    return found == files_.end() ? nullptr : &found->second;
  }

 private:
  std::map<std::string, fs::path> files_;
};

JointStream JointsOf(const Recording& recording, JointStreamKind kind, double rate_hz) {
  if (!recording.has_skeleton()) {
    throw Error(ErrorCode::kMismatch,
                "holds markers; rotations and positions of joints that are "
                "compared directly need a skeleton");
  }
  return ExtractJointStream(recording.motion, kind, rate_hz);
}

}  // namespace

std::vector<fs::path> FindMotionFiles(std::span<const fs::path> paths) {
  std::vector<fs::path> files;
  std::error_code unreachable;  // A name that is too long, a link to itself: nothing is there.
  for (const fs::path& path : paths) {
    if (!fs::exists(path, unreachable)) {
      const TakeStretch stretch = ParseTakeStretch(path.string());
      if (stretch.first_frame != 0 && fs::exists(stretch.file, unreachable)) {
        throw Error(ErrorCode::kInvalidArgument,
                    "whole files are taken here; kinebase convert makes one of a stretch", {path});
      }
      throw Error(ErrorCode::kNotFound, "does not exist", {path});
    }
    if (fs::is_directory(path, unreachable)) {
      auto below = FilesBelow(path, IsReadable);
      if (below.empty() && IsLibrary(path)) {
        throw Error(
            ErrorCode::kInvalidArgument,
            "is a library, not a folder of motion files; search, annotate and learn take it "
            "as --library",
            {path});
      }
      if (below.empty()) {
        throw Error(ErrorCode::kNotFound,
                    "holds no motion file; looked for " + KnownFormats() + " in it and below",
                    {path});
      }
      files.insert(files.end(), below.begin(), below.end());
    } else if (!IsReadable(path)) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("is no motion file that Kinebase knows; known: {}", KnownFormats()),
                  {path});
    } else {
      files.push_back(path);
    }
  }
  std::set<fs::path> seen;
  std::erase_if(files, [&](const fs::path& file) {
    std::error_code ignored;
    return !seen.insert(fs::weakly_canonical(file, ignored)).second;
  });
  return files;
}

std::vector<fs::path> FindNamedFiles(std::span<const fs::path> names,
                                     std::span<const fs::path> places) {
  std::vector<fs::path> files;
  files.reserve(names.size());
  std::error_code unreachable;
  for (const fs::path& name : names) {
    files.push_back(fs::is_regular_file(name, unreachable) ? name : fs::path());
  }
  const auto is_missing = [](const fs::path& file) { return file.empty(); };
  for (const fs::path& place : places) {
    if (!fs::exists(place, unreachable)) {
      throw Error(ErrorCode::kNotFound, "does not exist", {place});
    }
    if (std::ranges::none_of(files, is_missing)) continue;
    const FileIndex index(std::span(&place, 1));
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (!files[i].empty()) continue;
      const fs::path* found = index.Find(names[i].filename().string());
      if (found != nullptr) files[i] = *found;
    }
  }
  return files;
}

TakeStretch ParseTakeStretch(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::error_code unreachable;
  if (colon == std::string::npos || fs::exists(text, unreachable)) return {.file = text};
  const std::string_view range = std::string_view(text).substr(colon + 1);
  const std::size_t dash = range.find('-');
  const auto first = ParseInteger(range.substr(0, dash));
  const auto last =
      dash == std::string_view::npos ? std::nullopt : ParseInteger(range.substr(dash + 1));
  if (!first || !last) return {.file = text};
  if (*first < 1 || *last < *first) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("'{}': a stretch is first-last with 1 ≤ first ≤ last", text));
  }
  return {.file = text.substr(0, colon), .first_frame = *first, .last_frame = *last};
}

Recording CutToStretch(const Recording& recording, const TakeStretch& stretch) {
  if (stretch.first_frame == 0) return recording;
  if (stretch.last_frame > recording.frame_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("frames {} to {} are asked for; it has 1 to {}", stretch.first_frame,
                            stretch.last_frame, recording.frame_count()),
                {stretch.file});
  }
  return CutRecording(recording, static_cast<int>(stretch.first_frame) - 1,
                      static_cast<int>(stretch.last_frame) - 1);
}

Recording LoadStretch(const TakeStretch& stretch, const LoadOptions& options) {
  Recording recording = LoadRecording(stretch.file, options);
  return stretch.first_frame == 0 ? recording : CutToStretch(recording, stretch);
}

TakeFeatures LoadTakeFeatures(const TakeStretch& stretch, const FeatureSet& features,
                              double rate_hz, const LoadOptions& options, const TakeParts& parts) {
  Recording recording = LoadStretch(stretch, options);
  TakeFeatures take{.path = stretch.file,
                    .stretch = stretch,
                    .name = std::move(recording.name),
                    .rate_hz = recording.rate_hz(),
                    .frame_count = recording.frame_count(),
                    .diagnostics = std::move(recording.diagnostics)};
  try {
    const JointTrajectories joints = StandardJoints(recording, take.diagnostics);
    take.features = ExtractFeatures(joints, features, rate_hz);
    if (parts.poses) take.poses = ExtractPoses(joints, rate_hz);
    if (parts.rotations) {
      take.rotations = JointsOf(recording, JointStreamKind::kRotations, rate_hz);
    }
    if (parts.positions) {
      take.positions = JointsOf(recording, JointStreamKind::kPositions, rate_hz);
    }
  } catch (const Error& error) {
    if (!error.place().file.empty()) throw;
    throw Error(error.code(), error.message(), {stretch.file});
  }
  return take;
}

TakeBatch LoadManyTakeFeatures(std::span<const TakeStretch> stretches, const FeatureSet& features,
                               double rate_hz, const LoadOptions& options, int threads,
                               const ProgressCallback& progress, const TakeParts& parts) {
  std::vector<std::optional<TakeFeatures>> takes(stretches.size());
  std::vector<std::optional<Error>> errors(stretches.size());
  ParallelFor(stretches.size(), threads, "reading", progress, [&](std::size_t i) {
    try {
      takes[i] = LoadTakeFeatures(stretches[i], features, rate_hz, options, parts);
    } catch (const Error& error) {
      errors[i] = error;
    } catch (const std::bad_alloc&) {
      errors[i] = Error(ErrorCode::kIoFailure, "needs more memory than there is",
                        {.file = stretches[i].file});
    }
  });
  TakeBatch batch;
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    if (takes[i]) {
      batch.takes.push_back(std::move(*takes[i]));
    } else {
      batch.failures.push_back({stretches[i].file, *errors[i]});
    }
  }
  return batch;
}

std::vector<ListedClip> ParseClipList(std::string_view text, const fs::path& list,
                                      ListedClass needs) {
  const CsvTable table = ParseCsv(text, list);
  const std::size_t file_column = table.Column("file");
  const std::size_t class_column = table.Column("class");
  const auto actor_column = table.FindColumn("actor");
  std::vector<ListedClip> clips;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto& row = table.rows[i];
    for (const std::size_t column : {file_column, class_column}) {
      if (!Trim(row[column]).empty()) continue;
      if (column == class_column && needs == ListedClass::kOptional) continue;
      throw Error(
          ErrorCode::kMalformedFile,
          fmt::format("a clip without a {}; name it, or leave the line out", table.columns[column]),
          {list, table.lines[i]});
    }
    clips.push_back({.name = row[file_column],
                     .class_name = Trim(row[class_column]).empty() ? "" : row[class_column],
                     .actor = actor_column ? row[*actor_column] : std::string(),
                     .line = table.lines[i]});
  }
  return clips;
}

std::vector<ListedClip> ReadClipList(const fs::path& list, std::span<const fs::path> folders,
                                     ListedClass needs) {
  std::vector<ListedClip> clips = ParseClipList(MappedFile(list).text(), list, needs);
  const FileIndex index(PlacesOf(list, folders));
  for (ListedClip& clip : clips) {
    std::error_code unreachable;
    if (clip.name.is_absolute() && fs::is_regular_file(clip.name, unreachable)) {
      clip.file = clip.name;
      continue;
    }
    const fs::path* file = index.Find(clip.name.filename().string());
    if (file != nullptr) clip.file = *file;
  }
  return clips;
}

std::vector<TakeStretch> ClipsOfClass(const fs::path& list, const std::string& class_name,
                                      std::span<const std::string> actors,
                                      std::span<const fs::path> folders) {
  if (!actors.empty()) {  // Says that the column is missing.
    (void)ParseCsv(MappedFile(list).text(), list).Column("actor");
  }
  std::vector<TakeStretch> clips;
  std::set<std::string> classes;
  std::set<std::string> performers;  // Of the class.
  for (const ListedClip& clip : ReadClipList(list, folders)) {
    classes.insert(clip.class_name);
    if (clip.class_name != class_name) continue;
    performers.insert(clip.actor);
    if (!actors.empty() && std::ranges::find(actors, clip.actor) == actors.end()) continue;
    if (clip.file.empty()) {
      throw Error(ErrorCode::kNotFound,
                  fmt::format("'{}' is not below {}; name its folder with --in", clip.name.string(),
                              JoinPaths(PlacesOf(list, folders))),
                  {list, clip.line});
    }
    clips.push_back({.file = clip.file});
  }
  if (!classes.contains(class_name)) {
    throw Error(
        ErrorCode::kNotFound,
        fmt::format("has no class '{}'; there are: {}", class_name, fmt::join(classes, ", ")),
        {list});
  }
  for (const std::string& actor : actors) {
    if (performers.contains(actor)) continue;
    throw Error(ErrorCode::kNotFound,
                fmt::format("class '{}' has no clip of actor '{}'; there are: {}", class_name,
                            actor, fmt::join(performers, ", ")),
                {list});
  }
  return clips;
}

}  // namespace kinebase
