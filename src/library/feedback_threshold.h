// The threshold that marks ask for. Internal.
#pragma once

#include <optional>
#include <vector>

#include "kinebase/templates/motion_template.h"

namespace kinebase::internal {

// What is known about costs under the new template.
struct MarkedCosts {
  std::vector<double> right;   // Of hits marked right
  std::vector<double> wrong;   // and wrong,
  std::vector<double> unseen;  // of right ones under the template before it learned from them,
  std::vector<double> clips;   // and of the best match in each clip.
};

// Changes the template's threshold, where it is from, and its confidence if it has one. True if no
// threshold tells right marks from wrong ones.
bool SetThreshold(const MarkedCosts& costs, MotionTemplate& motion_template);

}  // namespace kinebase::internal
