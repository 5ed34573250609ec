// Kinebase's readers under the rules of contender.py: reads a file some times and tells how long
// each took and how much memory the first needed.
//
//   read_contender FILE RUNS [VALUES]      VALUES gets the numbers as 64-bit floats
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/formats/csm.h"

namespace kinebase {
namespace {

using Record = std::variant<AmcMotion, BvhMotion, CsmRecording, C3dRecording>;

Record Read(const std::filesystem::path& file) {
  const auto type = file.extension();
  if (type == ".amc") return ReadAmc(file);
  if (type == ".bvh") return ReadBvh(file);
  if (type == ".csm") return ReadCsm(file);
  return ReadC3d(file);
}

// Frame by frame; of C3D the places of the points, NaN where one is not seen, then all samples in
// real units.
std::vector<double> Values(const Record& record) {
  if (const auto* amc = std::get_if<AmcMotion>(&record)) return amc->values;
  if (const auto* bvh = std::get_if<BvhMotion>(&record)) return bvh->values;
  if (const auto* csm = std::get_if<CsmRecording>(&record)) return csm->values;
  const auto& c3d = std::get<C3dRecording>(record);
  std::vector<double> values;
  for (const C3dPoint& point : c3d.points) {
    for (const float value : {point.x, point.y, point.z}) {
      values.push_back(point.is_valid() ? double{value} : std::numeric_limits<double>::quiet_NaN());
    }
  }
  const std::vector<double> samples = ScaledAnalog(c3d);
  values.insert(values.end(), samples.begin(), samples.end());
  return values;
}

// What the numbers themselves take.
std::size_t Bytes(const Record& record) {
  const auto* c3d = std::get_if<C3dRecording>(&record);
  if (c3d == nullptr) return Values(record).size() * sizeof(double);
  return c3d->points.size() * sizeof(C3dPoint) + c3d->analog.size() * sizeof(float);
}

// A line of /proc/self/status, in bytes. getrusage's peak would not do: it begins with the memory
// of the process that started this one.
std::int64_t Status(std::string_view name) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name)) return std::atoll(line.c_str() + name.size() + 1) * 1024;
  }
  return 0;
}

double Seconds(const std::function<void()>& action) {
  const auto begin = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void Run(const std::filesystem::path& file, int runs, const char* values_file) {
  Record record;
  std::ofstream("/proc/self/clear_refs") << "5";  // From here on the peak counts anew.
  const std::int64_t before = Status("VmRSS");
  record = Read(file);
  const std::int64_t peak = Status("VmHWM") - before;

  std::vector<double> seconds;
  for (int run = 0; run < runs; ++run) {
    record = {};
    seconds.push_back(Seconds([&] { record = Read(file); }));
  }
  if (values_file != nullptr) {
    const std::vector<double> values = Values(record);
    std::ofstream(values_file, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(double)));
  }
  fmt::print("{{\"seconds\": [{}], \"peak_bytes\": {}, \"record_bytes\": {}}}\n",
             fmt::join(seconds, ", "), peak, Bytes(record));
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: read_contender FILE RUNS [VALUES]\n");
    return 2;
  }
  kinebase::Run(argv[1], std::atoi(argv[2]), argc > 3 ? argv[3] : nullptr);
}
