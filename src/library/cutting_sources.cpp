// Where the file of a take is.

#include <algorithm>

#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "library/cutting_plan.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

// HDM05 keeps the same take as HDM05_amc/bd/X.amc and HDM05_c3d/bd/X.c3d.
std::string InFolderOf(ClipType type, const std::string& take) {
  const std::string_view other = type == ClipType::kAmc ? "c3d" : "amc";
  const std::string_view own = type == ClipType::kAmc ? "amc" : "c3d";
  std::string name;
  for (std::size_t begin = 0; begin < take.size();) {
    const std::size_t slash = take.find('/', begin);
    const std::size_t end = slash == std::string::npos ? take.size() : slash + 1;
    std::string part = take.substr(begin, end - begin);
    const std::string folder = ToLower(part);
    if (folder == std::string(other) + '/' || folder.ends_with('_' + std::string(other) + '/')) {
      part.replace(part.size() - 1 - other.size(), other.size(), own);
    }
    name += part;
    begin = end;
  }
  return name;
}

}  // namespace

bool HasContents(const fs::path& file, std::string_view contents) {
  std::error_code error;
  const bool may_be =
      fs::is_regular_file(file, error) && fs::file_size(file, error) == contents.size();
  if (!may_be || error) return false;
  try {
    return MappedFile(file).text() == contents;
  } catch (const Error&) {
    return false;  // Gone, or not ours to read.
  }
}

std::string_view ExtensionOf(ClipType type) { return type == ClipType::kAmc ? ".amc" : ".c3d"; }

const std::optional<SourceFinder::Source>& SourceFinder::Find(const std::string& take,
                                                              ClipType type) {
  const auto [entry, is_new] = found_.try_emplace({take, type});
  if (is_new) entry->second = Look(take, type);
  return entry->second;
}

std::optional<SourceFinder::Source> SourceFinder::Look(const std::string& take, ClipType type) {
  for (const std::string& name : {InFolderOf(type, take), take}) {
    const std::string full_name = name + std::string(ExtensionOf(type));
    for (std::size_t begin = 0;; ++begin) {
      if (auto file = FileBelow(full_name.substr(begin))) {
        return Source{std::move(*file), full_name};
      }
      begin = full_name.find('/', begin);
      if (begin == std::string::npos) break;
    }
  }
  return std::nullopt;
}

std::optional<fs::path> SourceFinder::FileBelow(const std::string& name) {
  fs::path path = folder_;
  for (const fs::path& part : fs::path(name)) {
    const std::string* entry = EntryIn(path, part.string());
    if (entry == nullptr) return std::nullopt;
    path /= *entry;
  }
  std::error_code ignored;
  return fs::is_regular_file(path, ignored) ? std::optional(path) : std::nullopt;
}

const std::string* SourceFinder::EntryIn(const fs::path& folder, const std::string& name) {
  const auto [known, is_new] = entries_.try_emplace(folder);
  auto& entries = known->second;
  if (is_new) {
    std::vector<std::string> names;
    std::error_code error;  // No folder, or one that cannot be read: nothing is found there.
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      names.push_back(entry->path().filename().string());
    }
    std::ranges::sort(names);  // Of several that differ in case alone the same is always taken.
    for (std::string& each : names) entries.emplace(ToLower(each), std::move(each));
  }
  const auto [begin, end] = entries.equal_range(ToLower(name));
  const auto exact =
      std::find_if(begin, end, [&](const auto& each) { return each.second == name; });
  if (exact != end) return &exact->second;
  return begin == end ? nullptr : &begin->second;
}

}  // namespace kinebase::internal
