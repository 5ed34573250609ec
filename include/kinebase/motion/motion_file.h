// One call from a file of any format to a recording, and the table of formats behind it.
//
// A new format is a row of `MotionFormats()`; nothing else changes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/core/output_file.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"
#include "kinebase/formats/bvh.h"
#include "kinebase/formats/c3d.h"
#include "kinebase/formats/csm.h"
#include "kinebase/formats/trc.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/joint_source.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/marker_set.h"
#include "kinebase/motion/motion.h"
#include "kinebase/motion/world.h"

namespace kinebase {

// What a file's name says, by the conventions of HDM05 and CMU. Unknown parts are empty or 0.
struct TakeName {
  std::string actor;       // "bd"; CMU: the subject, "05".
  std::string class_name;  // "squat1Reps"; empty for full takes.
  std::string take;        // HDM05: "03-02_01" or a clip's number "013"; CMU: "01".
  double rate_hz = 0;      // HDM05: the last part; CMU: 120, as its web site says.
};

// HDM_{actor}_{part}-{scene}_{take}_{rate}, HDM_{actor}_{class}_{nnn}_{rate}, {subject}_{trial}.
[[nodiscard]] TakeName ParseTakeName(const std::filesystem::path& file);

// The skeleton of a motion file: `HDM_tr.asf` for `HDM_tr_…`, `05.asf` for `05_01…`, or the
// motion's own stem; next to it, then up to three folders further up, and in folders `asf` or
// `skeletons` beside those. Errors  NotFound, naming what was looked for and `--skeleton`.
[[nodiscard]] std::filesystem::path FindSkeleton(const std::filesystem::path& motion_file);

struct LoadOptions {
  std::filesystem::path skeleton;  // Empty: FindSkeleton.
  double source_rate_hz = 0;  // For files that do not tell; 0: by name, else 120 with a warning.
  bool strict = false;        // Refuse what is otherwise repaired.
  LengthReading length_reading = LengthReading::kAuto;
  std::filesystem::path marker_names;  // An MNM file: which of the file's names is which marker.
  std::filesystem::path marker_set;    // Tells where joints are; empty: the built-in ones.
  std::optional<UpAxis> up_axis;       // For files that do not tell, or tell wrong.
  std::string units;                   // The same for the unit of length, as CentimetresIn.

  bool operator==(const LoadOptions&) const = default;
};

// What a file holds as it stands there, so that writing the same format loses nothing.
struct AcclaimRecord {
  AsfSkeleton asf;
  AmcMotion amc;
};
using FileRecord = std::variant<AcclaimRecord, BvhMotion, C3dRecording, CsmRecording, TrcRecording>;

// One file, read and understood: either a skeleton that moves or markers.
struct Recording {
  std::filesystem::path path;
  std::string_view format;              // Its row's name.
  std::filesystem::path skeleton_path;  // Where the skeleton came from; empty if inside the file.
  TakeName name;
  std::string units;                            // Of lengths in the file: "inch / 0.45", "mm".
  std::string up_axis = "Y";                    // Of the file; what is read always has Y up.
  Motion motion;                                // Without skeleton if the file holds markers.
  MarkerCloud markers;                          // Empty if the file holds a skeleton.
  std::shared_ptr<const MarkerSet> marker_set;  // As asked for; null: the built-in ones.

  // How the standard joints were found, where the file does not name them as ASF does; may be
  // empty.
  std::vector<JointSource> joint_sources;

  // Null where the reader keeps none. Frames of `motion` or `markers` are those of the record.
  std::shared_ptr<const FileRecord> record;
  Diagnostics diagnostics;

  [[nodiscard]] bool has_skeleton() const { return motion.skeleton != nullptr; }
  [[nodiscard]] int frame_count() const {
    return has_skeleton() ? motion.frame_count : markers.frame_count;
  }
  [[nodiscard]] double rate_hz() const { return has_skeleton() ? motion.rate_hz : markers.rate_hz; }
  [[nodiscard]] std::int64_t first_frame() const {
    return has_skeleton() ? motion.first_frame : markers.first_frame;
  }
  [[nodiscard]] double duration_s() const { return rate_hz() > 0 ? frame_count() / rate_hz() : 0; }
};

struct SaveOptions {
  Overwrite overwrite = Overwrite::kNo;
  std::optional<UpAxis> up_axis;       // Default: as the record, else what the format expects.
  std::string units;                   // The same; as CentimetresIn.
  std::filesystem::path marker_names;  // An MNM file: names to write markers under.
  std::optional<C3dStorage>
      storage;  // Of the samples of a C3D. Default: as the record, else float.
};

// One format: how it is recognised, read and written.
struct MotionFormat {
  std::string_view name;         // "ASF/AMC".
  std::string_view extension;    // ".amc", lower case.
  std::string_view description;  // One line for a list of formats.
  // May be null: written only.
  Recording (*load)(const std::filesystem::path& path, const LoadOptions& options);
  // Writes the recording and whatever goes with it (an AMC's skeleton). May be null: read only.
  // Errors       Mismatch if the format cannot carry it: a skeleton where it takes markers.
  // diagnostics  What the recording holds and the format cannot carry.
  void (*save)(const Recording& recording, const std::filesystem::path& path,
               const SaveOptions& options, Diagnostics& diagnostics);
};

[[nodiscard]] std::span<const MotionFormat> MotionFormats();

// The row for a file by its extension in any case; null if there is none.
[[nodiscard]] const MotionFormat* FindMotionFormat(const std::filesystem::path& path);

// Errors  NotFound, MalformedFile, Mismatch, IoFailure: each names file, line and remedy. A
//         recording without frames is MalformedFile.
[[nodiscard]] Recording LoadRecording(const std::filesystem::path& path,
                                      const LoadOptions& options = {});

// Errors  InvalidArgument if no format with that extension can be written; Mismatch if it cannot
//         carry what the recording holds; AlreadyExists; IoFailure.
void SaveRecording(const Recording& recording, const std::filesystem::path& path,
                   const SaveOptions& options, Diagnostics& diagnostics);

// The 24 standard joints of either kind of recording.
// Errors       Mismatch, naming the bones or markers that are missing.
// diagnostics  As ApproximateJoints.
[[nodiscard]] JointTrajectories StandardJoints(const Recording& recording,
                                               Diagnostics& diagnostics);

// What stands for each of them, in order; joints of the file by their bones' names.
// Errors       As StandardJoints.
// diagnostics  As StandardJoints; markers that do not keep their distances (FindLooseMarkers).
[[nodiscard]] std::vector<JointSource> FindStandardJoints(const Recording& recording,
                                                          Diagnostics& diagnostics);

// Frames first … last (0-based, inclusive) of what was read. The record is cut too, so that analog
// samples, events, sizes, comments and what the reader does not know go along.
// Errors  InvalidArgument if the range is empty or leaves the recording.
[[nodiscard]] Recording CutRecording(const Recording& recording, int first, int last);

// Another rate. The record does not go along; what is lost with it is a diagnostic of the result.
// Errors  InvalidArgument as ResampleMotion.
[[nodiscard]] Recording ResampleRecording(const Recording& recording, double rate_hz);

}  // namespace kinebase
