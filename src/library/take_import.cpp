#include "kinebase/library/take_import.h"

#include <algorithm>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/folder_flush.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/parallel.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/packed_poses.h"
#include "kinebase/library/segment_file.h"
#include "kinebase/library/take_library.h"
#include "kinebase/motion/motion_editing.h"
#include "library/catalogue.h"
#include "library/checksum.h"
#include "library/library_layout.h"
#include "library/library_lock.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

// Options that change what is read from the same bytes.
std::string TextOf(const LoadOptions& options) {
  const std::string up = options.up_axis ? std::to_string(static_cast<int>(*options.up_axis)) : "";
  return fmt::format("{} {} {} {} {}", ToShortestText(options.source_rate_hz), options.strict,
                     static_cast<int>(options.length_reading), up, options.units);
}

// The skeleton that a motion will be read with; none where the file needs none, or lacks one, which
// reading it will say.
fs::path SkeletonOf(const fs::path& file, const LoadOptions& options) {
  if (!options.skeleton.empty()) return options.skeleton;
  if (ToLower(file.extension().string()) != ".amc") return {};
  try {
    return FindSkeleton(file);
  } catch (const Error&) {
    return {};
  }
}

ContentKey KeyOf(const fs::path& file, const LoadOptions& options) {
  const auto map = [](const fs::path& path) {
    return path.empty() ? std::optional<MappedFile>() : std::optional<MappedFile>(path);
  };
  const auto text = [](const std::optional<MappedFile>& mapped) {
    return mapped ? mapped->text() : std::string_view();
  };
  const MappedFile motion(file);
  const auto skeleton = map(SkeletonOf(file, options));
  const auto names = map(options.marker_names);
  const auto set = map(options.marker_set);
  return internal::KeyOf({motion.text(), text(skeleton), text(names), text(set), TextOf(options)});
}

fs::path Resolved(const fs::path& file) {
  std::error_code unreachable;
  fs::path resolved = fs::canonical(file, unreachable);
  return unreachable ? fs::absolute(file, unreachable) : resolved;
}

// A file once, however often it is named: what the first says of it that says anything.
std::vector<ImportSource> WithoutRepeats(std::span<const ImportSource> sources) {
  std::vector<ImportSource> unique;
  std::map<fs::path, std::size_t> places;
  for (const ImportSource& source : sources) {
    const auto [place, is_new] = places.try_emplace(Resolved(source.file), unique.size());
    if (is_new) {
      unique.push_back(source);
      continue;
    }
    ImportSource& first = unique[place->second];
    if (first.class_name.empty()) first.class_name = source.class_name;
    if (first.actor.empty()) first.actor = source.actor;
  }
  return unique;
}

// What became of one source, on its way into the catalogue.
struct Arrival {
  StoredTake take;
  ImportState state = ImportState::kAdded;
  std::optional<SegmentTake> contents;  // To be stored; empty if the library has it already.
  Diagnostics diagnostics;
  std::optional<Error> error;
};

// An import under way: the library's state as this process alone changes it.
class Importer {
 public:
  Importer(const fs::path& library, const ImportOptions& options)
      : library_(library), options_(options), catalogue_(library, SqliteDatabase::Access::kCreate) {
    for (const auto& leftover : internal::FindLeftovers(library, catalogue_.Segments())) {
      std::error_code ignored;  // Another attempt will be made.
      fs::remove(leftover, ignored);
    }
    for (StoredTake& take : catalogue_.Takes()) Remember(std::move(take));
  }

  ImportReport Import(std::span<const ImportSource> sources) {
    const auto batch_size = static_cast<std::size_t>(std::max(1, options_.takes_per_batch));
    for (std::size_t begin = 0; begin < sources.size(); begin += batch_size) {
      const auto batch = sources.subspan(begin, std::min(batch_size, sources.size() - begin));
      std::vector<Arrival> arrivals = Read(batch, begin, sources.size());
      Store(arrivals);
      Report(batch, arrivals);
    }
    return std::move(report_);
  }

 private:
  void Remember(StoredTake take) {
    for (const StoredFeatures& features : take.features) {
      if (IsWanted(features)) stored_.insert_or_assign(take.content, features);
    }
    std::string path = take.path.native();
    known_.insert_or_assign(std::move(path), std::move(take));
  }

  // The features that are asked for, whatever other sets there are.
  [[nodiscard]] bool IsSameSet(const StoredFeatures& features) const {
    return features.feature_set_hash == options_.features.hash &&
           features.rate_hz == options_.rate_hz;
  }
  [[nodiscard]] bool IsWanted(const StoredFeatures& features) const {
    return IsSameSet(features) && (features.has_poses || !options_.with_poses);
  }

  std::vector<Arrival> Read(std::span<const ImportSource> batch, std::size_t begin,
                            std::size_t total) const {
    std::vector<Arrival> arrivals(batch.size());
    ProgressCallback progress;
    if (options_.progress) {
      progress = [&](std::string_view what, std::size_t done, std::size_t) {
        return options_.progress(what, begin + done, total);
      };
    }
    ParallelFor(batch.size(), options_.threads, "importing", progress, [&](std::size_t i) {
      Arrival& arrival = arrivals[i];
      try {
        Read(batch[i], arrival);
      } catch (const Error& error) {
        arrival.error = error.place().file.empty()
                            ? Error(error.code(), error.message(), {.file = batch[i].file})
                            : error;
      } catch (const std::bad_alloc&) {
        arrival.error = Error(ErrorCode::kIoFailure, "needs more memory than there is",
                              {.file = batch[i].file});
      }
    });
    return arrivals;
  }

  void Read(const ImportSource& source, Arrival& arrival) const {
    const ContentKey content = KeyOf(source.file, options_.load);
    const fs::path path = Resolved(source.file);
    const auto known = known_.find(path.native());
    const bool is_known = known != known_.end();
    const bool has_same_content = is_known && known->second.content == content;
    StoredTake& take = arrival.take;
    if (is_known) {
      take = known->second;
      arrival.state = ImportState::kUpdated;
    }
    take.path = path;
    if (has_same_content && std::ranges::any_of(take.features, [&](const StoredFeatures& each) {
          return IsWanted(each);
        })) {
      if (!Rename(source, take)) arrival.state = ImportState::kUnchanged;
      return;
    }
    if (!has_same_content) take.features.clear();
    take.content = content;
    ReadContents(source, arrival);
  }

  // What a list says of a take; whether that is anything new. A list that says nothing, and no
  // list, leave what is known.
  static bool Rename(const ImportSource& source, StoredTake& take) {
    bool is_new = false;
    const auto set = [&](std::string& name, const std::string& listed) {
      if (listed.empty() || listed == name) return;
      name = listed;
      is_new = true;
    };
    set(take.name.class_name, source.class_name);
    set(take.name.actor, source.actor);
    return is_new;
  }

  void ReadContents(const ImportSource& source, Arrival& arrival) const {
    StoredTake& take = arrival.take;
    Recording recording = LoadRecording(source.file, options_.load);
    const TakeName listed = take.name;  // Empty for a new take.
    take.name = recording.name;
    Rename({.class_name = listed.class_name, .actor = listed.actor}, take);
    Rename(source, take);
    take.format = recording.format;
    take.rate_hz = recording.rate_hz();
    take.frame_count = recording.frame_count();
    arrival.diagnostics = std::move(recording.diagnostics);
    std::erase_if(take.features, [&](const StoredFeatures& each) { return IsSameSet(each); });
    const auto stored = stored_.find(take.content);
    if (stored != stored_.end()) {  // The same bytes under another name.
      take.features.push_back(stored->second);
      return;
    }
    const JointTrajectories joints = StandardJoints(recording, arrival.diagnostics);
    SegmentTake& contents = arrival.contents.emplace();
    contents.content = take.content;
    contents.features = ExtractFeatures(joints, options_.features, options_.rate_hz);
    if (options_.with_poses) {
      contents.poses = PackPoses(ResampleTrajectories(joints, options_.rate_hz));
    }
  }

  // First the segment, down to the disk; then, in one transaction, the takes that are in it. What
  // fails in between leaves a file that the catalogue does not know, for the next import to remove.
  // It is not removed here: a transaction that reported an error may yet have come to pass.
  void Store(std::vector<Arrival>& arrivals) {
    const std::int64_t segment = catalogue_.NextSegment();
    std::vector<SegmentTake> contents;
    bool is_news = false;
    for (Arrival& arrival : arrivals) {
      if (arrival.error || arrival.state == ImportState::kUnchanged) continue;
      is_news = true;
      if (!arrival.contents) continue;
      arrival.take.features.push_back({.feature_set_hash = options_.features.hash,
                                       .rate_hz = options_.rate_hz,
                                       .segment = segment,
                                       .slot = static_cast<int>(contents.size()),
                                       .has_poses = arrival.contents->poses.has_value()});
      contents.push_back(std::move(*arrival.contents));
    }
    if (!is_news) return;
    std::int64_t bytes = 0;
    if (!contents.empty()) bytes = WriteSegment(segment, contents);

    SqliteTransaction transaction(catalogue_.database(), SqliteTransaction::Kind::kWrite);
    catalogue_.AddFeatureSet(options_.features);
    if (!contents.empty()) catalogue_.AddSegment(segment, bytes);
    for (const Arrival& arrival : arrivals) {
      if (!arrival.error && arrival.state != ImportState::kUnchanged) {
        catalogue_.PutTake(arrival.take);
      }
    }
    const std::vector<std::int64_t> dropped = catalogue_.DropUnusedSegments();
    transaction.Commit();
    for (const std::int64_t unused : dropped) {
      std::erase_if(stored_, [&](const auto& entry) { return entry.second.segment == unused; });
      std::error_code ignored;  // What stays is a leftover.
      fs::remove(internal::SegmentPath(library_, unused), ignored);
    }
  }

  [[nodiscard]] std::int64_t WriteSegment(std::int64_t segment,
                                          std::span<const SegmentTake> contents) const {
    const std::string bytes = FormatSegment(contents, options_.features.hash);
    WriteFile(internal::SegmentPath(library_, segment), bytes, Overwrite::kNo);
    FlushFolder(internal::SegmentFolder(library_));
    return std::ssize(bytes);
  }

  void Report(std::span<const ImportSource> batch, std::vector<Arrival>& arrivals) {
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
      Arrival& arrival = arrivals[i];
      if (arrival.error) {
        report_.failures.push_back({batch[i].file, *arrival.error});
        continue;
      }
      const ImportedTake imported{.path = arrival.take.path,
                                  .state = arrival.state,
                                  .frame_count = arrival.take.frame_count,
                                  .diagnostics = std::move(arrival.diagnostics)};
      CountIn(imported);
      if (arrival.state != ImportState::kUnchanged) Remember(std::move(arrival.take));
      if (options_.on_durable) options_.on_durable(imported);
    }
  }

  void CountIn(const ImportedTake& imported) {
    switch (imported.state) {
      case ImportState::kAdded:
        ++report_.added;
        break;
      case ImportState::kUpdated:
        ++report_.updated;
        break;
      case ImportState::kUnchanged:
        ++report_.unchanged;
        return;
    }
    report_.frames += imported.frame_count;
  }

  fs::path library_;
  const ImportOptions& options_;
  Catalogue catalogue_;
  std::map<std::string, StoredTake> known_;      // By path.
  std::map<ContentKey, StoredFeatures> stored_;  // Where the wanted features of contents are.
  ImportReport report_;
};

// Makes the folder of a library, or sees to it that there is nothing else in it.
void PrepareFolder(const fs::path& library) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(library, error)) {
    const std::string name = entry.path().filename().string();
    if (name == "lock" || name == "segments" || name.starts_with("catalogue.sqlite")) continue;
    std::error_code unreachable;
    if (fs::exists(internal::CatalogueFile(library), unreachable)) break;
    throw Error(ErrorCode::kInvalidArgument,
                "is a folder with other files in it; name a new or empty one for the library",
                {.file = library});
  }
  fs::create_directories(internal::SegmentFolder(library), error);
  if (error) {
    throw Error(ErrorCode::kIoFailure,
                fmt::format("cannot be made into a library: {}", error.message()),
                {.file = library});
  }
  FlushFolder(library);
  FlushFolder(fs::absolute(library / "..", error));  // The folder's own name, if it is new.
}

}  // namespace

ImportReport ImportTakes(const fs::path& library, std::span<const ImportSource> sources,
                         const ImportOptions& options) {
  CheckColumnRate(options.features, options.rate_hz);
  PrepareFolder(library);
  const internal::LibraryLock lock(library);
  return Importer(library, options).Import(WithoutRepeats(sources));
}

std::vector<ImportSource> ListedSources(const fs::path& list, std::span<const fs::path> folders,
                                        std::vector<TakeFailure>& failures) {
  std::vector<ImportSource> sources;
  for (const ListedClip& clip : ReadClipList(list, folders)) {
    if (clip.file.empty()) {
      failures.push_back(
          {clip.name, Error(ErrorCode::kNotFound,
                            fmt::format("'{}' is not below the list's folder; name its folder too",
                                        clip.name.string()),
                            {list, clip.line})});
      continue;
    }
    sources.push_back({.file = clip.file, .class_name = clip.class_name, .actor = clip.actor});
  }
  return sources;
}

}  // namespace kinebase
