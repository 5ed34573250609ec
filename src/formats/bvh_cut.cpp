// Cuts stretches out of BVH.

#include "formats/frame_cut.h"
#include "kinebase/formats/bvh.h"

namespace kinebase {

BvhMotion CutBvh(const BvhMotion& motion, std::int64_t first, std::int64_t last) {
  internal::CheckCut(first, last, static_cast<std::int64_t>(motion.frame_count()));
  BvhMotion clip = motion;
  clip.diagnostics.clear();
  clip.declared_frame_count = last - first + 1;
  clip.values = internal::CutRows(motion.values, motion.column_count, first, last);
  return clip;
}

}  // namespace kinebase
