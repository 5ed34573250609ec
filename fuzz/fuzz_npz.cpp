// Any bytes as an NPZ or NPY: arrays or one kinebase::Error. What was read is written and read
// again. Several NPYs in a row become the arrays of a recording, so that what reads those is
// reached too, which the checksums of an archive would prevent.

#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/core/output_file.h"
#include "kinebase/formats/npz.h"
#include "kinebase/motion/motion_file.h"

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kUnpackedLimit = std::size_t{1} << 26;  // The fuzzer's memory is small.

// What the arrays of an input are called, in their order.
constexpr std::array<std::string_view, 36> kNames = {"format",
                                                     "version",
                                                     "units",
                                                     "up_axis",
                                                     "rate_hz",
                                                     "first_frame",
                                                     "bone_names",
                                                     "joint_names",
                                                     "parents",
                                                     "offsets",
                                                     "directions",
                                                     "lengths",
                                                     "axis",
                                                     "euler_order",
                                                     "dofs",
                                                     "limits",
                                                     "limit_counts",
                                                     "skeleton_position",
                                                     "skeleton_orientation",
                                                     "standard_rotation",
                                                     "standard_trajectory",
                                                     "skeleton_file",
                                                     "skeleton_type",
                                                     "skeleton_name",
                                                     "skeleton_version",
                                                     "skeleton_mass_unit",
                                                     "skeleton_length_unit",
                                                     "skeleton_angle_is_degrees",
                                                     "skeleton_documentation",
                                                     "root_position",
                                                     "rotations",
                                                     "extra_offsets",
                                                     "positions",
                                                     "labels",
                                                     "states",
                                                     "standard_joints"};

// Another exception than kinebase::Error leaves through here and is a finding.
void TryArchive(std::string_view bytes) {
  kinebase::NpzArchive archive;
  try {
    archive = kinebase::ParseNpz(bytes, "fuzz.npz", {.unpacked_limit = kUnpackedLimit});
  } catch (const kinebase::Error&) {
    return;
  }
  if (kinebase::ParseNpz(kinebase::FormatNpz(archive), "written.npz") != archive) std::abort();
}

void TryRecording(const kinebase::NpzArchive& archive) {
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("fuzz_npz_" + std::to_string(getpid()) + ".npz");
  kinebase::WriteFile(path, kinebase::FormatNpz(archive), kinebase::Overwrite::kYes);
  try {
    const kinebase::Recording recording = kinebase::LoadRecording(path);
    if (recording.frame_count() == 0) std::abort();
  } catch (const kinebase::Error&) {
  }
}

void TryArrays(std::string_view bytes) {
  kinebase::NpzArchive archive;
  for (const std::string_view name : kNames) {
    const std::size_t next = bytes.find(kMagic, 1);
    try {
      archive.arrays.push_back(
          kinebase::ParseNpy(bytes.substr(0, next), std::string(name), "fuzz.npy"));
      const kinebase::NpzArray& array = archive.arrays.back();
      if (kinebase::ParseNpy(kinebase::FormatNpy(array), array.name, "written.npy") != array) {
        std::abort();
      }
    } catch (const kinebase::Error&) {
    }
    if (next == std::string_view::npos) break;
    bytes.remove_prefix(next);
  }
  if (archive.arrays.size() > 1) TryRecording(archive);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  if (bytes.starts_with("PK")) {
    TryArchive(bytes);
  } else {
    TryArrays(bytes);
  }
  return 0;
}
