#include "library/cutting_take.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "fmt/format.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {
namespace {

constexpr std::string_view kGroup = "KINEBASE";

// A clip whose own name does not tell the rate that the take's name told would be read at another.
std::string RateNote(const ClipPlan& plan) {
  const double rate_hz = ParseTakeName(plan.source).rate_hz;
  const bool clip_tells = ParseTakeName(plan.file).rate_hz == rate_hz;
  return rate_hz > 0 && !clip_tells ? fmt::format(" at {:g} Hz", rate_hz) : "";
}

std::string AmcClip(const AmcMotion& take, const ClipPlan& plan) {
  AmcMotion clip = CutAmc(take, plan.cut.first_frame - 1, plan.cut.last_frame - 1);
  // After the comments that are there: a take that was cut itself keeps its own origin first, and
  // readers that expect the data right after `:DEGREES` are not put off.
  const auto is_comment = [](const std::string& line) { return line.starts_with('#'); };
  const auto after = std::find_if(clip.header.rbegin(), clip.header.rend(), is_comment).base();
  clip.header.insert(after,
                     fmt::format("# cut from {} frames {}-{}{} by Kinebase", plan.source_name,
                                 plan.cut.first_frame, plan.cut.last_frame, RateNote(plan)));
  return FormatAmc(clip);
}

// A take that was cut itself has the first entries already. Floats hold all whole numbers up to
// 16,777,216; int16 would end at 32,767.
void AppendFrame(C3dRecording& clip, std::string_view name, std::int64_t frame, std::size_t size) {
  std::vector<float> frames;
  for (const double each : NumberList(clip, kGroup, name)) {
    frames.push_back(static_cast<float>(each));
  }
  frames.resize(size);
  frames.push_back(static_cast<float>(frame));
  SetRealList(clip, kGroup, name, frames);
}

std::string C3dClip(const C3dRecording& take, const ClipPlan& plan) {
  C3dRecording clip = CutC3d(take, plan.cut.first_frame - 1, plan.cut.last_frame - 1);
  std::vector<std::string> sources = TextList(clip, kGroup, "SOURCE");
  AppendFrame(clip, "FIRST_FRAME", plan.cut.first_frame, sources.size());
  AppendFrame(clip, "LAST_FRAME", plan.cut.last_frame, sources.size());
  sources.push_back(plan.source_name);
  SetTextList(clip, kGroup, "SOURCE", sources);
  return FormatC3d(clip);
}

std::variant<AmcMotion, C3dRecording> ReadTake(const std::filesystem::path& file, ClipType type,
                                               bool strict) {
  if (type == ClipType::kAmc) return ReadAmc(file, {.strict = strict});
  return ReadC3d(file, {.strict = strict});
}

}  // namespace

OpenTake::OpenTake(const std::filesystem::path& file, ClipType type, bool strict)
    : record_(ReadTake(file, type, strict)) {}

const Diagnostics& OpenTake::diagnostics() const {
  return std::visit([](const auto& record) -> const Diagnostics& { return record.diagnostics; },
                    record_);
}

std::int64_t OpenTake::frame_count() const {
  if (const auto* amc = std::get_if<AmcMotion>(&record_)) {
    return static_cast<std::int64_t>(amc->frame_count());
  }
  return static_cast<std::int64_t>(std::get<C3dRecording>(record_).frame_count);
}

std::string OpenTake::Clip(const ClipPlan& plan) const {
  if (plan.cut.last_frame > frame_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("frames {} to {} are asked for; {} has 1 to {}", plan.cut.first_frame,
                            plan.cut.last_frame, plan.source.string(), frame_count()),
                plan.cut.place);
  }
  if (const auto* amc = std::get_if<AmcMotion>(&record_)) return AmcClip(*amc, plan);
  return C3dClip(std::get<C3dRecording>(record_), plan);
}

Diagnostics OpenTake::NotesOn(const ClipPlan& plan) const {
  const auto* amc = std::get_if<AmcMotion>(&record_);
  if (amc == nullptr) return {};
  const auto row =
      std::span(amc->values)
          .subspan(static_cast<std::size_t>(plan.cut.first_frame - 1) * amc->column_count,
                   amc->column_count);
  const auto missing = std::ranges::count_if(row, [](double v) { return !std::isfinite(v); });
  if (missing == 0) return {};
  return {{Severity::kWarning,
           fmt::format("{} begins in a gap: {} values of its first frame are those of the nearest "
                       "frame that has them",
                       plan.file.filename().string(), missing)}};
}

}  // namespace kinebase::internal
