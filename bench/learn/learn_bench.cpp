// Learning one motion class of the sizes in the paper's Table 1, a jumping jack and a cartwheel,
// on one thread. In short classes about a third of the features never change, in a cartwheel all of
// them do. The contender aligns every performance to every other one by the textbook's table of
// doubles; both, and two threads, give the same template, bit for bit.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "kinebase/templates/learning.h"

namespace kinebase {
namespace {

constexpr int kFeatures = 39;

// The same motion by several people: one sequence of states, each performance at its own, changing
// pace, and now and then a feature that does something else for a moment.
//
// still_features  Those that never change in this class.
std::vector<TemplateMatrix> MakePerformances(int count, int columns, int still_features) {
  std::mt19937 random(1);
  std::vector<std::vector<double>> motion(4 * static_cast<std::size_t>(columns),
                                          std::vector<double>(kFeatures));
  for (int feature = 0; feature < kFeatures; ++feature) {
    double state = random() % 2 == 0 ? 0 : 1;
    for (auto& column : motion) {
      if (feature >= still_features && random() % 50 == 0) state = 1 - state;
      column[feature] = state;
    }
  }
  std::vector<TemplateMatrix> performances;
  for (int i = 0; i < count; ++i) {
    TemplateMatrix matrix{.rate_hz = 30, .feature_count = kFeatures, .values = {}, .weights = {}};
    double pace = 4;
    for (double time = 0; time < static_cast<double>(motion.size()); time += pace) {
      const std::vector<double>& column = motion[static_cast<std::size_t>(time)];
      for (int feature = 0; feature < kFeatures; ++feature) {
        const bool is_odd = feature >= still_features && random() % 30 == 0;
        matrix.values.push_back(is_odd ? 1 - column[feature] : column[feature]);
      }
      matrix.weights.push_back(1);
      if (random() % 8 == 0) pace = 3 + static_cast<double>(random() % 100) / 40;
    }
    performances.push_back(std::move(matrix));
  }
  return performances;
}

double LocalCost(const TemplateMatrix& reference, int k, const TemplateMatrix& other, int l,
                 Profile profile) {
  const std::span<const double> a = reference.Column(k);
  const std::span<const double> b = other.Column(l);
  double sum = 0;
  for (std::size_t f = 0; f < a.size(); ++f) sum += std::abs(a[f] - b[f]);
  if (profile == Profile::kPaper) return sum;
  return sum / static_cast<double>(a.size()) * ((reference.weights[k] + other.weights[l]) / 2);
}

Alignment AlignPlainly(const TemplateMatrix& reference, const TemplateMatrix& other,
                       Profile profile) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const int columns = other.column_count();
  std::vector<double> costs(reference.weights.size() * other.weights.size());
  const auto cost = [&](int k, int l) -> double& {
    return costs[static_cast<std::size_t>(k) * columns + l];
  };
  const auto before = [&](int k, int l) { return k < 0 || l < 0 ? kInfinity : cost(k, l); };
  for (int k = 0; k < reference.column_count(); ++k) {
    for (int l = 0; l < columns; ++l) {
      const double nearest =
          k + l == 0 ? 0 : std::min({before(k - 1, l - 1), before(k, l - 1), before(k - 1, l)});
      cost(k, l) = nearest + LocalCost(reference, k, other, l, profile);
    }
  }
  Alignment alignment{.path = {}, .cost = costs.back()};
  int k = reference.column_count() - 1;
  int l = columns - 1;
  while (k >= 0 && l >= 0) {
    alignment.path.push_back({k, l});
    const double diagonal = before(k - 1, l - 1);
    const double along_other = before(k, l - 1);
    const double along_reference = before(k - 1, l);
    const bool is_diagonal = diagonal <= along_other && diagonal <= along_reference;
    const bool is_along_other = !is_diagonal && along_other <= along_reference;
    if (!is_along_other) --k;
    if (is_diagonal || is_along_other) --l;
  }
  std::ranges::reverse(alignment.path);
  return alignment;
}

// One round with `matrices[reference]` as the reference of all, and its largest cost.
TemplateMatrix TakeTurnPlainly(std::span<const TemplateMatrix> matrices, std::size_t reference,
                               Profile profile, double& largest_cost) {
  double largest = 0;
  std::vector<TemplateMatrix> warped;
  warped.reserve(matrices.size());
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    if (i == reference) {
      warped.push_back(matrices[i]);
      continue;
    }
    const Alignment alignment = AlignPlainly(matrices[reference], matrices[i], profile);
    warped.push_back(WarpToReference(matrices[i], alignment, matrices[reference].column_count()));
    largest = std::max(largest, alignment.cost);
  }
  const TemplateMatrix average = AverageMatrices(warped);
  if (profile == Profile::kPaper) largest /= average.feature_count;
  largest_cost = std::max(largest_cost, largest / average.total_weight());
  return Unwarp(average, profile);
}

LearnedMatrix LearnPlainly(std::span<const TemplateMatrix> performances,
                           const LearnOptions& options) {
  LearnedMatrix learned;
  std::vector<TemplateMatrix> matrices(performances.begin(), performances.end());
  for (int round = 0; round < options.max_rounds; ++round) {
    double largest_cost = 0;
    std::vector<TemplateMatrix> next;
    next.reserve(matrices.size());
    for (std::size_t i = 0; i < matrices.size(); ++i) {
      next.push_back(TakeTurnPlainly(matrices, i, options.profile, largest_cost));
    }
    matrices = std::move(next);
    const bool is_unchanged =
        !learned.largest_costs.empty() && learned.largest_costs.back() == largest_cost;
    learned.largest_costs.push_back(largest_cost);
    if (largest_cost <= options.cost_limit || is_unchanged) break;
  }
  learned.matrix = std::move(matrices[0]);
  return learned;
}

struct Size {
  int clips;
  int columns;
  int still_features;
};

void CheckThatAllAgree(std::span<const TemplateMatrix> performances, LearnOptions options) {
  const LearnedMatrix learned = LearnTemplate(performances, options);
  const LearnedMatrix plain = LearnPlainly(performances, options);
  options.threads = 2;
  if (learned.matrix == plain.matrix && learned.largest_costs == plain.largest_costs &&
      learned.matrix == LearnTemplate(performances, options).matrix) {
    return;
  }
  std::fprintf(stderr, "one thread, two threads and the plain way give different templates\n");
  std::exit(1);
}

template <typename Learn>
void RunLearning(benchmark::State& state, std::span<const TemplateMatrix> performances,
                 const LearnOptions& options, Learn learn) {
  LearnedMatrix learned;
  for (auto _ : state) {
    learned = learn(performances, options);
    benchmark::DoNotOptimize(learned);
  }
  state.counters["rounds"] = static_cast<double>(learned.largest_costs.size());
}

void Register(const Size& size, Profile profile, const std::string& profile_name) {
  const auto performances = std::make_shared<const std::vector<TemplateMatrix>>(
      MakePerformances(size.clips, size.columns, size.still_features));
  const LearnOptions options{.profile = profile, .threads = 1};
  CheckThatAllAgree(*performances, options);
  const std::string name = std::to_string(size.clips) + " clips of " +
                           std::to_string(size.columns) + " columns/" + profile_name;
  const auto add = [&](const std::string& contender, auto learn) {
    benchmark::RegisterBenchmark((name + '/' + contender).c_str(), [=](benchmark::State& state) {
      RunLearning(state, *performances, options, learn);
    })->Unit(benchmark::kMillisecond);
  };
  add("kinebase", LearnTemplate);
  add("plain", LearnPlainly);
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const kinebase::Size& size : {kinebase::Size{26, 36, 14}, {11, 105, 0}}) {
    kinebase::Register(size, kinebase::Profile::kBonn, "bonn");
    kinebase::Register(size, kinebase::Profile::kPaper, "paper");
  }
  benchmark::RunSpecifiedBenchmarks();
}
