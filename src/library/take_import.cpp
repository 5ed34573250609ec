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
#include "kinebase/library/descriptions.h"
#include "kinebase/library/packed_poses.h"
#include "kinebase/library/segment_file.h"
#include "kinebase/library/take_library.h"
#include "kinebase/motion/motion_editing.h"
#include "library/catalogue.h"
#include "library/catalogue_records.h"
#include "library/checksum.h"
#include "library/damage.h"
#include "library/library_layout.h"
#include "library/library_lock.h"
#include "library/memory_gate.h"
#include "library/take_origin.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

// To be raised whenever a reader comes to understand the same bytes otherwise: libraries then read
// their files anew.
constexpr int kReadersVersion = 1;

// The rate that reading may take from outside of the file: what is asked for, else its name's. A
// name may also stand before a second ending: "take_120.amc.mat".
std::string OutsideRateOf(const fs::path& file, const LoadOptions& options) {
  if (options.source_rate_hz != 0) return ToShortestText(options.source_rate_hz);
  return ToShortestText(ParseTakeName(file).rate_hz) + " by name, or " +
         ToShortestText(ParseTakeName(file.stem()).rate_hz);
}

// What changes how the same bytes are read.
std::string WayOfReading(const fs::path& file, const LoadOptions& options) {
  const std::string up = options.up_axis ? std::to_string(static_cast<int>(*options.up_axis)) : "";
  const MotionFormat* format = FindMotionFormat(file);
  return fmt::format("{} {} {} {} {} {} {}", kReadersVersion, format ? format->name : "",
                     OutsideRateOf(file, options), options.strict,
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
  return internal::KeyOf(
      {motion.text(), text(skeleton), text(names), text(set), WayOfReading(file, options)});
}

ContentKey KeyOf(const ImportSource& source, const LoadOptions& options) {
  if (source.make) return internal::KeyOf({"made", source.origin});
  return KeyOf(source.file, options);
}

// A file once, however often it is named: what the first says of it that says anything.
std::vector<ImportSource> WithoutRepeats(std::span<const ImportSource> sources) {
  std::vector<ImportSource> unique;
  std::map<fs::path, std::size_t> places;
  for (const ImportSource& source : sources) {
    const auto [place, is_new] = places.try_emplace(internal::Resolved(source.file), unique.size());
    if (is_new) {
      unique.push_back(source);
      continue;
    }
    ImportSource& first = unique[place->second];
    if (first.class_name.empty()) first.class_name = source.class_name;
    if (first.actor.empty()) first.actor = source.actor;
    if (first.description.empty()) first.description = source.description;
  }
  return unique;
}

// What reading a file may take, as a multiple of its bytes: its text, the numbers, joints and
// poses. AMC takes 3.5; the rest is for formats that pack their numbers.
constexpr std::int64_t kBytesForAByte = 8;

// What became of one source, on its way into the catalogue.
struct Arrival {
  StoredTake take;
  ImportState state = ImportState::kAdded;
  bool is_to_be_read = false;
  std::optional<std::size_t> same_as;   // Take of the batch that has the same contents to store.
  std::optional<SegmentTake> contents;  // To be stored; empty if the library has it already.
  Diagnostics diagnostics;
  std::optional<Error> error;
};

// An import under way: the library's state as this process alone changes it.
class Importer {
 public:
  Importer(const fs::path& library, const ImportOptions& options)
      : library_(library),
        options_(options),
        catalogue_(library, SqliteDatabase::Access::kCreate),
        reading_(options.memory_bytes / 2) {
    internal::RemoveLeftovers(library, catalogue_);
    for (StoredTake& take : catalogue_.Takes()) Remember(std::move(take));
  }

  ImportReport Import(std::span<const ImportSource> sources) {
    for (std::size_t begin = 0; begin < sources.size();) {
      const auto batch = sources.subspan(begin, BatchSize(sources.subspan(begin)));
      std::vector<Arrival> arrivals = Read(batch, begin, sources.size());
      Store(arrivals);
      Report(batch, arrivals);
      begin += batch.size();
    }
    return std::move(report_);
  }

 private:
  // What is kept of a file takes less than the file; twice, while its segment is made.
  [[nodiscard]] std::size_t BatchSize(std::span<const ImportSource> sources) const {
    const auto most = static_cast<std::size_t>(std::max(1, options_.takes_per_batch));
    std::int64_t bytes = 0;
    std::size_t size = 0;
    for (; size < std::min(sources.size(), most); ++size) {
      bytes += internal::FileBytes(sources[size].file);
      if (size > 0 && bytes > options_.memory_bytes / 4) break;
    }
    return size;
  }

  void Remember(StoredTake take) {
    for (const StoredFeatures& features : take.features) {
      if (take.is_intact && IsWanted(features)) stored_.insert_or_assign(take.content, features);
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
    // Recognising is quick where there is something to read; it is heard of, for it can be
    // cancelled, and does not count.
    ParallelFor(batch.size(), options_.threads, "importing", Progress(begin, 0, total),
                [&](std::size_t i) {
                  Try(batch[i], arrivals[i], [&] { Recognise(batch[i], arrivals[i]); });
                });
    const std::vector<std::vector<std::size_t>> groups = GroupByContents(arrivals);
    const std::size_t repeated = batch.size() - groups.size();
    ParallelFor(groups.size(), options_.threads, "importing",
                Progress(begin + repeated, batch.size(), total),
                [&](std::size_t group) { ReadGroup(batch, groups[group], arrivals); });
    return arrivals;
  }

  // Of a part of the work, at most `most` takes, that comes after `before` takes of `total`.
  [[nodiscard]] ProgressCallback Progress(std::size_t before, std::size_t most,
                                          std::size_t total) const {
    if (!options_.progress) return {};
    return [this, before, most, total](std::string_view what, std::size_t done, std::size_t) {
      return options_.progress(what, before + std::min(done, most), total);
    };
  }

  // What goes wrong with one file is said of it, and stops no other.
  template <typename Action>
  static void Try(const ImportSource& source, Arrival& arrival, const Action& action) {
    try {
      action();
    } catch (const Error& error) {
      arrival.error = error.place().file.empty()
                          ? Error(error.code(), error.message(), {.file = source.file})
                          : error;
    } catch (const std::bad_alloc&) {
      arrival.error =
          Error(ErrorCode::kIoFailure, "needs more memory than there is", {.file = source.file});
    }
  }

  // Which take a file is, and whether it has to be read.
  void Recognise(const ImportSource& source, Arrival& arrival) const {
    const ContentKey content = KeyOf(source, options_.load);
    const fs::path path = internal::Resolved(source.file);
    const auto known = known_.find(path.native());
    const bool is_known = known != known_.end();
    const bool has_same_content = is_known && known->second.content == content;
    StoredTake& take = arrival.take;
    if (is_known) {
      internal::CheckTakeRow(known->second, library_);
      take = known->second;
      arrival.state = ImportState::kUpdated;
    }
    take.path = path;
    if (has_same_content && std::ranges::any_of(take.features, [&](const StoredFeatures& each) {
          return IsWanted(each);
        })) {
      const bool is_noted = NoteOrigin(source, take);
      if (!Rename(source, take) && !is_noted) arrival.state = ImportState::kUnchanged;
      return;
    }
    if (!has_same_content) take.features.clear();
    take.content = content;
    arrival.is_to_be_read = true;
  }

  // Places of takes that are read from the same bytes; one that is not read is by itself.
  static std::vector<std::vector<std::size_t>> GroupByContents(std::span<const Arrival> arrivals) {
    std::vector<std::vector<std::size_t>> groups;
    std::map<ContentKey, std::size_t> places;
    for (std::size_t i = 0; i < arrivals.size(); ++i) {
      if (arrivals[i].is_to_be_read) {
        const auto [place, is_new] = places.try_emplace(arrivals[i].take.content, groups.size());
        if (!is_new) {
          groups[place->second].push_back(i);
          continue;
        }
      }
      groups.push_back({i});
    }
    return groups;
  }

  // Features are computed for the first that can be read; the others only have other names.
  void ReadGroup(std::span<const ImportSource> batch, std::span<const std::size_t> group,
                 std::span<Arrival> arrivals) const {
    std::optional<std::size_t> first;
    for (const std::size_t i : group) {
      Arrival& arrival = arrivals[i];
      if (!arrival.is_to_be_read) continue;
      arrival.same_as = first;
      Try(batch[i], arrival, [&] { ReadContents(batch[i], arrival); });
      if (!arrival.error && arrival.contents) first = i;
    }
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
    set(take.description, source.description);
    return is_new;
  }

  // What version 1 did not note of a take; whether there was anything to note.
  bool NoteOrigin(const ImportSource& source, StoredTake& take) const {
    if (take.origin.imported_s != 0 || source.make) return false;
    if (take.description.empty()) take.description = Hdm05Description(source.file);
    take.skeleton = internal::SkeletonAt(SkeletonOf(source.file, options_.load));
    take.origin = internal::OriginOf(source.file, options_.load);
    return true;
  }

  // Of labels what lies within the take, which may have become shorter.
  static void CutLabels(StoredTake& take) {
    std::erase_if(take.labels,
                  [&](const StoredLabel& label) { return label.first_frame > take.frame_count; });
    for (StoredLabel& label : take.labels) {
      label.last_frame = std::min(label.last_frame, take.frame_count);
    }
  }

  void ReadContents(const ImportSource& source, Arrival& arrival) const {
    const internal::MemoryGate::Pass pass(reading_,
                                          kBytesForAByte * internal::FileBytes(source.file));
    StoredTake& take = arrival.take;
    Recording recording = source.make ? source.make() : LoadRecording(source.file, options_.load);
    const TakeName listed = take.name;  // Empty for a new take.
    take.name = recording.name;
    Rename({.class_name = listed.class_name, .actor = listed.actor}, take);
    Rename(source, take);
    take.format = recording.format;
    take.rate_hz = recording.rate_hz();
    take.frame_count = recording.frame_count();
    CutLabels(take);
    if (take.description.empty()) take.description = Hdm05Description(source.file);
    take.skeleton = internal::SkeletonAt(recording.skeleton_path);
    take.origin = internal::OriginOf(source.file, options_.load);
    arrival.diagnostics = std::move(recording.diagnostics);
    std::erase_if(take.features, [&](const StoredFeatures& each) { return IsSameSet(each); });
    if (arrival.same_as) return;
    const auto stored = stored_.find(take.content);
    if (stored != stored_.end() && IsIntact(stored->second, take.content)) {
      take.features.push_back(stored->second);  // The same bytes under another name.
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

  // Whether what is stored can still be read: a new take is not to share another's damage.
  [[nodiscard]] bool IsIntact(const StoredFeatures& features, const ContentKey& content) const {
    try {
      const SegmentFile file(internal::SegmentPath(library_, features.segment));
      const SegmentReader& segment = file.reader();
      if (!internal::HoldsFeatures(segment, features, content)) return false;
      (void)segment.Columns(features.slot);
      if (features.has_poses) (void)segment.Poses(features.slot);
      return true;
    } catch (const Error&) {
      return false;
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
      if (arrival.same_as) {  // An earlier one, which has been stored.
        arrival.take.features.push_back(arrivals[*arrival.same_as].take.features.back());
      }
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
        CutAnnotations(arrival.take);
      }
    }
    const std::vector<std::int64_t> dropped = catalogue_.DropUnusedSegments();
    transaction.Commit();
    for (const std::int64_t unused : dropped) {
      std::erase_if(stored_, [&](const auto& entry) { return entry.second.segment == unused; });
    }
    internal::RemoveSegments(library_, dropped);
  }

  void CutAnnotations(const StoredTake& take) const {
    const auto known = known_.find(take.path.native());
    if (known == known_.end() || known->second.frame_count <= take.frame_count) return;
    internal::CutAnnotations(catalogue_, take.id, take.frame_count);
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
  mutable internal::MemoryGate reading_;
  std::map<std::string, StoredTake> known_;      // By path.
  std::map<ContentKey, StoredFeatures> stored_;  // Where the wanted features of contents are.
  ImportReport report_;
};

// Makes a folder, and those above it that are missing, so that their names last as what is written
// into them does.
void MakeFolder(const fs::path& folder) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return;
  if (folder.has_parent_path()) MakeFolder(folder.parent_path());
  fs::create_directory(folder, error);
  if (error) {
    throw Error(ErrorCode::kIoFailure, fmt::format("cannot be made: {}", error.message()),
                {.file = folder});
  }
  FlushFolder(folder / "..");
}

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
  if (!fs::exists(internal::CatalogueFile(library), error)) {
    internal::CheckHasNoLostSegments(library);
  }
  MakeFolder(fs::absolute(internal::SegmentFolder(library)));
  // Again, for an import that was killed after it had made them.
  FlushFolder(library);
  FlushFolder(library / "..");
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
  for (const ListedClip& clip : ReadClipList(list, folders, ListedClass::kOptional)) {
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
