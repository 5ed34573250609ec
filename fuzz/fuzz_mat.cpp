// Any bytes as a MAT-file: variables or one kinebase::Error. What was read is written and read
// again; the structures skel and mot are made a recording.

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/core/output_file.h"
#include "kinebase/formats/mat.h"
#include "kinebase/motion/motion_file.h"

namespace {

constexpr std::size_t kUnpackedLimit = std::size_t{1} << 26;  // The fuzzer's memory is small.

void TryRecording(std::string_view bytes) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("fuzz_mat_" + std::to_string(getpid()) + ".mat");
  kinebase::WriteFile(path, bytes, kinebase::Overwrite::kYes);
  try {
    const kinebase::Recording recording = kinebase::LoadRecording(path);
    if (recording.frame_count() == 0) std::abort();
  } catch (const kinebase::Error&) {
  }
}

// Another exception than kinebase::Error leaves through here and is a finding.
void TryMat(std::string_view bytes) {
  kinebase::MatFile mat;
  try {
    mat = kinebase::ParseMat(bytes, "fuzz.mat", {.unpacked_limit = kUnpackedLimit});
  } catch (const kinebase::Error&) {
    return;
  }
  if (kinebase::ParseMat(kinebase::FormatMat(mat), "written.mat") != mat) std::abort();
  if (mat.Find("skel") != nullptr && mat.Find("mot") != nullptr) TryRecording(bytes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryMat({reinterpret_cast<const char*>(data), size});
  return 0;
}
