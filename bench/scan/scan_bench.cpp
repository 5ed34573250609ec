// One template over 210 minutes at 30 Hz: the plain kernel against the vector kernel on every
// instruction set that this machine has. Cells are template columns × recording columns.
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

// Hits and starts included.
void RunSearch(benchmark::State& state, int template_columns, int threads) {
  const QuantizedTemplate motion_template = MakeTemplate(template_columns);
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        SearchTemplate(motion_template, {&Recording(), 1}, {.tau = 0.1, .threads = threads}));
  }
  CountCells(state, template_columns);
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
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(
        ("search" + columns + "/threads=" + std::to_string(threads)).c_str(),
        [=](benchmark::State& state) { RunSearch(state, template_columns, threads); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  }
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (const int template_columns : {36, 106}) {
    kinebase::CheckThatAllAgree(template_columns);
    kinebase::RegisterAll(template_columns);
  }
  benchmark::RunSpecifiedBenchmarks();
}
