#include "kinebase/library/take_library.h"

#include <algorithm>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/pose_stream.h"
#include "library/catalogue.h"
#include "library/damage.h"
#include "library/library_layout.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

bool Contains(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::ranges::find(names, name) != names.end();
}

// What the filter may be right about and the library has not.
void CheckNames(const std::vector<std::string>& asked, const std::set<std::string>& there,
                std::string_view what, const fs::path& library) {
  for (const std::string& name : asked) {
    if (there.contains(name)) continue;
    throw Error(ErrorCode::kNotFound,
                there.empty() ? fmt::format("has no take of {0} '{1}': it knows no {0} of any take",
                                            what, name)
                              : fmt::format("has no take of {} '{}'; there are: {}", what, name,
                                            fmt::join(there, ", ")),
                {.file = library});
  }
}

// "amc" and "ASF" both mean "ASF/AMC".
bool IsFormat(std::string_view asked, std::string_view format) {
  if (EqualsIgnoringCase(asked, format)) return true;
  const std::size_t slash = format.find('/');
  return slash != std::string_view::npos && (EqualsIgnoringCase(asked, format.substr(0, slash)) ||
                                             IsFormat(asked, format.substr(slash + 1)));
}

bool HasLabel(const StoredTake& take, const std::vector<std::string>& labels) {
  return labels.empty() || std::ranges::any_of(take.labels, [&](const StoredLabel& label) {
           return Contains(labels, label.text);
         });
}

bool HasFormat(const StoredTake& take, const std::vector<std::string>& formats) {
  return formats.empty() || std::ranges::any_of(formats, [&](const std::string& asked) {
           return IsFormat(asked, take.format);
         });
}

bool HasDamagedRows(const std::vector<StoredTake>& takes) {
  return std::ranges::any_of(takes, [](const StoredTake& take) { return !take.is_intact; });
}

// Each name of the filter is one that some take has. Nobody knows where rows are damaged: then
// these are named.
void CheckFilter(const TakeFilter& filter, const std::vector<StoredTake>& takes,
                 const fs::path& library) {
  if (HasDamagedRows(takes)) return;
  std::set<std::string> actors;
  std::set<std::string> classes;
  std::set<std::string> labels;
  std::set<std::string> formats;
  for (const StoredTake& take : takes) {
    if (!take.name.actor.empty()) actors.insert(take.name.actor);
    if (!take.name.class_name.empty()) classes.insert(take.name.class_name);
    for (const StoredLabel& label : take.labels) labels.insert(label.text);
    formats.insert(take.format);
  }
  CheckNames(filter.actors, actors, "actor", library);
  CheckNames(filter.classes, classes, "class", library);
  CheckNames(filter.labels, labels, "label", library);
  for (const std::string& asked : filter.formats) {
    if (std::ranges::any_of(formats, [&](const auto& each) { return IsFormat(asked, each); })) {
      continue;
    }
    CheckNames({asked}, formats, "format", library);
  }
}

const StoredFeatures* FindFeatures(const StoredTake& take, std::uint64_t feature_set_hash,
                                   double rate_hz) {
  const auto found = std::ranges::find_if(take.features, [&](const StoredFeatures& features) {
    return features.feature_set_hash == feature_set_hash && features.rate_hz == rate_hz;
  });
  return found == take.features.end() ? nullptr : &*found;
}

// Of those that some take has.
std::string NameOfSet(const std::vector<StoredFeatureSet>& sets, std::uint64_t hash) {
  const auto set = std::ranges::find(sets, hash, &StoredFeatureSet::hash);
  return set == sets.end() ? "of this template" : set->name;
}

// One word for all of them is clearer than the same of each take.
void CheckAnyHas(std::span<const StoredTake* const> takes, const FeatureSet& features,
                 double rate_hz, bool with_poses, const fs::path& library) {
  const StoredFeatures* some = nullptr;
  bool is_known = false;
  for (const StoredTake* take : takes) {
    if (!take->is_intact) continue;
    is_known = true;
    const StoredFeatures* found = FindFeatures(*take, features.hash, rate_hz);
    if (found == nullptr) continue;
    if (!with_poses || found->has_poses) return;
    some = found;
  }
  if (!is_known) return;  // Each of them will be named for its damage.
  throw Error(ErrorCode::kNotFound,
              some != nullptr
                  ? "holds no poses, which are asked for here; import the files again with --poses"
                  : fmt::format("holds no features of the set '{}' at {:g} Hz; import the files "
                                "again with --feature-set and --rate",
                                features.name, rate_hz),
              {.file = library});
}

// A segment is only missing where its folder can be looked into: what is on a disk that is not
// there, or is kept from this user, may be sound.
Error WithoutGuess(const Error& error, const fs::path& folder) {
  if (error.code() != ErrorCode::kNotFound) return error;
  std::error_code unreadable;
  const fs::directory_iterator entries(folder, unreadable);
  if (!unreadable) return error;
  return {
      ErrorCode::kIoFailure,
      fmt::format("cannot be looked for, as its folder cannot be read: {}", unreadable.message()),
      error.place()};
}

std::variant<SegmentFile, Error> OpenSegment(const fs::path& path) {
  try {
    return SegmentFile(path);
  } catch (const Error& error) {
    return WithoutGuess(error, path.parent_path());
  }
}

}  // namespace

bool TakeFilter::Accepts(const StoredTake& take) const {
  return Contains(actors, take.name.actor) && Contains(classes, take.name.class_name) &&
         HasLabel(take, labels) && HasFormat(take, formats);
}

std::string KeyText(const ContentKey& key) {
  const bool is_known = key[0] != 0 || key[1] != 0;
  return is_known ? fmt::format("{:016x}{:016x}", key[1], key[0]) : "";
}

bool IsLibrary(const fs::path& folder) {
  std::error_code unreachable;
  return fs::is_regular_file(internal::CatalogueFile(folder), unreachable);
}

TakeLibrary::TakeLibrary(const fs::path& folder) : folder_(folder) {
  internal::CheckIsLibrary(folder);
  const Catalogue catalogue(folder, SqliteDatabase::Access::kRead);
  // As long as it lasts nobody can make a removal of takes final, and so remove their segments.
  const SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kRead);
  takes_ = catalogue.Takes();
  feature_sets_ = catalogue.FeatureSets();
  segment_bytes_ = catalogue.SegmentBytes();
  for (const std::int64_t segment : catalogue.Segments()) {
    segments_.emplace(segment, OpenSegment(internal::SegmentPath(folder, segment)));
  }
}

std::vector<std::int64_t> TakeLibrary::segments() const {
  std::vector<std::int64_t> numbers;
  numbers.reserve(segments_.size());
  for (const auto& [number, segment] : segments_) numbers.push_back(number);
  return numbers;
}

std::vector<const StoredTake*> TakeLibrary::Choose(const TakeFilter& filter) const {
  CheckFilter(filter, takes_, folder_);
  std::vector<std::int64_t> with_text;  // Ascending.
  if (!filter.text.empty()) {
    with_text = Catalogue(folder_, SqliteDatabase::Access::kRead).FindText(filter.text);
    if (with_text.empty() && !HasDamagedRows(takes_)) {
      throw Error(ErrorCode::kNotFound,
                  fmt::format("has no take with the words {} in its name, class, actor, skeleton, "
                              "labels or description",
                              Quoted(filter.text)),
                  {.file = folder_});
    }
  }
  std::vector<const StoredTake*> chosen;
  chosen.reserve(takes_.size());
  for (const StoredTake& take : takes_) {
    const bool has_text = filter.text.empty() || std::ranges::binary_search(with_text, take.id);
    if (!take.is_intact || (has_text && filter.Accepts(take))) chosen.push_back(&take);
  }
  return chosen;
}

TakeLibrary::Location TakeLibrary::Find(const StoredTake& take, std::uint64_t feature_set_hash,
                                        double rate_hz) const {
  internal::CheckTakeRow(take, folder_);
  const StoredFeatures* features = FindFeatures(take, feature_set_hash, rate_hz);
  if (features == nullptr) {
    throw Error(
        ErrorCode::kNotFound,
        fmt::format("was not imported with the feature set '{}' at {:g} Hz; import it again with "
                    "--feature-set and --rate",
                    NameOfSet(feature_sets_, feature_set_hash), rate_hz),
        {.file = take.path});
  }
  const fs::path path = internal::SegmentPath(folder_, features->segment);
  const auto found = segments_.find(features->segment);
  if (found == segments_.end()) {
    throw internal::WithRemedy(
        {ErrorCode::kNotFound, "is missing in the catalogue", {.file = path}});
  }
  if (const auto* error = std::get_if<Error>(&found->second)) throw internal::WithRemedy(*error);
  const SegmentReader& segment = std::get<SegmentFile>(found->second).reader();
  if (!internal::HoldsFeatures(segment, *features, take.content)) {
    throw internal::WithRemedy(
        {ErrorCode::kMalformedFile,
         fmt::format("does not hold {} as the catalogue says", take.path.string()),
         {.file = path}});
  }
  return {&segment, features->slot};
}

std::span<const std::uint64_t> TakeLibrary::Columns(const StoredTake& take,
                                                    std::uint64_t feature_set_hash,
                                                    double rate_hz) const {
  const Location location = Find(take, feature_set_hash, rate_hz);
  try {
    return location.segment->Columns(location.slot);
  } catch (const Error& error) {
    throw internal::WithRemedy(error);
  }
}

int TakeLibrary::ColumnCount(const StoredTake& take, std::uint64_t feature_set_hash,
                             double rate_hz) const {
  const Location location = Find(take, feature_set_hash, rate_hz);
  return location.segment->ColumnCount(location.slot);
}

JointTrajectories TakeLibrary::Poses(const StoredTake& take, std::uint64_t feature_set_hash,
                                     double rate_hz) const {
  const Location location = Find(take, feature_set_hash, rate_hz);
  if (!location.segment->HasPoses(location.slot)) {
    throw Error(ErrorCode::kNotFound, "was imported without poses; import it again with --poses",
                {.file = take.path});
  }
  try {
    return UnpackPoses(location.segment->Poses(location.slot), rate_hz);
  } catch (const Error& error) {
    throw internal::WithRemedy(error);
  }
}

std::string TakeLibrary::RunListsOf(const StoredTake& take, std::uint64_t feature_set_hash,
                                    double rate_hz) const {
  const Location location = Find(take, feature_set_hash, rate_hz);
  try {
    return location.segment->RunListsOf(location.slot);
  } catch (const Error& error) {
    throw internal::WithRemedy(error);
  }
}

void TakeLibrary::ReleaseMemory(std::span<const StoredTake* const> takes) const {
  std::set<std::int64_t> numbers;
  for (const StoredTake* take : takes) {
    for (const StoredFeatures& features : take->features) numbers.insert(features.segment);
  }
  for (const std::int64_t number : numbers) {
    const auto found = segments_.find(number);
    if (found == segments_.end()) continue;
    if (const auto* file = std::get_if<SegmentFile>(&found->second)) file->ReleaseMemory();
  }
}

void TakeLibrary::Check(const StoredTake& take) const {
  internal::CheckTakeRow(take, folder_);
  for (const StoredFeatures& features : take.features) {
    (void)Columns(take, features.feature_set_hash, features.rate_hz);
    const Location location = Find(take, features.feature_set_hash, features.rate_hz);
    try {
      location.segment->CheckRunLists(location.slot);
    } catch (const Error& error) {
      throw internal::WithRemedy(error);
    }
    if (features.has_poses) (void)Poses(take, features.feature_set_hash, features.rate_hz);
  }
}

TakeFeatures TakeLibrary::LoadTake(const StoredTake& take, const FeatureSet& features,
                                   double rate_hz, bool with_poses) const {
  const std::span<const std::uint64_t> columns = Columns(take, features.hash, rate_hz);
  TakeFeatures loaded{.path = take.path,
                      .stretch = {.file = take.path},
                      .name = take.name,
                      .rate_hz = take.rate_hz,
                      .frame_count = take.frame_count,
                      .features = {.rate_hz = rate_hz,
                                   .feature_count = features.feature_count(),
                                   .columns = {columns.begin(), columns.end()}}};
  if (with_poses) loaded.poses = ExtractPoses(Poses(take, features.hash, rate_hz), rate_hz);
  return loaded;
}

std::vector<const StoredTake*> TakeLibrary::TakesWith(const FeatureSet& features, double rate_hz,
                                                      const TakeFilter& filter,
                                                      bool with_poses) const {
  if (takes_.empty()) {
    throw Error(ErrorCode::kNotFound, "holds no takes; kinebase import adds some",
                {.file = folder_});
  }
  std::vector<const StoredTake*> chosen = Choose(filter);
  if (chosen.empty()) {
    throw Error(ErrorCode::kNotFound, "has no take that is all that is asked for",
                {.file = folder_});
  }
  CheckAnyHas(chosen, features, rate_hz, with_poses, folder_);
  return chosen;
}

}  // namespace kinebase
