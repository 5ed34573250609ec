#include "kinebase/templates/styles.h"

#include <algorithm>
#include <limits>

#include "kinebase/templates/learning.h"

namespace kinebase {
namespace {

constexpr std::size_t kFewestOfAStyle = 3;
// Of the mean silhouette: "a reasonable structure has been found" in Kaufman & Rousseeuw, Finding
// Groups in Data, 1990.
constexpr double kReasonable = 0.5;

using Group = std::vector<std::size_t>;

// Symmetric: cost of alignment for each cell of the path, one way and the other.
class Distances {
 public:
  Distances(std::span<const TemplateMatrix> performances, Profile profile)
      : count_(performances.size()), values_(count_ * count_) {
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const double there = CostOfCell(performances[i], performances[j], profile);
        const double back = CostOfCell(performances[j], performances[i], profile);
        values_[i * count_ + j] = values_[j * count_ + i] = (there + back) / 2;
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  // Mean over all pairs, without those of one with itself; 0 where there are none.
  [[nodiscard]] double Between(const Group& a, const Group& b) const {
    double sum = 0;
    double pairs = 0;
    for (const std::size_t i : a) {
      for (const std::size_t j : b) {
        if (i == j) continue;
        sum += values_[i * count_ + j];
        ++pairs;
      }
    }
    return pairs > 0 ? sum / pairs : 0;
  }

 private:
  static double CostOfCell(const TemplateMatrix& a, const TemplateMatrix& b, Profile profile) {
    const Alignment alignment = Align(a, b, profile);
    return alignment.cost / static_cast<double>(alignment.path.size());
  }

  std::size_t count_;
  std::vector<double> values_;
};

// Puts the two nearest groups together; of equally near ones the first.
void MergeNearest(const Distances& distances, std::vector<Group>& groups) {
  double least = std::numeric_limits<double>::infinity();
  std::size_t into = 0;
  std::size_t from = 1;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    for (std::size_t j = i + 1; j < groups.size(); ++j) {
      const double distance = distances.Between(groups[i], groups[j]);
      if (distance >= least) continue;
      least = distance;
      into = i;
      from = j;
    }
  }
  groups[into].insert(groups[into].end(), groups[from].begin(), groups[from].end());
  groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(from));
}

// Without groups that are too small to learn from: their performances go to the nearest of the
// others. Empty if there is no other.
std::vector<Group> LargeEnough(const Distances& distances, const std::vector<Group>& groups) {
  std::vector<Group> kept;
  Group left_over;
  for (const Group& group : groups) {
    if (group.size() >= kFewestOfAStyle) {
      kept.push_back(group);
    } else {
      left_over.insert(left_over.end(), group.begin(), group.end());
    }
  }
  if (kept.empty()) return kept;
  const std::vector<Group> cores = kept;
  for (const std::size_t each : left_over) {
    const auto distance = [&](const Group& core) { return distances.Between({each}, core); };
    const auto nearest = std::ranges::min_element(cores, {}, distance);
    kept[static_cast<std::size_t>(nearest - cores.begin())].push_back(each);
  }
  return kept;
}

// How much nearer a performance is to its own group than to the next, from -1 to 1; the mean.
double MeanSilhouette(const Distances& distances, const std::vector<Group>& groups) {
  double sum = 0;
  for (const Group& own : groups) {
    for (const std::size_t each : own) {
      const double inside = distances.Between({each}, own);
      double outside = std::numeric_limits<double>::infinity();
      for (const Group& other : groups) {
        if (&other != &own) outside = std::min(outside, distances.Between({each}, other));
      }
      const double larger = std::max(inside, outside);
      sum += larger > 0 ? (outside - inside) / larger : 0;
    }
  }
  return sum / static_cast<double>(distances.count());
}

// By the first of each.
std::vector<int> Numbered(std::vector<Group> groups, std::size_t count) {
  std::ranges::sort(groups, {}, [](const Group& group) { return std::ranges::min(group); });
  std::vector<int> style_of(count);
  for (std::size_t style = 0; style < groups.size(); ++style) {
    for (const std::size_t each : groups[style]) style_of[each] = static_cast<int>(style);
  }
  return style_of;
}

}  // namespace

std::vector<int> FindStyles(std::span<const TemplateMatrix> performances, Profile profile) {
  const std::size_t count = performances.size();
  if (count < 2 * kFewestOfAStyle) return std::vector<int>(count);
  const Distances distances(performances, profile);
  std::vector<Group> groups;
  for (std::size_t i = 0; i < count; ++i) groups.push_back({i});
  std::vector<Group> best;
  double best_silhouette = kReasonable;
  while (groups.size() > 2) {
    MergeNearest(distances, groups);
    const std::vector<Group> styles = LargeEnough(distances, groups);
    if (styles.size() < 2) continue;
    // Of two that are equally good the one with fewer, which comes later.
    const double silhouette = MeanSilhouette(distances, styles);
    if (silhouette < best_silhouette) continue;
    best_silhouette = silhouette;
    best = styles;
  }
  return Numbered(std::move(best), count);
}

}  // namespace kinebase
