// Cuts stretches out of BVH.

#include "formats/frame_cut.h"
#include "kinebase/formats/bvh.h"

namespace kinebase {

BvhMotion CutBvh(const BvhMotion& motion, std::int64_t first, std::int64_t last) {
  internal::CheckCut(first, last, static_cast<std::int64_t>(motion.frame_count()));
  return {.file_name = motion.file_name,
          .joints = motion.joints,
          .column_count = motion.column_count,
          .declared_frame_count = last - first + 1,
          .frame_time_text = motion.frame_time_text,
          .frame_time_s = motion.frame_time_s,
          .unknown = motion.unknown,
          .values = internal::CutRows(motion.values, motion.column_count, first, last)};
}

}  // namespace kinebase
