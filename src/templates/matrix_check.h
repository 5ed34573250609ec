// What is wrong with a matrix, for everybody who takes one in.
#pragma once

#include <string>

#include "kinebase/templates/motion_template.h"

namespace kinebase::internal {

// Empty if the matrix keeps what templates/motion_template.h promises; else what it breaks first.
[[nodiscard]] std::string ProblemOf(const TemplateMatrix& matrix);

// δ in [0, 0.5); from a half on a value could be 0 and 1 at once.
[[nodiscard]] bool IsQuantisation(double delta);

}  // namespace kinebase::internal
