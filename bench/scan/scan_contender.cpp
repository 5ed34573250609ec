// Kinebase's scans under the rules of contender.py: scans a recording for a template some times and
// tells how long each kept the processor busy.
//
//   scan_contender list                                        names of contenders
//   scan_contender CONTENDER TEMPLATE RECORDING RUNS [DELTA]   files of 64-bit words, a column
//   each;
//                                                              DELTA gets the curve
//
// Both have 39 features, none of them free; profile `paper`, whose recurrence others have too.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/search/subsequence_dtw.h"
#include "kinebase/search/template_search.h"
#include "plain_kernel.h"

namespace kinebase {
namespace {

constexpr int kFeatures = 39;
constexpr double kTau = 0.1;
constexpr std::string_view kPlain = "plain double";
constexpr std::string_view kReference = "reference";

std::vector<std::uint64_t> ReadWords(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::uint64_t> words(bytes.size() / sizeof(std::uint64_t));
  std::copy_n(bytes.data(), words.size() * sizeof(std::uint64_t),
              reinterpret_cast<char*>(words.data()));
  return words;
}

QuantizedTemplate TemplateOf(const std::vector<std::uint64_t>& words) {
  QuantizedTemplate made{.rate_hz = 30, .feature_count = kFeatures, .matching = Profile::kPaper};
  made.columns.reserve(words.size());
  const std::uint64_t all = (std::uint64_t{1} << kFeatures) - 1;
  for (const std::uint64_t word : words) made.columns.push_back({all, word, 1.0 / kFeatures});
  return made;
}

// The curve of whole recordings, and of `search` the hits and starts below τ alone.
struct Contender {
  std::string name;
  std::int64_t target = 0;
  bool is_search = false;
};

std::vector<Contender> Contenders() {
  std::vector<Contender> all;
  for (const std::int64_t target : SupportedDeltaTargets()) {
    const std::string name = DeltaTargetName(target);
    all.push_back({"search " + name, target, true});
    all.push_back({"curve " + name, target, false});
  }
  all.push_back({std::string(kPlain)});
  all.push_back({std::string(kReference)});
  return all;
}

Contender FindContender(std::string_view name) {
  for (const Contender& contender : Contenders()) {
    if (contender.name == name) return contender;
  }
  fmt::print(stderr, "there is no contender '{}'\n", name);
  std::exit(2);
}

class Scan {
 public:
  Scan(Contender contender, std::vector<std::uint64_t> words, std::vector<std::uint64_t> columns)
      : contender_(std::move(contender)),
        words_(std::move(words)),
        template_(TemplateOf(words_)),
        recording_{.rate_hz = 30, .feature_count = kFeatures, .columns = std::move(columns)} {
    UseDeltaTarget(contender_.target);
  }

  // Empty for a search.
  [[nodiscard]] std::vector<double> Delta() const {
    if (contender_.name == kPlain) return PlainDelta(words_, recording_.columns, kFeatures);
    if (contender_.name == kReference) {
      return ComputeDeltaReference(template_, recording_.columns).delta;
    }
    if (!contender_.is_search) return ComputeDelta(template_, recording_.columns).delta;
    hits_ = SearchTemplate(template_, {&recording_, 1}, {.tau = kTau, .threads = 1});
    return {};
  }

  void CheckHits() const {
    if (!contender_.is_search) return;
    const auto expected =
        BestHits(ExtractHits(ComputeDeltaReference(template_, recording_.columns), kTau), 500);
    (void)Delta();
    if (hits_ == expected && !expected.empty()) return;
    fmt::print(stderr, "{} finds other hits than the reference, or none\n", contender_.name);
    std::exit(1);
  }

 private:
  Contender contender_;
  std::vector<std::uint64_t> words_;
  QuantizedTemplate template_;
  FeatureMatrix recording_;
  mutable std::vector<Hit> hits_;
};

double ProcessorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void Run(char** arguments, int count) {
  const Scan scan(FindContender(arguments[1]), ReadWords(arguments[2]), ReadWords(arguments[3]));
  scan.CheckHits();
  std::vector<double> delta = scan.Delta();
  const int runs = std::atoi(arguments[4]);
  std::vector<double> seconds;
  seconds.reserve(static_cast<std::size_t>(std::max(runs, 0)));
  for (int run = 0; run < runs; ++run) {
    const double begin = ProcessorSeconds();
    delta = scan.Delta();
    seconds.push_back(ProcessorSeconds() - begin);
  }
  if (count > 5) {
    std::ofstream(arguments[5], std::ios::binary)
        .write(reinterpret_cast<const char*>(delta.data()),
               static_cast<std::streamsize>(delta.size() * sizeof(double)));
  }
  fmt::print("{{\"seconds\": [{}]}}\n", fmt::join(seconds, ", "));
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  if (argc == 2 && std::string_view(argv[1]) == "list") {
    for (const auto& contender : kinebase::Contenders()) fmt::print("{}\n", contender.name);
    return 0;
  }
  if (argc < 5) {
    std::fprintf(stderr, "usage: scan_contender CONTENDER TEMPLATE RECORDING RUNS [DELTA]\n");
    return 2;
  }
  kinebase::Run(argv, argc);
}
