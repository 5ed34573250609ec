// Takes by the names that tables have for them. Internal.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kinebase/library/take_library.h"

namespace kinebase::internal {

class NamedRecordings {
 public:
  // takes  Valid as long as the object.
  explicit NamedRecordings(std::span<const StoredTake* const> takes);

  // The take of this path, else the only one whose file is called so, without folder and extension;
  // null if there is none.
  // place   Of the name in a table, for the message.
  // Errors  InvalidArgument if several takes are called so.
  [[nodiscard]] const StoredTake* Find(const std::filesystem::path& path, const std::string& name,
                                       const Place& place) const;

 private:
  std::map<std::filesystem::path, const StoredTake*> by_path_;
  std::map<std::string, std::vector<const StoredTake*>> by_name_;
};

}  // namespace kinebase::internal
