// The halves of protocol "half": the first, third, fifth … clip of a class, and the rest. Internal.
#pragma once

#include <map>
#include <string>

namespace kinebase::internal {

class EveryOther {
 public:
  // Whether this clip is of the first half. Asked once for each clip, in their order.
  [[nodiscard]] bool Takes(const std::string& class_name) { return seen_[class_name]++ % 2 == 0; }

 private:
  std::map<std::string, int> seen_;  // By class.
};

}  // namespace kinebase::internal
