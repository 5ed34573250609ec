// One call from a file of any format to a motion, and the table of formats behind it.
//
// A new format is a row of `MotionFormats()`; nothing else changes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "kinebase/core/diagnostic.h"
#include "kinebase/core/output_file.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/motion.h"

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
};

struct LoadedMotion {
  std::filesystem::path path;
  std::string_view format;              // Its row's name.
  std::filesystem::path skeleton_path;  // Where the skeleton came from; empty if inside the file.
  TakeName name;
  std::string units;          // Of lengths in the file: "inch / 0.45", "mm".
  std::string up_axis = "Y";  // Of the file; a Motion always has Y up.
  Motion motion;
  Diagnostics diagnostics;
};

// One format: how it is recognised, read and written.
struct MotionFormat {
  std::string_view name;         // "ASF/AMC".
  std::string_view extension;    // ".amc", lower case.
  std::string_view description;  // One line for a list of formats.
  LoadedMotion (*load)(const std::filesystem::path& path, const LoadOptions& options);
  // Writes the motion and whatever goes with it (an AMC's skeleton). May be null: read only.
  void (*save)(const Motion& motion, const std::filesystem::path& path, Overwrite overwrite,
               Diagnostics& diagnostics);
};

[[nodiscard]] std::span<const MotionFormat> MotionFormats();

// The row for a file by its extension in any case; null if there is none.
[[nodiscard]] const MotionFormat* FindMotionFormat(const std::filesystem::path& path);

// Errors  NotFound, MalformedFile, Mismatch, IoFailure: each names file, line and remedy. A motion
//         without frames is MalformedFile.
[[nodiscard]] LoadedMotion LoadMotion(const std::filesystem::path& path,
                                      const LoadOptions& options = {});

// Errors  InvalidArgument if no format with that extension can be written; AlreadyExists;
// IoFailure.
void SaveMotion(const Motion& motion, const std::filesystem::path& path, Overwrite overwrite,
                Diagnostics& diagnostics);

}  // namespace kinebase
