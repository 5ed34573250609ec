#include "kinebase/library/hit_explanation.h"

#include <algorithm>
#include <limits>
#include <ranges>

#include "fmt/format.h"
#include "kinebase/templates/calibration.h"
#include "library/take_frames.h"

namespace kinebase {
namespace {

// The first column that reaches up to the frame.
int ColumnThatEndsWith(std::int64_t last_frame, const TakeFeatures& take) {
  if (last_frame < 1 || last_frame > take.frame_count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("has frames 1 to {}, not {}", take.frame_count, last_frame),
                {take.path});
  }
  const auto columns = std::views::iota(0, take.features.column_count());
  const auto found = std::ranges::partition_point(columns, [&](int column) {
    return internal::FramesOfHit(take, column, column).last < last_frame - 1;
  });
  return std::min(*found, take.features.column_count() - 1);
}

[[noreturn]] void ThrowNoPath(const TakeFeatures& take, std::optional<std::int64_t> last_frame) {
  throw Error(ErrorCode::kNotFound,
              last_frame
                  ? fmt::format("nothing that ends at frame {} is long enough for the template",
                                *last_frame)
                  : "is too short for the template",
              {take.path});
}

// Those that a search would let compete.
void CheckRivals(std::span<const MotionTemplate> templates) {
  if (templates.empty()) throw Error(ErrorCode::kInvalidArgument, "no template to explain");
  const MotionTemplate& explained = templates.front();
  for (const MotionTemplate& each : templates) {
    if (!each.contrast) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("template '{}' is a plain one: poses and rivals do not count for it; "
                              "learn it with method mt+",
                              each.name));
    }
    if (each.feature_set_hash == explained.feature_set_hash &&
        each.matrix.rate_hz == explained.matrix.rate_hz) {
      continue;
    }
    throw Error(ErrorCode::kMismatch,
                fmt::format("template '{}' was made with feature set '{}' at {} Hz, '{}' with '{}' "
                            "at {} Hz: only templates of one set and rate are rivals",
                            each.name, each.feature_set, each.matrix.rate_hz, explained.name,
                            explained.feature_set, explained.matrix.rate_hz));
  }
}

// Where the hit of the first template ends that a search puts first.
int BestEnd(std::span<const MotionTemplate> templates, const RecordingStreams& recording,
            const TakeFeatures& take) {
  const auto best = [&](std::optional<double> tau) {
    return RankHits(templates, std::span(&recording, 1), {.tau = tau, .most_hits = 1, .threads = 1})
        .front();
  };
  std::vector<RankedHit> ranked = best(templates.front().tau.value_or(kDefaultTau));
  if (ranked.empty()) ranked = best(std::numeric_limits<double>::infinity());
  if (ranked.empty()) ThrowNoPath(take, {});
  return ranked.front().hit.last;
}

}  // namespace

HitExplanation ExplainHit(const QuantizedTemplate& motion_template, const TakeFeatures& take,
                          std::optional<std::int64_t> last_frame) {
  const DeltaCurve curve = ComputeDelta(motion_template, take.features.columns);
  const auto best = std::ranges::min_element(curve.delta) - curve.delta.begin();
  const int last = last_frame ? ColumnThatEndsWith(*last_frame, take) : static_cast<int>(best);
  HitExplanation explanation{.cells = ExplainPath(motion_template, take.features.columns, last)};
  if (explanation.cells.empty()) ThrowNoPath(take, last_frame);
  const Hit hit{.first = explanation.cells.front().cell.recording_column,
                .last = last,
                .cost = curve.delta[static_cast<std::size_t>(last)]};
  explanation.hit = internal::ToTakeHit(hit, take, 0);
  return explanation;
}

HitExplanation ExplainRankedHit(std::span<const MotionTemplate> templates, const TakeFeatures& take,
                                std::optional<std::int64_t> last_frame) {
  CheckRivals(templates);
  const MotionTemplate& motion_template = templates.front();
  const RecordingStreams recording{.features = take.features, .poses = &take.poses};
  const int last =
      last_frame ? ColumnThatEndsWith(*last_frame, take) : BestEnd(templates, recording, take);
  const std::optional<RankedHit> ranked = RankEnd(templates, 0, recording, last);
  if (!ranked) ThrowNoPath(take, last_frame);

  HitExplanation explanation{
      .hit = internal::ToTakeHit(ranked->hit, take, 0),
      .cells = ExplainPath(Quantize(motion_template), take.features.columns, last),
      .matching = ranked->matching};
  // Both are weighed alike.
  const double poses = ranked->places + ranked->lookalikes;
  const double cost = ranked->hit.cost - ranked->matching;
  if (poses > 0) explanation.lookalikes_cost = cost * ranked->lookalikes / poses;
  explanation.places_cost = cost - explanation.lookalikes_cost;
  explanation.places =
      ExplainPlaces(motion_template.contrast->places, explanation.cells, take.poses);
  explanation.hit.score = ranked->score;
  if (motion_template.calibration) {
    explanation.hit.confidence = Confidence(*motion_template.calibration, ranked->hit.cost);
  }
  if (ranked->nearest) {
    const Rival& rival = *ranked->nearest;
    const Hit hit{.first = rival.first, .last = rival.last, .cost = rival.matching};
    explanation.rival = {rival.motion_template, internal::ToTakeHit(hit, take, 0)};
  }
  return explanation;
}

}  // namespace kinebase
