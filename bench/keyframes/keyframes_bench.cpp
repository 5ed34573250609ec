// Keyframes over 210 minutes at 30 Hz in takes of 100 seconds: an exact scan of everything beside
// preselection by stored run lists, by run lists that are made of the words, and by an index of
// patterns. All preselect the same, which is compared first.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "kinebase/search/keyframe_index.h"
#include "kinebase/search/template_search.h"

namespace kinebase {
namespace {

constexpr int kTakes = 126;
constexpr int kColumns = 3000;
constexpr int kFeatures = 39;
constexpr int kTemplateColumns = 36;
constexpr double kTau = 0.1;

const std::vector<FeatureGroup>& Groups() {
  static const std::vector<FeatureGroup> groups = {
      {"upper", (std::uint64_t{1} << 14U) - 1},
      {"lower", ((std::uint64_t{1} << 12U) - 1) << 14U},
      {"mix", ((std::uint64_t{1} << 13U) - 1) << 26U}};
  return groups;
}

// Every feature holds or fails for about a second.
FeatureMatrix MakeTake(std::mt19937& random) {
  FeatureMatrix take{.rate_hz = 30, .feature_count = kFeatures, .columns = {}};
  take.columns.reserve(kColumns);
  std::uint64_t word = 0;
  for (int column = 0; column < kColumns; ++column) {
    for (int feature = 0; feature < kFeatures; ++feature) {
      if (random() % 30 == 0) word ^= std::uint64_t{1} << feature;
    }
    take.columns.push_back(word);
  }
  return take;
}

struct Archive {
  std::vector<FeatureMatrix> takes;
  std::vector<FeatureView> views;
  std::vector<std::string> lists;

  Archive() {
    std::mt19937 random(1);
    takes.reserve(kTakes);
    lists.reserve(kTakes);
    for (int i = 0; i < kTakes; ++i) {
      takes.push_back(MakeTake(random));
      lists.push_back(FormatRunLists(takes.back()));
    }
    views = ViewsOf(takes);
  }
};

const Archive& TheArchive() {
  static const Archive archive;
  return archive;
}

// A stretch of a take with a third of the entries free, as learned templates have.
QuantizedTemplate MakeTemplate() {
  std::mt19937 random(2);
  TemplateMatrix matrix{.rate_hz = 30, .feature_count = kFeatures, .values = {}, .weights = {}};
  for (int column = 0; column < kTemplateColumns; ++column) {
    for (int feature = 0; feature < kFeatures; ++feature) {
      const double value = TheArchive().views[7].at(1000 + column, feature) ? 1 : 0;
      matrix.values.push_back(random() % 3 == 0 ? 0.5 : value);
    }
    matrix.weights.push_back(1);
  }
  return Quantize(matrix, 0.1, Profile::kBonn);
}

// What the lower body shows in two columns, all of it but for `misses` features.
std::vector<Keyframe> MakeKeyframes(int misses) {
  const QuantizedTemplate motion_template = MakeTemplate();
  std::vector<Keyframe> keyframes;
  for (const int column : {9, 26}) {
    const auto& wanted = motion_template.columns[static_cast<std::size_t>(column)];
    Keyframe keyframe{.column = column, .tested = wanted.consistent & Groups()[1].features};
    keyframe.ones = wanted.ones & keyframe.tested;
    keyframe.misses = misses;
    keyframes.push_back(keyframe);
  }
  return keyframes;
}

std::vector<Stretch> ByLists(const std::vector<Keyframe>& keyframes, bool are_stored) {
  std::vector<Stretch> selected;
  for (int i = 0; i < kTakes; ++i) {
    const auto take = static_cast<std::size_t>(i);
    std::string made;
    if (!are_stored) made = FormatRunLists(TheArchive().views[take]);
    const RunLists lists(are_stored ? TheArchive().lists[take] : made, kFeatures, kColumns);
    const auto found = Preselect(keyframes, kTemplateColumns, Groups(), lists, i);
    selected.insert(selected.end(), found.begin(), found.end());
  }
  return selected;
}

std::vector<Stretch> ByIndex(const std::vector<Keyframe>& keyframes) {
  return KeyframeIndex(TheArchive().views, Groups()).Preselect(keyframes, kTemplateColumns);
}

void CheckThatAllAgree(const std::vector<Keyframe>& keyframes) {
  const std::vector<Stretch> expected = ByIndex(keyframes);
  if (ByLists(keyframes, true) == expected && ByLists(keyframes, false) == expected) return;
  std::fprintf(stderr, "run lists and the index of patterns select different stretches\n");
  std::exit(1);
}

void RunScan(benchmark::State& state) {
  const QuantizedTemplate motion_template = MakeTemplate();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        SearchTemplate(motion_template, TheArchive().views, {.tau = kTau, .threads = 1}));
  }
}

template <typename Preselection>
void RunPreselected(benchmark::State& state, const std::vector<Keyframe>& keyframes,
                    const Preselection& preselect) {
  const QuantizedTemplate motion_template = MakeTemplate();
  double columns = 0;
  for (auto _ : state) {
    const std::vector<Stretch> stretches = preselect(keyframes);
    columns = static_cast<double>(CountColumns(stretches));
    benchmark::DoNotOptimize(SearchTemplate(motion_template, TheArchive().views, stretches,
                                            {.tau = kTau, .threads = 1}));
  }
  state.counters["searched %"] = 100 * columns / (kTakes * kColumns);
}

void Register() {
  double bytes = 0;
  for (const std::string& lists : TheArchive().lists) bytes += static_cast<double>(lists.size());
  std::fprintf(stderr, "lists: %.3f bytes a column\n", bytes / (kTakes * kColumns));
  benchmark::RegisterBenchmark("scan of everything", RunScan);
  for (const int misses : {0, 1, 2}) {
    const std::vector<Keyframe> keyframes = MakeKeyframes(misses);
    CheckThatAllAgree(keyframes);
    const std::string name = ", " + std::to_string(misses) + " misses";
    benchmark::RegisterBenchmark(("stored lists" + name).c_str(), [=](benchmark::State& state) {
      RunPreselected(state, keyframes, [](const auto& asked) { return ByLists(asked, true); });
    });
    benchmark::RegisterBenchmark(("lists made" + name).c_str(), [=](benchmark::State& state) {
      RunPreselected(state, keyframes, [](const auto& asked) { return ByLists(asked, false); });
    });
    benchmark::RegisterBenchmark(("index made" + name).c_str(), [=](benchmark::State& state) {
      RunPreselected(state, keyframes, [](const auto& asked) { return ByIndex(asked); });
    });
  }
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  kinebase::Register();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
