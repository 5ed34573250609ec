// Cuts clips: a source at a time, each by one thread.

#include "kinebase/library/cutting.h"

#include <functional>
#include <map>
#include <mutex>
#include <new>
#include <optional>
#include <set>
#include <utility>

#include "kinebase/core/parallel.h"
#include "library/cutting_plan.h"
#include "library/cutting_take.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::ClipPlan;
using internal::CutPlan;
using internal::OpenTake;

class Cutter {
 public:
  Cutter(CutPlan plan, const CutOptions& options)
      : plan_(std::move(plan)),
        options_(options),
        states_(plan_.clips.size()),
        errors_(plan_.clips.size()) {
    std::map<fs::path, std::size_t> group_of_source;
    for (std::size_t i = 0; i < plan_.clips.size(); ++i) {
      const auto [entry, is_new] =
          group_of_source.try_emplace(plan_.clips[i].source, clips_of_source_.size());
      if (is_new) clips_of_source_.emplace_back();
      clips_of_source_[entry->second].push_back(i);
    }
    notes_.resize(clips_of_source_.size());
  }

  CutReport Cut() {
    ParallelFor(clips_of_source_.size(), options_.threads, "cutting", options_.progress,
                [&](std::size_t source) { CutSource(source); });
    return Report();
  }

 private:
  // Whatever goes wrong here is this source's alone.
  void CutSource(std::size_t source) {
    const std::vector<std::size_t>& clips = clips_of_source_[source];
    const ClipPlan& first = plan_.clips[clips.front()];
    std::optional<OpenTake> take;
    const auto error = ErrorOf(first.source, [&] {
      take.emplace(first.source, first.type, options_.strict);
      notes_[source] = take->diagnostics();
    });
    for (const std::size_t i : clips) {
      errors_[i] = error;
      if (error) continue;
      errors_[i] = ErrorOf(plan_.clips[i].file, [&] { WriteClip(*take, i); });
      if (errors_[i]) continue;
      const Diagnostics notes = take->NotesOn(plan_.clips[i]);
      notes_[source].insert(notes_[source].end(), notes.begin(), notes.end());
    }
  }

  static std::optional<Error> ErrorOf(const fs::path& file, const std::function<void()>& action) {
    try {
      action();
    } catch (const Error& error) {
      return error;
    } catch (const std::bad_alloc&) {
      return Error(ErrorCode::kIoFailure, "needs more memory than there is", {.file = file});
    }
    return std::nullopt;
  }

  void WriteClip(const OpenTake& take, std::size_t index) {
    const ClipPlan& clip = plan_.clips[index];
    const std::string bytes = take.Clip(clip);
    const ClipState state = StateOf(clip.file, bytes);
    if (clip.skeleton) WriteSkeleton(*clip.skeleton);
    Write(clip.file, bytes, state);
    states_[index] = state;
  }

  // What writing will do. Errors  AlreadyExists, IoFailure.
  [[nodiscard]] ClipState StateOf(const fs::path& file, std::string_view bytes) const {
    CheckWritable(file, Overwrite::kYes);  // It may be a folder or a device.
    std::error_code ignored;
    if (!fs::exists(file, ignored)) return ClipState::kNew;
    if (internal::HasContents(file, bytes)) return ClipState::kUnchanged;
    if (options_.overwrite == Overwrite::kNo) {
      throw Error(ErrorCode::kAlreadyExists,
                  "exists already with other contents; --force replaces it", {.file = file});
    }
    return ClipState::kReplaced;
  }

  void Write(const fs::path& file, std::string_view bytes, ClipState state) const {
    if (options_.dry_run || state == ClipState::kUnchanged) return;
    WriteFile(file, bytes, options_.overwrite);
  }

  // Clips of several sources share one skeleton: one thread writes it, the others find it there.
  void WriteSkeleton(const internal::SkeletonCopy& copy) {
    const std::lock_guard lock(skeletons_mutex_);
    if (skeletons_.contains(copy.file)) return;
    const ClipState state = StateOf(copy.file, *copy.contents);
    if (state == ClipState::kReplaced && plan_.sources.contains(fs::weakly_canonical(copy.file))) {
      throw Error(ErrorCode::kAlreadyExists,
                  "is the skeleton of a take and would be replaced by another; name another folder "
                  "for the clips",
                  {.file = copy.file});
    }
    Write(copy.file, *copy.contents, state);
    skeletons_.insert(copy.file);
  }

  CutReport Report() {
    CutReport report{.failures = std::move(plan_.failures), .notes = std::move(plan_.notes)};
    for (std::size_t i = 0; i < plan_.clips.size(); ++i) {
      ClipPlan& clip = plan_.clips[i];
      if (errors_[i]) {
        report.failures.push_back({std::move(clip.file), std::move(*errors_[i])});
      } else {
        report.clips.push_back({.file = std::move(clip.file),
                                .source = clip.source,
                                .first_frame = clip.cut.first_frame,
                                .last_frame = clip.cut.last_frame,
                                .state = states_[i]});
      }
    }
    for (std::size_t source = 0; source < notes_.size(); ++source) {
      const fs::path& file = plan_.clips[clips_of_source_[source].front()].source;
      for (Diagnostic& diagnostic : notes_[source]) {
        report.notes.push_back({file, std::move(diagnostic)});
      }
    }
    report.skeletons.assign(skeletons_.begin(), skeletons_.end());
    return report;
  }

  CutPlan plan_;
  const CutOptions& options_;
  std::vector<ClipState> states_;             // [clip]
  std::vector<std::optional<Error>> errors_;  // [clip]
  std::vector<std::vector<std::size_t>> clips_of_source_;
  std::vector<Diagnostics> notes_;  // [source]
  std::mutex skeletons_mutex_;
  std::set<fs::path> skeletons_;
};

}  // namespace

CutReport CutClips(const CutList& list, const CutOptions& options) {
  return Cutter(internal::PlanClips(list, options), options).Cut();
}

}  // namespace kinebase
