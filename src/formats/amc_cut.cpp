// Cuts stretches out of AMC.

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/amc.h"

namespace kinebase {

AmcMotion CutAmc(const AmcMotion& motion, std::int64_t first, std::int64_t last) {
  const auto frames = static_cast<std::int64_t>(motion.frame_count());
  if (first < 0 || last < first || last >= frames) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("frames {} to {} of {} cannot be cut out", first, last, frames));
  }
  AmcMotion clip{.header = motion.header,
                 .angle_unit = motion.angle_unit,
                 .all_bones_have_three_dofs = motion.all_bones_have_three_dofs,
                 .bones = motion.bones,
                 .column_count = motion.column_count};
  clip.frame_numbers.assign(motion.frame_numbers.begin() + first,
                            motion.frame_numbers.begin() + last + 1);
  const std::int64_t before_first = clip.frame_numbers.front() - 1;
  for (std::int64_t& number : clip.frame_numbers) number -= before_first;
  const auto columns = static_cast<std::int64_t>(motion.column_count);
  clip.values.assign(motion.values.begin() + first * columns,
                     motion.values.begin() + (last + 1) * columns);
  for (const AmcMotion::Remark& remark : motion.remarks) {
    const auto frame = static_cast<std::int64_t>(remark.frame);
    if (frame < first || frame > last) continue;
    clip.remarks.push_back({static_cast<std::size_t>(frame - first), remark.text});
  }
  return clip;
}

}  // namespace kinebase
