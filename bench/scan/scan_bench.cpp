// One template over 210 minutes at 30 Hz: the plain kernel against the vector kernel, and the
// search for hits, on every instruction set that this machine has; then 64 templates. Cells are
// template columns × recording columns.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "kinebase/search/subsequence_dtw.h"
#include "kinebase/search/template_search.h"

namespace kinebase {
namespace {

constexpr int kColumns = 378'000;
constexpr int kFeatures = 39;

// Every feature holds or fails for about half a second.
FeatureMatrix MakeRecording() {
  std::mt19937 random(1);
  FeatureMatrix recording{.rate_hz = 30, .feature_count = kFeatures, .columns = {}};
  std::uint64_t word = 0;
  for (int column = 0; column < kColumns; ++column) {
    for (int feature = 0; feature < kFeatures; ++feature) {
      if (random() % 15 == 0) word ^= std::uint64_t{1} << feature;
    }
    recording.columns.push_back(word);
  }
  return recording;
}

const FeatureMatrix& Recording() {
  static const FeatureMatrix recording = MakeRecording();
  return recording;
}

// A stretch of the recording with a third of the entries free, as learned templates have.
QuantizedTemplate MakeTemplate(int columns) {
  std::mt19937 random(2);
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = kFeatures, .values = {}, .weights = {}};
  for (int column = 0; column < columns; ++column) {
    for (int feature = 0; feature < kFeatures; ++feature) {
      const double value = Recording().at(1000 + column, feature) ? 1 : 0;
      matrix.values.push_back(random() % 3 == 0 ? 0.5 : value);
    }
    matrix.weights.push_back(0.75 + static_cast<double>(random() % 100) / 200);
  }
  return Quantize(matrix, 0.1, Profile::kBonn);
}

void CountCells(benchmark::State& state, int template_columns) {
  state.counters["cells/s"] = benchmark::Counter(static_cast<double>(template_columns) * kColumns,
                                                 benchmark::Counter::kIsIterationInvariantRate);
}

void RunReference(benchmark::State& state, int template_columns) {
  const QuantizedTemplate motion_template = MakeTemplate(template_columns);
  for (auto _ : state) {
    benchmark::DoNotOptimize(ComputeDeltaReference(motion_template, Recording().columns));
  }
  CountCells(state, template_columns);
}

void RunVector(benchmark::State& state, int template_columns, std::int64_t target) {
  const QuantizedTemplate motion_template = MakeTemplate(template_columns);
  UseDeltaTarget(target);
  for (auto _ : state) {
    benchmark::DoNotOptimize(ComputeDelta(motion_template, Recording().columns));
  }
  UseDeltaTarget(0);
  CountCells(state, template_columns);
}

// As of a template with a contrast: every mismatch has a cost of its own.
QuantizedTemplate MakeWeightedTemplate(int columns) {
  std::mt19937 random(3);
  QuantizedTemplate motion_template = MakeTemplate(columns);
  for (QuantizedColumn& column : motion_template.columns) {
    column.consistent = (std::uint64_t{1} << kFeatures) - 1;
    std::vector<double> costs;
    double sum = 0;
    for (int feature = 0; feature < kFeatures; ++feature) {
      sum += costs.emplace_back(static_cast<double>(random() % 1000));
    }
    for (const double cost : costs) motion_template.costs.push_back(cost / sum);
  }
  return motion_template;
}

constexpr double kTau = 0.1;

// Hits and starts included.
void RunSearch(benchmark::State& state, const QuantizedTemplate& motion_template,
               std::int64_t target, int threads) {
  UseDeltaTarget(target);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        SearchTemplate(motion_template, {&Recording(), 1}, {.tau = kTau, .threads = threads}));
  }
  UseDeltaTarget(0);
  CountCells(state, motion_template.column_count());
}

// As many as the paper's classes, 18 to 144 columns long.
void RunManySearches(benchmark::State& state, int threads) {
  std::vector<QuantizedTemplate> templates;
  int columns = 0;
  for (int i = 0; i < 64; ++i) {
    templates.push_back(MakeTemplate(18 + 2 * i));
    columns += templates.back().column_count();
  }
  for (auto _ : state) {
    for (const QuantizedTemplate& each : templates) {
      benchmark::DoNotOptimize(
          SearchTemplate(each, {&Recording(), 1}, {.tau = kTau, .threads = threads}));
    }
  }
  CountCells(state, columns);
}

void CheckHits(const QuantizedTemplate& motion_template) {
  const std::vector<Hit> expected =
      BestHits(ExtractHits(ComputeDeltaReference(motion_template, Recording().columns), kTau), 500);
  for (const std::int64_t target : SupportedDeltaTargets()) {
    UseDeltaTarget(target);
    const auto actual = SearchTemplate(motion_template, {&Recording(), 1}, {.tau = kTau});
    UseDeltaTarget(0);
    if (actual == expected) continue;
    std::fprintf(stderr, "%s finds other hits at K = %d\n", DeltaTargetName(target),
                 motion_template.column_count());
    std::exit(1);
  }
}

void CheckThatAllAgree(int template_columns) {
  const QuantizedTemplate motion_template = MakeTemplate(template_columns);
  const DeltaCurve expected = ComputeDeltaReference(motion_template, Recording().columns);
  for (const std::int64_t target : SupportedDeltaTargets()) {
    UseDeltaTarget(target);
    const DeltaCurve actual = ComputeDelta(motion_template, Recording().columns);
    UseDeltaTarget(0);
    const bool same_delta = std::memcmp(actual.delta.data(), expected.delta.data(),
                                        expected.delta.size() * sizeof(double)) == 0;
    if (same_delta && actual.start == expected.start) continue;
    std::fprintf(stderr, "%s differs from the reference at K = %d\n", DeltaTargetName(target),
                 template_columns);
    std::exit(1);
  }
}

void RegisterAll(int template_columns) {
  const std::string columns = "/K=" + std::to_string(template_columns);
  const auto add = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
  };
  add("reference" + columns,
      [=](benchmark::State& state) { RunReference(state, template_columns); });
  for (const std::int64_t target : SupportedDeltaTargets()) {
    add(DeltaTargetName(target) + columns,
        [=](benchmark::State& state) { RunVector(state, template_columns, target); });
  }
  const auto add_search = [&](const std::string& name, bool weighted, std::int64_t target,
                              int threads) {
    const auto run = [=](benchmark::State& state) {
      const auto motion_template =
          weighted ? MakeWeightedTemplate(template_columns) : MakeTemplate(template_columns);
      RunSearch(state, motion_template, target, threads);
    };
    auto* added = benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
    if (threads > 1) added->UseRealTime();
  };
  for (const std::int64_t target : SupportedDeltaTargets()) {
    const std::string name = DeltaTargetName(target) + columns;
    add_search("search/" + name, false, target, 1);
    add_search("weighted/" + name, true, target, 1);
  }
  add_search("search/two threads" + columns, false, 0, 2);
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const int template_columns : {18, 36, 64, 106}) {
    kinebase::CheckThatAllAgree(template_columns);
    kinebase::CheckHits(kinebase::MakeTemplate(template_columns));
    kinebase::CheckHits(kinebase::MakeWeightedTemplate(template_columns));
    kinebase::RegisterAll(template_columns);
  }
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(
        ("64 templates/threads=" + std::to_string(threads)).c_str(),
        [=](benchmark::State& state) { kinebase::RunManySearches(state, threads); })
        ->Unit(benchmark::kMillisecond);
  }
  benchmark::RunSpecifiedBenchmarks();
}
