#include "kinebase/library/long_take.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {
namespace {

constexpr double kShortestGap_s = 2;
constexpr double kLongestGap_s = 10;

// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): the distributions of <random> differ between
// standard libraries.
class SeededDraw {
 public:
  explicit SeededDraw(std::uint64_t seed) : state_(seed) {}

  // A whole number from `low` to `high`. Counts here are small beside 2^64, so the remainder
  // favours none that anybody could measure.
  int Between(int low, int high) {
    return low + static_cast<int>(Next() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::uint64_t Next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

void CheckPart(const FeatureMatrix& part, const FeatureMatrix& first) {
  if (part.columns.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "a clip or filler of a long take has no columns");
  }
  if (part.rate_hz == first.rate_hz && part.feature_count == first.feature_count) return;
  throw Error(ErrorCode::kMismatch,
              fmt::format("a part of a long take has {} features at {} Hz, another {} at {} Hz; "
                          "extract all with one set and rate",
                          part.feature_count, part.rate_hz, first.feature_count, first.rate_hz));
}

void CheckParts(std::span<const ClipOfClass> clips, std::span<const FeatureMatrix> fillers) {
  if (clips.empty() || fillers.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a long take of {} clips and {} fillers; expected one of each at least",
                            clips.size(), fillers.size()));
  }
  for (const ClipOfClass& clip : clips) CheckPart(clip.features, clips.front().features);
  for (const FeatureMatrix& filler : fillers) CheckPart(filler, clips.front().features);
}

std::vector<std::size_t> ShuffledOrder(std::size_t count, SeededDraw& draw) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) {
    const int other = draw.Between(0, static_cast<int>(i) - 1);
    std::swap(order[i - 1], order[static_cast<std::size_t>(other)]);
  }
  return order;
}

void Append(LongTake& take, const FeatureMatrix& features, const LongTake::Part& part) {
  const auto begin = features.columns.begin() + part.first;
  take.features.columns.insert(take.features.columns.end(), begin, begin + part.count);
  take.parts.push_back(part);
}

void AppendGap(LongTake& take, std::span<const FeatureMatrix> fillers, SeededDraw& draw) {
  const auto columns_in = [&](double seconds) {
    return std::max(1, static_cast<int>(std::lround(seconds * take.features.rate_hz)));
  };
  int missing = draw.Between(columns_in(kShortestGap_s), columns_in(kLongestGap_s));
  while (missing > 0) {
    const int chosen = draw.Between(0, static_cast<int>(fillers.size()) - 1);
    const auto source = static_cast<std::size_t>(chosen);
    const FeatureMatrix& filler = fillers[source];
    const int count = std::min(missing, filler.column_count());
    const int first = draw.Between(0, filler.column_count() - count);
    Append(take, filler, {.source = source, .first = first, .count = count});
    missing -= count;
  }
}

}  // namespace

LongTake MakeLongTake(std::span<const ClipOfClass> clips, std::span<const FeatureMatrix> fillers,
                      std::uint64_t seed) {
  CheckParts(clips, fillers);
  SeededDraw draw(seed);
  LongTake take;
  take.features.rate_hz = clips.front().features.rate_hz;
  take.features.feature_count = clips.front().features.feature_count;
  AppendGap(take, fillers, draw);
  for (const std::size_t i : ShuffledOrder(clips.size(), draw)) {
    const ClipOfClass& clip = clips[i];
    const int first = take.features.column_count();
    Append(take, clip.features,
           {.is_clip = true, .source = i, .count = clip.features.column_count()});
    take.truth.push_back({clip.motion_class, first, take.features.column_count() - 1});
    AppendGap(take, fillers, draw);
  }
  return take;
}

PoseStream JoinPoses(const LongTake& take, std::span<const PoseStream* const> clips,
                     std::span<const PoseStream* const> fillers) {
  PoseStream joined{.rate_hz = take.features.rate_hz};
  for (const LongTake::Part& part : take.parts) {
    const auto& streams = part.is_clip ? clips : fillers;
    if (part.source >= streams.size() ||
        streams[part.source]->column_count() < part.first + part.count) {
      throw Error(ErrorCode::kMismatch, "the poses are not those of the take's clips and fillers");
    }
    const auto begin = streams[part.source]->values.begin() +
                       static_cast<std::ptrdiff_t>(part.first) * kPoseValues;
    joined.values.insert(joined.values.end(), begin,
                         begin + static_cast<std::ptrdiff_t>(part.count) * kPoseValues);
  }
  return joined;
}

}  // namespace kinebase
