#include "library/cutting_plan.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

fs::path Canonical(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

bool IsBelow(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

void CheckFolders(const CutOptions& options) {
  std::error_code ignored;
  if (!fs::is_directory(options.in, ignored)) {
    throw Error(ErrorCode::kNotFound, "is no folder; the takes are looked for in it",
                {.file = options.in});
  }
  if (fs::exists(options.out, ignored) && !fs::is_directory(options.out, ignored)) {
    throw Error(ErrorCode::kIoFailure, "is no folder; the clips go into it", {.file = options.out});
  }
}

class Planner {
 public:
  Planner(const CutList& list, const CutOptions& options)
      : list_(list),
        options_(options),
        finder_(options.in),
        out_(Canonical(options.out / "clip").parent_path()) {}

  CutPlan Plan() {
    for (const Error& error : list_.refused) plan_.failures.push_back({error.place().file, error});
    if (!options_.skeleton.empty()) (void)SkeletonText(options_.skeleton);
    for (const Cut& cut : list_.cuts) PlanCut(cut);
    FailSourcesThatWouldBeReplaced();
    for (ClipPlan& clip : plan_.clips) {
      if (clip.type == ClipType::kAmc) clip.skeleton = SkeletonFor(clip);
    }
    return std::move(plan_);
  }

 private:
  void Fail(fs::path file, ErrorCode code, const std::string& message, const Cut& cut) {
    plan_.failures.push_back({std::move(file), Error(code, message, cut.place)});
  }

  void PlanCut(const Cut& cut) {
    const fs::path file = options_.out / cut.clip;
    std::vector<ClipType> types = {ClipType::kAmc, ClipType::kC3d};
    if (options_.type) types = {*options_.type};
    bool found = false;
    std::string extensions;
    for (const ClipType type : types) {
      const std::string extension(ExtensionOf(type));
      extensions += (extensions.empty() ? "" : " or ") + extension;
      const auto& source = finder_.Find(cut.take, type);
      if (!source) continue;
      found = true;
      fs::path clip_file = file;
      clip_file += extension;  // Not replace_extension: a name may hold a full stop.
      AddClip({.cut = cut,
               .type = type,
               .source = source->file,
               .source_name = source->name,
               .file = std::move(clip_file)});
    }
    if (found) return;
    Fail(file, ErrorCode::kNotFound,
         fmt::format("no take '{}' ({}) in {}, nor with fewer folders before it", cut.take,
                     extensions, options_.in.string()),
         cut);
  }

  void AddClip(ClipPlan clip) {
    const auto [entry, is_new] = clip_of_file_.try_emplace(clip.file, plan_.clips.size());
    if (!is_new) {
      const ClipPlan& other = plan_.clips[entry->second];
      const bool is_same = other.source == clip.source &&
                           other.cut.first_frame == clip.cut.first_frame &&
                           other.cut.last_frame == clip.cut.last_frame;
      if (is_same) return;  // The same line twice, as in two lists.
      Fail(clip.file, ErrorCode::kInvalidArgument,
           fmt::format("the clip '{}' is already that of {}", clip.cut.clip,
                       other.cut.place.ToString()),
           clip.cut);
      return;
    }
    if (!IsBelow(Canonical(clip.file), out_)) {
      Fail(clip.file, ErrorCode::kInvalidArgument,
           fmt::format("the clip '{}' leads out of {} through a link", clip.cut.clip,
                       options_.out.string()),
           clip.cut);
      clip_of_file_.erase(entry);
      return;
    }
    plan_.sources.insert(Canonical(clip.source));
    plan_.clips.push_back(std::move(clip));
  }

  // Only now are all sources known.
  void FailSourcesThatWouldBeReplaced() {
    std::erase_if(plan_.clips, [&](const ClipPlan& clip) {
      if (!plan_.sources.contains(Canonical(clip.file))) return false;
      Fail(clip.file, ErrorCode::kInvalidArgument,
           fmt::format("the clip '{}' would replace a take; name another folder for the clips",
                       clip.cut.clip),
           clip.cut);
      return true;
    });
  }

  std::shared_ptr<const std::string> SkeletonText(const fs::path& file) {
    auto& contents = skeleton_texts_[file];
    if (!contents) {
      contents = std::make_shared<const std::string>(MappedFile(file).text());
      plan_.sources.insert(Canonical(file));
    }
    return contents;
  }

  // The skeleton of a source, looked for once; empty if there is none.
  const fs::path& SkeletonOf(const fs::path& source) {
    const auto [entry, is_new] = skeleton_of_source_.try_emplace(source, options_.skeleton);
    if (!is_new || !entry->second.empty()) return entry->second;
    try {
      entry->second = FindSkeleton(source);
      (void)SkeletonText(entry->second);
    } catch (const Error& error) {
      entry->second.clear();
      plan_.notes.push_back({source,
                             {.severity = Severity::kWarning,
                              .message = "its clips go without skeleton: " + error.message()}});
    }
    return entry->second;
  }

  // A skeleton HDM_bd.asf is found for HDM_bd_… only. Where its name does not fit the clip's, or
  // belongs to another skeleton, the copy has the clip's own.
  std::optional<SkeletonCopy> SkeletonFor(const ClipPlan& clip) {
    const fs::path& skeleton = SkeletonOf(clip.source);
    if (skeleton.empty()) return std::nullopt;
    SkeletonCopy copy{.contents = SkeletonText(skeleton)};
    const std::string stem = skeleton.stem().string();
    const std::string clip_name = fs::path(clip.cut.clip).filename().string();
    if (clip_name == stem || clip_name.starts_with(stem + '_')) {
      copy.file = clip.file.parent_path() / (stem + ".asf");
      if (IsFree(copy)) return copy;
    }
    copy.file = clip.file.parent_path() / (clip_name + ".asf");
    return copy;
  }

  bool IsFree(const SkeletonCopy& copy) {
    const auto [claim, is_new] = skeleton_claims_.try_emplace(copy.file, copy.contents);
    if (!is_new) return *claim->second == *copy.contents;
    std::error_code ignored;
    if (!fs::exists(copy.file, ignored) || HasContents(copy.file, *copy.contents)) return true;
    skeleton_claims_.erase(claim);
    return false;
  }

  const CutList& list_;
  const CutOptions& options_;
  SourceFinder finder_;
  fs::path out_;
  CutPlan plan_;
  std::map<fs::path, std::size_t> clip_of_file_;
  std::map<fs::path, std::shared_ptr<const std::string>> skeleton_texts_;
  std::map<fs::path, fs::path> skeleton_of_source_;
  std::map<fs::path, std::shared_ptr<const std::string>> skeleton_claims_;
};

}  // namespace

CutPlan PlanClips(const CutList& list, const CutOptions& options) {
  CheckFolders(options);
  return Planner(list, options).Plan();
}

}  // namespace kinebase::internal
