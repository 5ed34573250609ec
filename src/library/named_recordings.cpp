#include "library/named_recordings.h"

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/annotation_file.h"

namespace kinebase::internal {

NamedRecordings::NamedRecordings(std::span<const StoredTake* const> takes) {
  for (const StoredTake* take : takes) {
    by_path_.emplace(take->path, take);
    by_name_[RecordingName(take->path)].push_back(take);
  }
}

const StoredTake* NamedRecordings::Find(const std::filesystem::path& path, const std::string& name,
                                        const Place& place) const {
  const auto exact = by_path_.find(path);
  if (exact != by_path_.end()) return exact->second;
  const auto named = by_name_.find(name);
  if (named == by_name_.end()) return nullptr;
  if (named->second.size() == 1) return named->second.front();
  throw Error(
      ErrorCode::kInvalidArgument,
      fmt::format("{} may be {} or {}; name the folder or --formats of those that are meant",
                  Quoted(name), named->second[0]->path.string(), named->second[1]->path.string()),
      place);
}

}  // namespace kinebase::internal
