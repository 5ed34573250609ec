// Cuts stretches out of AMC.

#include "formats/frame_cut.h"
#include "kinebase/formats/amc.h"

namespace kinebase {

AmcMotion CutAmc(const AmcMotion& motion, std::int64_t first, std::int64_t last) {
  internal::CheckCut(first, last, static_cast<std::int64_t>(motion.frame_count()));
  AmcMotion clip{.header = motion.header,
                 .angle_unit = motion.angle_unit,
                 .all_bones_have_three_dofs = motion.all_bones_have_three_dofs,
                 .bones = motion.bones,
                 .column_count = motion.column_count};
  clip.frame_numbers.assign(motion.frame_numbers.begin() + first,
                            motion.frame_numbers.begin() + last + 1);
  const std::int64_t before_first = clip.frame_numbers.front() - 1;
  for (std::int64_t& number : clip.frame_numbers) number -= before_first;
  clip.values = internal::CutRows(motion.values, motion.column_count, first, last);
  for (const AmcMotion::Remark& remark : motion.remarks) {
    const auto frame = static_cast<std::int64_t>(remark.frame);
    if (frame < first || frame > last) continue;
    clip.remarks.push_back({static_cast<std::size_t>(frame - first), remark.text});
  }
  return clip;
}

}  // namespace kinebase
