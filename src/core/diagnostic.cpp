#include "kinebase/core/diagnostic.h"

namespace kinebase {

std::string_view ToString(Severity severity) {
  return severity == Severity::kInfo ? "info" : "warning";
}

}  // namespace kinebase
