#include "kinebase/library/evaluation_curves.h"

#include <algorithm>

namespace kinebase {
namespace {

// Level by level; empty curves do not count.
std::vector<double> MeanOf(std::span<const std::vector<double>> curves) {
  const auto counted =
      std::ranges::count_if(curves, [](const auto& curve) { return !curve.empty(); });
  if (counted == 0) return {};
  std::vector<double> mean(kRecallLevels, 0);
  for (const std::vector<double>& curve : curves) {
    for (std::size_t i = 0; i < curve.size(); ++i) {
      mean[i] += curve[i] / static_cast<double>(counted);
    }
  }
  // Many thirds may add up to more than one.
  for (double& value : mean) value = std::min(value, 1.0);
  return mean;
}

}  // namespace

std::vector<double> InterpolatedPrecision(std::span<const JudgedHit> hits, std::size_t relevant) {
  std::vector<double> precision(kRecallLevels, 0);
  std::size_t rank = 0;
  std::size_t right = 0;
  for (const JudgedHit& hit : hits) {
    if (hit.excused) continue;
    ++rank;
    if (!hit.right) continue;
    ++right;
    const double here = static_cast<double>(right) / static_cast<double>(rank);
    for (std::size_t level = 0; level < kRecallLevels; ++level) {
      // In whole numbers: right / relevant ≥ level / 100.
      if (right * (kRecallLevels - 1) < level * relevant) break;
      precision[level] = std::max(precision[level], here);
    }
  }
  return precision;
}

std::vector<double> MeanPrecision(const ClassResult& result) {
  std::vector<std::vector<double>> curves;
  curves.reserve(result.hits.size());
  for (const auto& [actor, hits] : result.hits) {
    curves.push_back(InterpolatedPrecision(hits, result.relevant.at(actor)));
  }
  return MeanOf(curves);
}

std::vector<double> MacroPrecision(const MethodResult& result) {
  std::vector<std::vector<double>> curves;
  curves.reserve(result.classes.size());
  for (const ClassResult& of_class : result.classes) curves.push_back(MeanPrecision(of_class));
  return MeanOf(curves);
}

std::int64_t Confusion::right() const {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < classes.size(); ++i) sum += counts[i][i];
  return sum;
}

std::int64_t Confusion::all() const {
  std::int64_t sum = 0;
  for (const std::vector<std::int64_t>& row : counts) {
    for (const std::int64_t count : row) sum += count;
  }
  return sum;
}

Confusion CountConfusion(const MethodResult& result) {
  Confusion confusion;
  for (const ClassResult& of_class : result.classes) {
    confusion.classes.push_back(of_class.class_name);
  }
  const std::size_t count = confusion.classes.size();
  confusion.counts.assign(count, std::vector<std::int64_t>(count + 1, 0));
  const auto number = [&](const std::string& name) {
    return static_cast<std::size_t>(std::ranges::find(confusion.classes, name) -
                                    confusion.classes.begin());
  };
  for (const ClassifiedClip& clip : result.clips) {
    const std::size_t shown = number(clip.class_name);
    if (shown < count) ++confusion.counts[shown][number(clip.taken_for)];
  }
  return confusion;
}

}  // namespace kinebase
