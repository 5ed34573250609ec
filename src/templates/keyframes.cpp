#include "kinebase/templates/keyframes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/templates/quantized_template.h"

namespace kinebase {
namespace {

constexpr double kOneScore = 2;
constexpr double kZeroScore = 1.2;
constexpr double kLeastScore = 0.9;
constexpr double kFadedPart = 0.2;  // Of the template, at either end.
constexpr int kReach = 5;           // Columns before and after a keyframe without another.

QuantizedTemplate Quantized(const MotionTemplate& motion_template) {
  return Quantize(motion_template.matrix, motion_template.quantisation, motion_template.matching);
}

// Entries that are consistent in their column and the same in both neighbours; none in the first
// and the last column.
std::vector<QuantizedColumn> LastingEntries(const QuantizedTemplate& quantized) {
  const std::vector<QuantizedColumn>& columns = quantized.columns;
  std::vector<QuantizedColumn> lasting(columns.size());
  for (std::size_t k = 1; k + 1 < columns.size(); ++k) {
    const QuantizedColumn& before = columns[k - 1];
    const QuantizedColumn& column = columns[k];
    const QuantizedColumn& after = columns[k + 1];
    const std::uint64_t differs = (before.ones ^ column.ones) | (after.ones ^ column.ones);
    lasting[k].consistent = before.consistent & column.consistent & after.consistent & ~differs;
    lasting[k].ones = column.ones & lasting[k].consistent;
  }
  return lasting;
}

// Half a Hann window over the first and the last part of the template, 1 between them.
double Fade(int column, int column_count) {
  const double faded = kFadedPart * column_count;
  const double from_border = std::min(column, column_count - 1 - column) + 0.5;
  if (from_border >= faded) return 1;
  return (1 - std::cos(std::numbers::pi * from_border / faded)) / 2;
}

// [column] of one group.
std::vector<double> ScoresOf(const std::vector<QuantizedColumn>& lasting, std::uint64_t group) {
  std::vector<double> scores;
  for (std::size_t k = 0; k < lasting.size(); ++k) {
    const int ones = std::popcount(lasting[k].ones & group);
    const int zeros = std::popcount(lasting[k].consistent & group) - ones;
    const double score = (kOneScore * ones + kZeroScore * zeros) / std::popcount(group);
    scores.push_back(score * Fade(static_cast<int>(k), static_cast<int>(lasting.size())));
  }
  return scores;
}

// Rules out a keyframe's column and, on either side, those on as long as scores fall.
void RuleOutPeak(std::span<const double> scores, int column, std::vector<char>& ruled_out) {
  const auto count = static_cast<int>(scores.size());
  for (const int step : {-1, 1}) {
    for (int k = column; k >= 0 && k < count; k += step) {
      if (k != column && scores[k] > scores[k - step]) break;
      ruled_out[k] = 1;
    }
  }
}

void RuleOutNeighbours(int column, std::vector<char>& ruled_out) {
  const int end = std::min(column + kReach + 1, static_cast<int>(ruled_out.size()));
  for (int k = std::max(column - kReach, 0); k < end; ++k) ruled_out[k] = 1;
}

struct Candidate {
  int column = 0;
  std::size_t group = 0;
  double score = 0;
};

// Best first.
std::vector<Candidate> Candidates(const std::vector<std::vector<double>>& scores) {
  std::vector<Candidate> candidates;
  for (std::size_t k = 0; k < scores.front().size(); ++k) {
    for (std::size_t group = 0; group < scores.size(); ++group) {
      if (scores[group][k] < kLeastScore) continue;
      candidates.push_back(
          {.column = static_cast<int>(k), .group = group, .score = scores[group][k]});
    }
  }
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::score);
  return candidates;
}

std::string ProblemOf(const Keyframe& keyframe, int column_count, int feature_count) {
  if (keyframe.column < 0 || keyframe.column >= column_count) {
    return fmt::format("column {}; expected 0 to {}", keyframe.column, column_count - 1);
  }
  const int tested = std::popcount(keyframe.tested);
  if (tested == 0) return "no feature to test; expected at least one";
  const auto highest = static_cast<int>(std::bit_width(keyframe.tested));
  if (highest > feature_count) {
    return fmt::format("feature {}; expected 1 to {}", highest, feature_count);
  }
  if ((keyframe.ones & ~keyframe.tested) != 0) return "ones among features that it does not test";
  if (keyframe.misses < 0 || keyframe.misses >= tested) {
    return fmt::format("{} misses; expected 0 to {}, as it tests {}", keyframe.misses, tested - 1,
                       tested);
  }
  if (keyframe.stiffness && !(*keyframe.stiffness >= 0 && *keyframe.stiffness <= 1)) {
    return fmt::format("stiffness {}; expected 0 to 1", *keyframe.stiffness);
  }
  return {};
}

}  // namespace

std::vector<Keyframe> ChooseKeyframes(const MotionTemplate& motion_template,
                                      const FeatureSet& features, const KeyframeOptions& options) {
  CheckFeatureSet(motion_template, features);
  if (options.most < 1 || options.misses < 0) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("{} keyframes with {} misses; expected at least 1 with 0 or more",
                            options.most, options.misses));
  }
  const std::vector<QuantizedColumn> lasting = LastingEntries(Quantized(motion_template));
  const std::vector<FeatureGroup> groups = features.Groups();
  std::vector<std::vector<double>> scores;
  scores.reserve(groups.size());
  for (const FeatureGroup& group : groups) scores.push_back(ScoresOf(lasting, group.features));
  std::vector<std::vector<char>> ruled_out(groups.size(), std::vector<char>(lasting.size()));

  std::vector<Keyframe> keyframes;
  for (const Candidate& candidate : Candidates(scores)) {
    if (std::ssize(keyframes) == options.most) break;
    const auto k = static_cast<std::size_t>(candidate.column);
    if (ruled_out[candidate.group][k] != 0) continue;
    const std::uint64_t tested = lasting[k].consistent & groups[candidate.group].features;
    keyframes.push_back({.column = candidate.column,
                         .tested = tested,
                         .ones = lasting[k].ones & tested,
                         .misses = std::min(options.misses, std::popcount(tested) - 1)});
    for (auto& columns : ruled_out) RuleOutNeighbours(candidate.column, columns);
    RuleOutPeak(scores[candidate.group], candidate.column, ruled_out[candidate.group]);
  }
  std::ranges::sort(keyframes, {}, &Keyframe::column);
  return keyframes;
}

Keyframe MakeKeyframe(const MotionTemplate& motion_template, int column, std::uint64_t tested,
                      int misses) {
  const QuantizedTemplate quantized = Quantized(motion_template);
  if (column < 0 || column >= quantized.column_count()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("template '{}' has no column {}; it has 0 to {}", motion_template.name,
                            column, quantized.column_count() - 1));
  }
  const QuantizedColumn& entries = quantized.columns[static_cast<std::size_t>(column)];
  const Keyframe keyframe{.column = column,
                          .tested = entries.consistent & tested,
                          .ones = entries.ones & tested,
                          .misses = misses};
  if (keyframe.tested == 0) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("template '{}' leaves all of these features free in column {}; choose "
                            "another column or other features",
                            motion_template.name, column));
  }
  const std::string problem =
      ProblemOf(keyframe, quantized.column_count(), quantized.feature_count);
  if (!problem.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a keyframe in column {} has {}", column, problem));
  }
  return keyframe;
}

std::string ProblemOfKeyframes(std::span<const Keyframe> keyframes, int column_count,
                               int feature_count) {
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const std::string problem = ProblemOf(keyframes[i], column_count, feature_count);
    if (!problem.empty()) return fmt::format("keyframe {} has {}", i + 1, problem);
    if (i > 0 && keyframes[i].column < keyframes[i - 1].column) {
      return fmt::format("keyframe {} is before the one before it; expected them by column", i + 1);
    }
  }
  return {};
}

}  // namespace kinebase
