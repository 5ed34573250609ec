// From AMC files in the page cache to features in a library on disk, one thread. Beside it, what
// that consists of: reading alone, places of the joints, features; and the features of the same
// files from the library are compared with those, first.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "kinebase/formats/amc.h"
#include "kinebase/library/take_import.h"
#include "kinebase/library/take_library.h"
#include "kinebase/motion/kinematics.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

constexpr int kCopies = 32;  // Half a batch: the disk is waited for once a batch.

[[noreturn]] void Stop(const std::string& message) {
  std::fprintf(stderr, "%s\n", message.c_str());
  std::exit(1);
}

std::string ReadText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) Stop(path.string() + " cannot be read; KINEBASE_TEST_DATA names the recordings");
  return {std::istreambuf_iterator<char>(file), {}};
}

// A folder that goes when the program ends.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "kinebase-import-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) Stop("no folder can be made for temporary files");
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Copies of real recordings, each with a comment of its own: features of the same bytes would not
// be computed twice.
class Recordings {
 public:
  Recordings() {
    const char* data = std::getenv("KINEBASE_TEST_DATA");
    const fs::path root = fs::path(data != nullptr ? data : "../shared") / "data" / "cmu" / "135";
    fs::copy_file(root / "135.asf", folder_.path() / "135.asf");
    const std::string text = ReadText(root / "135_02.amc");
    sources_.reserve(kCopies);
    for (int i = 0; i < kCopies; ++i) {
      const fs::path file = folder_.path() / ("135_" + std::to_string(i + 10) + ".amc");
      std::ofstream(file, std::ios::binary) << "# copy " << i << '\n' << text;
      sources_.push_back({.file = file});
      bytes_ += static_cast<std::int64_t>(fs::file_size(file));
    }
  }

  [[nodiscard]] const fs::path& folder() const { return folder_.path(); }
  [[nodiscard]] const std::vector<ImportSource>& sources() const { return sources_; }
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  Folder folder_;
  std::vector<ImportSource> sources_;
  std::int64_t bytes_ = 0;
};

const Recordings& Files() {
  static const Recordings recordings;
  return recordings;
}

const FeatureSet& Features() {
  static const FeatureSet features = LoadFeatureSet("bonn");
  return features;
}

JointTrajectories JointsOf(const fs::path& file) {
  Diagnostics ignored;
  return StandardJoints(LoadRecording(file), ignored);
}

ImportReport ImportInto(const fs::path& library) {
  return ImportTakes(library, Files().sources(), {.features = Features(), .threads = 1});
}

void CountBytes(benchmark::State& state) {
  state.SetBytesProcessed(Files().bytes() * static_cast<std::int64_t>(state.iterations()));
}

template <typename Action>
void RunForEachFile(benchmark::State& state, Action action) {
  for (auto _ : state) {
    for (const ImportSource& source : Files().sources()) action(source.file);
  }
  CountBytes(state);
}

void RunImport(benchmark::State& state) {
  const Folder folder;
  int number = 0;
  for (auto _ : state) {
    const fs::path library = folder.path() / std::to_string(number++);
    benchmark::DoNotOptimize(ImportInto(library));
    state.PauseTiming();
    fs::remove_all(library);
    state.ResumeTiming();
  }
  CountBytes(state);
}

void CheckWhatIsImported() {
  const Folder folder;
  ImportInto(folder.path() / "library");
  const TakeLibrary library(folder.path() / "library");
  if (library.takes().size() != Files().sources().size()) Stop("not all takes were imported");
  for (const StoredTake& take : library.takes()) {
    const std::vector<std::uint64_t> expected =
        ExtractFeatures(JointsOf(take.path), Features()).columns;
    const auto stored = library.Columns(take, Features().hash, 30);
    if (!std::equal(stored.begin(), stored.end(), expected.begin(), expected.end())) {
      Stop("the library has other features than " + take.path.string());
    }
  }
}

void RegisterAll() {
  const auto add = [](const char* name, auto run) {
    benchmark::RegisterBenchmark(name, run)->Unit(benchmark::kMillisecond)->UseRealTime();
  };
  const auto add_step = [&](const char* name, auto action) {
    add(name, [action](benchmark::State& state) { RunForEachFile(state, action); });
  };
  add("import", RunImport);
  add_step("numbers", [](const fs::path& file) { benchmark::DoNotOptimize(ReadAmc(file)); });
  add_step("motion", [](const fs::path& file) { benchmark::DoNotOptimize(LoadRecording(file)); });
  add_step("joints", [](const fs::path& file) { benchmark::DoNotOptimize(JointsOf(file)); });
  add_step("features", [](const fs::path& file) {
    benchmark::DoNotOptimize(ExtractFeatures(JointsOf(file), Features()));
  });
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  kinebase::CheckWhatIsImported();
  kinebase::RegisterAll();
  benchmark::RunSpecifiedBenchmarks();
}
