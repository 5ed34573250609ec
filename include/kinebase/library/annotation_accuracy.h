// How far an annotation agrees with the truth: over frames, over segments, class by class.
//
// Read library/annotation.h first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace kinebase {

struct ClassSegment {
  int motion_class = 0;
  std::int64_t first = 0;  // Frames or columns, from 0, inclusive.
  std::int64_t last = 0;

  friend bool operator==(const ClassSegment&, const ClassSegment&) = default;
};

// One recording: what is true and what was found.
struct JudgedRecording {
  std::int64_t length = 0;  // Segments are cut to it.
  std::vector<ClassSegment> truth;
  std::vector<ClassSegment> found;
};

// Counts and what follows from them. Where nothing was found precision is 0, where nothing is there
// recall is 0: nothing is right in either.
struct AccuracyCounts {
  std::int64_t right = 0;
  std::int64_t found = 0;
  std::int64_t present = 0;  // In truth.

  [[nodiscard]] double precision() const;
  [[nodiscard]] double recall() const;
  [[nodiscard]] double f1() const;  // 2 · right / (found + present).

  friend bool operator==(const AccuracyCounts&, const AccuracyCounts&) = default;
};

// Means over the classes that are found or present at all.
struct MacroAccuracy {
  double precision = 0;
  double recall = 0;
  double f1 = 0;
};

struct AnnotationAccuracy {
  std::vector<AccuracyCounts> frames;    // [class]
  std::vector<AccuracyCounts> segments;  // [class]

  // [truth][found] frames, the last row and column for "none". Of a frame with several classes
  // those that agree count on the diagonal, and the others each with each that is left.
  std::vector<std::vector<std::int64_t>> confusion;

  [[nodiscard]] static AccuracyCounts Micro(std::span<const AccuracyCounts> classes);  // Their sum.
  [[nodiscard]] static MacroAccuracy Macro(std::span<const AccuracyCounts> classes);
};

// A segment that was found is right if it overlaps one of its class in the truth by at least half
// of their union and no better one has claimed that.
//
// Errors  InvalidArgument: a class that is not in 0 … class_count − 1.
// Cost    O(frames · classes + segments²) for each recording.
[[nodiscard]] AnnotationAccuracy MeasureAnnotation(std::span<const JudgedRecording> recordings,
                                                   int class_count);

}  // namespace kinebase
