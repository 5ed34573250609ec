// Which clips a list asks for, from which files and into which.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinebase/library/cutting.h"

namespace kinebase::internal {

// ".amc", ".c3d".
std::string_view ExtensionOf(ClipType type);

// Whether there is a file with exactly these bytes.
bool HasContents(const std::filesystem::path& file, std::string_view contents);

// The skeleton file that goes along with a clip.
struct SkeletonCopy {
  std::shared_ptr<const std::string> contents;
  std::filesystem::path file;
};

struct ClipPlan {
  Cut cut;
  ClipType type = ClipType::kAmc;
  std::filesystem::path source;
  std::string source_name;  // Relative, as the list names it; for the clip's provenance.
  std::filesystem::path file;
  std::optional<SkeletonCopy> skeleton;
};

struct CutPlan {
  std::vector<ClipPlan> clips;
  std::vector<CutFailure> failures;
  std::vector<CutReport::Note> notes;
  std::set<std::filesystem::path> sources;  // Canonical; skeletons too.
};

// Looks for sources and skeletons, names clips and finds those that get in each other's way. Reads
// nothing but skeletons, writes nothing.
// Errors  NotFound, IoFailure: a folder or a skeleton of the options.
CutPlan PlanClips(const CutList& list, const CutOptions& options);

// Where the file of a take is.
class SourceFinder {
 public:
  explicit SourceFinder(std::filesystem::path folder) : folder_(std::move(folder)) {}

  struct Source {
    std::filesystem::path file;
    std::string name;  // Relative, with all folders.
  };

  // Upper and lower case count as equal where nothing matches exactly: the lists come from Windows.
  const std::optional<Source>& Find(const std::string& take, ClipType type);

 private:
  std::optional<Source> Look(const std::string& take, ClipType type);
  std::optional<std::filesystem::path> FileBelow(const std::string& name);
  // The name of what a folder holds; by lower case, exact matches first.
  const std::string* EntryIn(const std::filesystem::path& folder, const std::string& name);

  std::filesystem::path folder_;
  std::map<std::pair<std::string, ClipType>, std::optional<Source>> found_;
  std::map<std::filesystem::path, std::multimap<std::string, std::string>> entries_;
};

}  // namespace kinebase::internal
