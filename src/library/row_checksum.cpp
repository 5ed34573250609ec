#include "library/row_checksum.h"

#include "kinebase/library/take_library.h"

namespace kinebase::internal {
namespace {

void AddKey(const ContentKey& key, RowChecksum& sum) {
  for (const std::uint64_t word : key) sum.Add(static_cast<std::int64_t>(word));
}

}  // namespace

std::int64_t ChecksumOf(const StoredTake& take) {
  RowChecksum sum;
  sum.Add(take.id).Add(take.path.native());
  AddKey(take.content, sum);
  sum.Add(take.format).Add(take.name.actor).Add(take.name.class_name).Add(take.name.take);
  sum.Add(take.rate_hz).Add(take.frame_count).Add(take.description);
  sum.Add(take.skeleton.path.native());
  AddKey(take.skeleton.key, sum);
  sum.Add(take.origin.imported_s).Add(take.origin.file_time_s).Add(take.origin.file_bytes);
  sum.Add(take.origin.program).Add(take.origin.options);
  sum.Add(std::ssize(take.labels));
  for (const StoredLabel& label : take.labels) {
    sum.Add(label.text).Add(label.first_frame).Add(label.last_frame);
  }
  sum.Add(std::ssize(take.features));
  for (const StoredFeatures& features : take.features) {
    sum.Add(static_cast<std::int64_t>(features.feature_set_hash)).Add(features.rate_hz);
    sum.Add(features.segment).Add(std::int64_t{features.slot});
    sum.Add(std::int64_t{features.has_poses});
  }
  return sum.value();
}

}  // namespace kinebase::internal
