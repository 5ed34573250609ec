// What `annotate` found, as tables, documents and pictures.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.h"
#include "kinebase/library/annotation.h"
#include "kinebase/library/annotation_accuracy.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/takes.h"

namespace kinebase::cli {

// What no class fits, in every output and in label files.
inline constexpr std::string_view kUnknownClass = "unknown";

struct AnnotatedTake {
  std::filesystem::path path;
  double rate_hz = 0;
  std::int64_t frame_count = 0;
  std::vector<AnnotationCandidate> segments;  // Frames of the file, from 1.
  std::vector<SegmentLabel> truth;            // Empty without, or where it does not know the take.
};

// The threshold that a template was used with.
struct UsedThreshold {
  std::string template_name;
  std::string class_name;
  double tau = 0;
};

struct Annotation {
  std::vector<std::string> classes;
  std::vector<UsedThreshold> thresholds;
  std::vector<AnnotatedTake> takes;
  std::vector<TakeFailure> failures;
  bool one_track = true;      // At most one class at a time.
  bool shows_unknown = true;  // Stretches that no class fits are listed too.
  std::optional<AnnotationAccuracy> accuracy;
};

[[nodiscard]] Json ToJson(const Annotation& annotation);
[[nodiscard]] std::string ToCsv(const Annotation& annotation);
// One take; a tier for all classes if only one can be at a time, else a tier a class.
[[nodiscard]] std::string ToElan(const Annotation& annotation, const AnnotatedTake& take);

[[nodiscard]] std::string SegmentTable(const Annotation& annotation);
// Errors  None; the annotation must have an accuracy.
[[nodiscard]] std::string AccuracyTables(const Annotation& annotation);

// Errors  Those of DrawTimelines.
void DrawAnnotation(const Annotation& annotation, const std::filesystem::path& path,
                    Overwrite overwrite);

}  // namespace kinebase::cli
