// What a template file may hold, for reading and writing it.
#pragma once

#include <string>
#include <string_view>

#include "kinebase/templates/motion_template.h"

namespace kinebase::internal {

inline constexpr std::string_view kTemplateFormat = "kinebase-template";
// Written is the first version that can hold what a template has, so that programs of its time can
// read it: 2 brought keyframes, contrasts and calibrations, 3 marks and the contrast's background,
// 4 look-alikes.
inline constexpr int kVersionWithKeyframes = 2;
inline constexpr int kVersionWithMarks = 3;
inline constexpr int kVersionWithLookalikes = 4;
inline constexpr int kTemplateVersion = kVersionWithLookalikes;

[[nodiscard]] bool IsThreshold(double tau);

// What is wrong, as "poses of another size than the matrix"; empty if nothing is.
[[nodiscard]] std::string ProblemOf(const Contrast& contrast, const TemplateMatrix& matrix);
[[nodiscard]] std::string ProblemOf(const Calibration& calibration);

}  // namespace kinebase::internal
