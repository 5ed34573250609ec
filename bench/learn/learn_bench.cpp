// Learning one motion class of the sizes in the paper's Table 1, a jumping jack and a cartwheel,
// on one thread; first checked to give the same on two. In short classes about a third of the
// features never change, in a cartwheel all of them do.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <random>
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

void RunLearning(benchmark::State& state, Profile profile) {
  const std::vector<TemplateMatrix> performances =
      MakePerformances(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                       static_cast<int>(state.range(2)));
  LearnOptions options{.profile = profile, .threads = 2};
  const LearnedMatrix on_two_threads = LearnTemplate(performances, options);
  options.threads = 1;
  LearnedMatrix learned = LearnTemplate(performances, options);
  if (learned.matrix != on_two_threads.matrix) {
    std::fprintf(stderr, "one and two threads give different templates\n");
    std::exit(1);
  }
  for (auto _ : state) {
    learned = LearnTemplate(performances, options);
    benchmark::DoNotOptimize(learned);
  }
  state.counters["rounds"] = static_cast<double>(learned.largest_costs.size());
  state.counters["columns"] = learned.matrix.column_count();
}

BENCHMARK_CAPTURE(RunLearning, bonn, Profile::kBonn)
    ->Args({26, 36, 14})
    ->Args({11, 105, 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(RunLearning, paper, Profile::kPaper)
    ->Args({26, 36, 14})
    ->Args({11, 105, 0})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace kinebase

BENCHMARK_MAIN();
