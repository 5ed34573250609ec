#include "kinebase/core/error.h"

#include <utility>

namespace kinebase {

std::string Place::ToString() const {
  if (file.empty()) return {};
  std::string text = file.string();
  if (line > 0) {
    text += ':' + std::to_string(line);
  } else if (byte >= 0) {
    text += " at byte " + std::to_string(byte);
  }
  return text;
}

Error::Error(ErrorCode code, std::string message, Place place)
    : code_(code), message_(std::move(message)), place_(std::move(place)) {
  const std::string where = place_.ToString();
  what_ = where.empty() ? message_ : where + ": " + message_;
}

}  // namespace kinebase
