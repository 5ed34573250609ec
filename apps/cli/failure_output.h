// Takes that could not be used, as results list them in "failed".
#pragma once

#include <span>

#include "cli/console.h"
#include "kinebase/library/takes.h"

namespace kinebase::cli {

[[nodiscard]] inline Json FailuresToJson(std::span<const TakeFailure> failures) {
  Json list = Json::array();
  for (const auto& [path, error] : failures) {
    list.push_back(
        {{"file", path.empty() ? Json() : Json(path.string())}, {"message", error.what()}});
  }
  return list;
}

}  // namespace kinebase::cli
