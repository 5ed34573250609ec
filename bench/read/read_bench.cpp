// From a mapped file in the page cache to a record's numbers, one thread: AMC, BVH, CSM and C3D.
//
// Contenders are a plain reader with strtod, which also says which numbers are right, and the same
// with std::from_chars, which cannot be much outrun by a reader that uses from_chars; for C3D a
// copy of the bytes. "long" are made-up files: the frames of the real one many times over.
#include <benchmark/benchmark.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/formats/csm.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLongBytes = 100'000'000;

[[noreturn]] void Stop(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

// --- A plain reader of well-formed text: the numbers of all frames, one after another.

using TakeNumber = double (*)(const char*& at, const char* end);

double TakeByStrtod(const char*& at, const char* /*end*/) {
  char* next = nullptr;
  const double value = std::strtod(at, &next);
  at = next;
  return value;
}

double TakeByFromChars(const char*& at, const char* end) {
  double value = 0;
  at = std::from_chars(at, end, value).ptr;
  return value;
}

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// The numbers of a line; a drop-out is three that are missing.
template <TakeNumber kTake>
void TakeNumbers(std::string_view line, std::vector<double>& values) {
  const char* at = line.data();
  const char* const end = at + line.size();
  while (true) {
    while (at != end && IsBlank(*at)) ++at;
    if (at == end) return;
    if (*at == 'D') {
      values.insert(values.end(), 3, std::numeric_limits<double>::quiet_NaN());
      at += std::string_view("DROPOUT").size();
    } else {
      values.push_back(kTake(at, end));
    }
  }
}

std::string_view WithoutFirstWord(std::string_view line) {
  (void)TakeToken(line);
  return line;
}

template <TakeNumber kTake>
std::vector<double> ParsePlainly(std::string_view text, const fs::path& type) {
  std::vector<double> values;
  bool is_frames = type == ".amc";
  for (LineScanner lines(text); lines.Next();) {
    const std::string_view line = lines.line();
    if (!is_frames) {
      is_frames = line.starts_with("Frame Time") || EqualsIgnoringCase(Trim(line), "$points");
    } else if (type == ".bvh") {
      TakeNumbers<kTake>(line, values);
    } else if (type == ".csm" || (line[0] >= 'a' && line[0] <= 'z')) {
      TakeNumbers<kTake>(WithoutFirstWord(line), values);
    }
  }
  return values;
}

// --- Kinebase's readers.

std::vector<double> Read(const fs::path& file) {
  if (file.extension() == ".amc") return std::move(ReadAmc(file).values);
  if (file.extension() == ".bvh") return std::move(ReadBvh(file).values);
  return std::move(ReadCsm(file).values);
}

// --- Long files.

template <typename Value>
void Repeat(std::vector<Value>& values, std::int64_t times) {
  const std::vector<Value> once = values;
  values.reserve(once.size() * static_cast<std::size_t>(times));
  for (std::int64_t i = 1; i < times; ++i) values.insert(values.end(), once.begin(), once.end());
}

void RepeatNumbers(std::vector<std::int64_t>& numbers, std::int64_t times) {
  Repeat(numbers, times);
  for (std::size_t i = 1; i < numbers.size(); ++i) numbers[i] = numbers[i - 1] + 1;
}

std::string LongFile(const fs::path& file, std::int64_t times) {
  const auto type = file.extension();
  if (type == ".amc") {
    AmcMotion amc = ReadAmc(file);
    Repeat(amc.values, times);
    RepeatNumbers(amc.frame_numbers, times);
    return FormatAmc(amc);
  }
  if (type == ".bvh") {
    BvhMotion bvh = ReadBvh(file);
    Repeat(bvh.values, times);
    return FormatBvh(bvh);
  }
  if (type == ".csm") {
    CsmRecording csm = ReadCsm(file);
    Repeat(csm.values, times);
    RepeatNumbers(csm.frame_numbers, times);
    return FormatCsm(csm);
  }
  C3dRecording c3d = ReadC3d(file);
  Repeat(c3d.points, times);
  Repeat(c3d.analog, times);
  c3d.frame_count *= static_cast<std::size_t>(times);
  return FormatC3d(c3d);
}

// Files that are removed at the end.
class MadeUpFiles {
 public:
  MadeUpFiles() {
    std::string name = (fs::temp_directory_path() / "read_bench_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) Stop("cannot make a folder like " + name);
    folder_ = name;
  }
  MadeUpFiles(const MadeUpFiles&) = delete;
  MadeUpFiles& operator=(const MadeUpFiles&) = delete;
  ~MadeUpFiles() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  [[nodiscard]] fs::path Make(const fs::path& real) const {
    const auto times = kLongBytes / static_cast<std::int64_t>(fs::file_size(real));
    fs::path path = folder_ / ("long" + real.extension().string());
    std::ofstream(path, std::ios::binary) << LongFile(real, times);
    return path;
  }

 private:
  fs::path folder_;
};

// --- Checks, then benchmarks.

void CountBytes(benchmark::State& state, const fs::path& file) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(file)));
}

template <typename Reader>
void Register(const std::string& name, const fs::path& file, Reader read) {
  benchmark::RegisterBenchmark((file.filename().string() + "/" + name).c_str(),
                               [=](benchmark::State& state) {
                                 for (auto _ : state) benchmark::DoNotOptimize(read(file));
                                 CountBytes(state, file);
                               })
      ->Unit(benchmark::kMillisecond);
}

template <TakeNumber kTake>
std::vector<double> ReadPlainly(const fs::path& file) {
  const MappedFile mapped(file);
  return ParsePlainly<kTake>(mapped.text(), file.extension());
}

bool Same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
           return x == y || (std::isnan(x) && std::isnan(y));
         });
}

void AddText(const fs::path& file) {
  const std::vector<double> expected = ReadPlainly<TakeByStrtod>(file);
  if (expected.empty() || !Same(Read(file), expected) ||
      !Same(ReadPlainly<TakeByFromChars>(file), expected)) {
    Stop(file.string() + ": the contenders read different numbers");
  }
  if (fs::file_size(file) < kLongBytes / 2) Register("strtod", file, ReadPlainly<TakeByStrtod>);
  Register("from_chars", file, ReadPlainly<TakeByFromChars>);
  Register("kinebase", file, Read);
}

// The bytes of the frames of a file of Intel floats without analog samples.
std::vector<char> CopyPoints(const fs::path& file) {
  const MappedFile mapped(file);
  const std::string_view text = mapped.text();
  std::uint16_t block = 0;
  std::memcpy(&block, text.data() + 16, sizeof(block));
  const std::string_view data = text.substr((block - std::size_t{1}) * 512);
  return {data.begin(), data.end()};
}

void AddC3d(const fs::path& file) {
  const C3dRecording recording = ReadC3d(file);
  const std::vector<char> bytes = CopyPoints(file);
  const std::size_t size = recording.points.size() * sizeof(C3dPoint);
  if (size == 0 || size > bytes.size() ||
      std::memcmp(recording.points.data(), bytes.data(), size) != 0) {
    Stop(file.string() + ": the points are not the bytes of the file");
  }
  Register("copy", file, CopyPoints);
  Register("kinebase", file, [](const fs::path& path) { return ReadC3d(path); });
}

fs::path TestData(const fs::path& relative) {
  const char* named = std::getenv("KINEBASE_TEST_DATA");
  const fs::path root = named == nullptr ? fs::path(KINEBASE_SOURCE_DIR) / "../shared" : named;
  fs::path file = root / "data" / relative;
  if (!fs::exists(file)) Stop("needs " + file.string() + "; KINEBASE_TEST_DATA names the folder");
  return file;
}

void AddAll(const MadeUpFiles& long_files) {
  for (const char* name :
       {"cmu/135/135_02.amc", "bvh/misc/Boxing_Toes.bvh", "csm/ThomasFechten.csm"}) {
    AddText(TestData(name));
    AddText(long_files.Make(TestData(name)));
  }
  const fs::path points = TestData("hdm05/take_c3d/HDM_bd_05-01_01_120.c3d");
  AddC3d(points);
  AddC3d(long_files.Make(points));
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const kinebase::MadeUpFiles long_files;
  kinebase::AddAll(long_files);
  benchmark::RunSpecifiedBenchmarks();
}
