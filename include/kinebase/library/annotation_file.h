// Labels of stretches of recordings as files: tables that are read, and ELAN's format, written.
//
// Read library/annotation.h first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase {

struct SegmentLabel {
  std::string recording;  // Name of its file, without folder and extension.
  std::string label;
  std::int64_t first_frame = 0;     // From 1, inclusive.
  std::int64_t last_frame = 0;      // May lie behind the recording's end.
  std::int64_t line = 0;            // Of the table.
  std::filesystem::path file = {};  // As the table has it.

  friend bool operator==(const SegmentLabel&, const SegmentLabel&) = default;
};

// A table with columns file, class, first_frame, last_frame, as `kinebase annotate` writes it; or
// trial, label, first_frame_1based, last_frame_1based. Other columns are passed over.
// Errors  NotFound, IoFailure; MalformedFile with the line.
[[nodiscard]] std::vector<SegmentLabel> ReadSegmentLabels(const std::filesystem::path& path);
[[nodiscard]] std::vector<SegmentLabel> ParseSegmentLabels(std::string_view text,
                                                           const std::filesystem::path& path);

// The recording's name as it stands in SegmentLabel::recording.
[[nodiscard]] std::string RecordingName(const std::filesystem::path& file);

struct TierSegment {
  double start_s = 0;
  double end_s = 0;
  std::string text;
};

// A row of annotations in ELAN; those of one tier do not overlap.
struct AnnotationTier {
  std::string name;
  std::vector<TierSegment> segments;  // By their start.
};

struct ElanOptions {
  std::string date;                 // As in "2006-09-02T10:00:00+00:00": the format asks for one.
  std::filesystem::path recording;  // That was annotated; noted as a property.
};

// An ELAN document (EAF 3.0): times in whole milliseconds, one linguistic type whose annotations
// have times of their own. A segment that would last no millisecond lasts one.
// Errors  InvalidArgument: two tiers of one name, segments of a tier that overlap or run backwards.
[[nodiscard]] std::string FormatElan(std::span<const AnnotationTier> tiers,
                                     const ElanOptions& options);

}  // namespace kinebase
