#include "kinebase/motion/loose_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

namespace kinebase {
namespace {

// More than skin moves over a bone: on ThomasFechten.csm 99 % of the distances of markers that are
// in their places stay within 3 cm.
constexpr double kToleranceCm = 4;
constexpr double kToleranceShare = 0.15;
constexpr double kNoiseS = 0.25;

struct Pair {
  int a = 0;
  int b = 0;
  std::vector<double> off_cm;  // From the usual distance, by frame; NaN where one is missing.
  double tolerance_cm = 0;
};

// The middle of the narrowest range that holds half of the values: not moved by what is wrong in
// less than half of them, however wrong it is.
double MiddleOfShortestHalf(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2 + 1;
  std::size_t best = 0;
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + half <= values.size(); ++i) {
    const double width = values[i + half - 1] - values[i];
    if (width < narrowest) {
      narrowest = width;
      best = i;
    }
  }
  return values[best + half / 2];
}

Pair Measure(const MarkerCloud& markers, int a, int b) {
  Pair pair{.a = a, .b = b};
  std::vector<double> known;
  for (int frame = 0; frame < markers.frame_count; ++frame) {
    const bool is_missing = markers.is_missing(frame, a) || markers.is_missing(frame, b);
    pair.off_cm.push_back(is_missing ? std::numeric_limits<double>::quiet_NaN()
                                     : (markers.at(frame, a) - markers.at(frame, b)).norm());
    if (std::isfinite(pair.off_cm.back())) known.push_back(pair.off_cm.back());
  }
  if (known.empty()) return pair;
  const double usual = MiddleOfShortestHalf(std::move(known));
  pair.tolerance_cm = std::max(kToleranceCm, kToleranceShare * usual);
  for (double& distance : pair.off_cm) distance = std::abs(distance - usual);
  return pair;
}

std::optional<int> FindMarker(const MarkerCloud& markers, const MarkerSet::Names& labels) {
  for (const std::string& label : labels) {
    if (const auto marker = markers.FindMarker(label)) return marker;
  }
  return std::nullopt;
}

// "Ada:" of "Ada:LFHD"; empty if there is none.
std::string_view SubjectOf(const MarkerCloud& markers, int marker) {
  const std::string_view label = markers.labels[static_cast<std::size_t>(marker)];
  return label.substr(0, label.size() - BareLabel(label).size());
}

std::vector<Pair> PairsOfOneBone(const MarkerCloud& markers, std::span<const MarkerSet> sets) {
  std::set<std::pair<int, int>> seen;
  std::vector<Pair> pairs;
  for (const MarkerSet& set : sets) {
    for (const auto& [bone, names] : set.rigid) {
      std::vector<int> on_bone;
      for (const std::string& name : names) {
        if (const auto marker = FindMarker(markers, set.LabelsOf(name))) on_bone.push_back(*marker);
      }
      for (std::size_t i = 0; i < on_bone.size(); ++i) {
        for (std::size_t j = i + 1; j < on_bone.size(); ++j) {
          const auto [a, b] = std::minmax(on_bone[i], on_bone[j]);
          if (a == b || SubjectOf(markers, a) != SubjectOf(markers, b)) continue;
          if (seen.emplace(a, b).second) pairs.push_back(Measure(markers, a, b));
        }
      }
    }
  }
  return pairs;
}

// Takes notes of one marker after the other.
class Notes {
 public:
  explicit Notes(const MarkerCloud& markers) : markers_(markers) {}

  void Add(int marker, int frame, std::span<const Pair* const> off) {
    auto [entry, is_new] = loose_.try_emplace(marker);
    LooseMarker& loose = entry->second;
    if (is_new) loose.first = frame;
    loose.last = frame;
    ++loose.frames;
    for (const Pair* pair : off) {
      loose.farthest_cm =
          std::max(loose.farthest_cm, pair->off_cm[static_cast<std::size_t>(frame)]);
      others_[marker].insert(pair->a == marker ? pair->b : pair->a);
    }
  }

  std::vector<LooseMarker> Take() {
    std::vector<LooseMarker> result;
    for (auto& [marker, loose] : loose_) {
      if (loose.frames < kNoiseS * markers_.rate_hz) continue;
      loose.label = Label(marker);
      for (const int other : others_[marker]) loose.others.push_back(Label(other));
      result.push_back(std::move(loose));
    }
    return result;
  }

 private:
  const std::string& Label(int marker) const {
    return markers_.labels[static_cast<std::size_t>(marker)];
  }

  const MarkerCloud& markers_;
  std::map<int, LooseMarker> loose_;
  std::map<int, std::set<int>> others_;
};

using PairsByMarker = std::map<int, std::vector<const Pair*>>;

// The markers that most distances speak against: at least two, and at least half of their own.
// Several where it cannot be told which of them it is, as after a swap.
std::vector<int> MostSuspected(const std::map<int, int>& known, const PairsByMarker& off) {
  std::vector<int> most;
  std::size_t most_off = 2;
  for (const auto& [marker, pairs] : off) {
    if (pairs.size() < most_off || 2 * pairs.size() < static_cast<std::size_t>(known.at(marker))) {
      continue;
    }
    if (pairs.size() > most_off) most.clear();
    most.push_back(marker);
    most_off = pairs.size();
  }
  return most;
}

}  // namespace

std::vector<LooseMarker> FindLooseMarkers(const MarkerCloud& markers,
                                          std::span<const MarkerSet> sets) {
  const std::vector<Pair> pairs = PairsOfOneBone(markers, sets);
  Notes notes(markers);
  for (int frame = 0; frame < markers.frame_count; ++frame) {
    std::map<int, int> known;
    PairsByMarker off;
    for (const Pair& pair : pairs) {
      const double off_cm = pair.off_cm[static_cast<std::size_t>(frame)];
      if (std::isnan(off_cm)) continue;
      ++known[pair.a];
      ++known[pair.b];
      if (off_cm <= pair.tolerance_cm) continue;
      off[pair.a].push_back(&pair);
      off[pair.b].push_back(&pair);
    }
    for (auto most = MostSuspected(known, off); !most.empty(); most = MostSuspected(known, off)) {
      for (const int marker : most) {
        notes.Add(marker, frame, off[marker]);
        off.erase(marker);
      }
      for (auto& [other, its_pairs] : off) {
        std::erase_if(its_pairs, [&](const Pair* pair) {
          return !off.contains(pair->a) || !off.contains(pair->b);
        });
      }
    }
  }
  return notes.Take();
}

}  // namespace kinebase
