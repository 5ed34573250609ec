#include "kinebase/library/annotation_accuracy.h"

#include <algorithm>
#include <functional>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {
namespace {

constexpr double kLeastOverlap = 0.5;  // Intersection over union.

double Quotient(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

// Which classes are there in each frame.
class FrameLabels {
 public:
  FrameLabels(std::span<const ClassSegment> segments, std::int64_t length, int class_count)
      : class_count_(static_cast<std::size_t>(class_count)),
        there_(static_cast<std::size_t>(length) * class_count_) {
    for (const ClassSegment& segment : segments) {
      const std::int64_t end = std::min(segment.last + 1, length);
      for (std::int64_t frame = std::max<std::int64_t>(segment.first, 0); frame < end; ++frame) {
        there_[static_cast<std::size_t>(frame) * class_count_ +
               static_cast<std::size_t>(segment.motion_class)] = 1;
      }
    }
  }

  [[nodiscard]] bool at(std::int64_t frame, std::size_t motion_class) const {
    return there_[static_cast<std::size_t>(frame) * class_count_ + motion_class] != 0;
  }

 private:
  std::size_t class_count_;
  std::vector<char> there_;  // [frame × class]
};

void CountFrames(const JudgedRecording& recording, int class_count, AnnotationAccuracy& accuracy) {
  const FrameLabels truth(recording.truth, recording.length, class_count);
  const FrameLabels found(recording.found, recording.length, class_count);
  const auto none = static_cast<std::size_t>(class_count);
  std::vector<std::size_t> missed;
  std::vector<std::size_t> wrong;
  for (std::int64_t frame = 0; frame < recording.length; ++frame) {
    missed.clear();
    wrong.clear();
    bool agrees = false;
    for (std::size_t i = 0; i < none; ++i) {
      const bool is_there = truth.at(frame, i);
      const bool is_found = found.at(frame, i);
      accuracy.frames[i].present += is_there ? 1 : 0;
      accuracy.frames[i].found += is_found ? 1 : 0;
      if (is_there && is_found) {
        ++accuracy.frames[i].right;
        ++accuracy.confusion[i][i];
        agrees = true;
      } else if (is_there) {
        missed.push_back(i);
      } else if (is_found) {
        wrong.push_back(i);
      }
    }
    if (missed.empty() && wrong.empty() && !agrees) ++accuracy.confusion[none][none];
    if (missed.empty() && !wrong.empty()) missed.push_back(none);
    if (wrong.empty()) wrong.push_back(none);
    for (const std::size_t there : missed) {
      for (const std::size_t instead : wrong) ++accuracy.confusion[there][instead];
    }
  }
}

double IntersectionOverUnion(const ClassSegment& a, const ClassSegment& b) {
  const std::int64_t common = std::min(a.last, b.last) - std::max(a.first, b.first) + 1;
  if (common <= 0) return 0;
  return Quotient(common, std::max(a.last, b.last) - std::min(a.first, b.first) + 1);
}

// Cut to the recording; without those outside it.
std::vector<ClassSegment> Within(std::vector<ClassSegment> segments, std::int64_t length) {
  for (ClassSegment& segment : segments) {
    segment.first = std::max<std::int64_t>(segment.first, 0);
    segment.last = std::min(segment.last, length - 1);
  }
  std::erase_if(segments, [](const ClassSegment& segment) { return segment.last < segment.first; });
  return segments;
}

void CountSegments(const JudgedRecording& recording, AnnotationAccuracy& accuracy) {
  const std::vector<ClassSegment> truth = Within(recording.truth, recording.length);
  const std::vector<ClassSegment> found = Within(recording.found, recording.length);
  struct Pair {
    double overlap = 0;
    std::size_t truth = 0;
    std::size_t found = 0;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t j = 0; j < found.size(); ++j) {
      if (truth[i].motion_class != found[j].motion_class) continue;
      const double overlap = IntersectionOverUnion(truth[i], found[j]);
      if (overlap >= kLeastOverlap) pairs.push_back({overlap, i, j});
    }
  }
  std::ranges::stable_sort(pairs, std::greater(), &Pair::overlap);
  std::vector<char> truth_is_claimed(truth.size());
  std::vector<char> found_is_right(found.size());
  for (const Pair& pair : pairs) {
    if (truth_is_claimed[pair.truth] != 0 || found_is_right[pair.found] != 0) continue;
    truth_is_claimed[pair.truth] = found_is_right[pair.found] = 1;
    ++accuracy.segments[static_cast<std::size_t>(truth[pair.truth].motion_class)].right;
  }
  for (const ClassSegment& segment : truth) {
    ++accuracy.segments[static_cast<std::size_t>(segment.motion_class)].present;
  }
  for (const ClassSegment& segment : found) {
    ++accuracy.segments[static_cast<std::size_t>(segment.motion_class)].found;
  }
}

void CheckClasses(std::span<const ClassSegment> segments, int class_count) {
  for (const ClassSegment& segment : segments) {
    if (segment.motion_class >= 0 && segment.motion_class < class_count) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a segment of class {}; there are {} classes, counted from 0",
                            segment.motion_class, class_count));
  }
}

}  // namespace

double AccuracyCounts::precision() const { return Quotient(right, found); }
double AccuracyCounts::recall() const { return Quotient(right, present); }
double AccuracyCounts::f1() const { return Quotient(2 * right, found + present); }

AccuracyCounts AnnotationAccuracy::Micro(std::span<const AccuracyCounts> classes) {
  AccuracyCounts sum;
  for (const AccuracyCounts& counts : classes) {
    sum.right += counts.right;
    sum.found += counts.found;
    sum.present += counts.present;
  }
  return sum;
}

MacroAccuracy AnnotationAccuracy::Macro(std::span<const AccuracyCounts> classes) {
  MacroAccuracy mean;
  double count = 0;
  for (const AccuracyCounts& counts : classes) {
    if (counts.found + counts.present == 0) continue;
    ++count;
    mean.precision += counts.precision();
    mean.recall += counts.recall();
    mean.f1 += counts.f1();
  }
  if (count == 0) return mean;
  return {mean.precision / count, mean.recall / count, mean.f1 / count};
}

AnnotationAccuracy MeasureAnnotation(std::span<const JudgedRecording> recordings, int class_count) {
  const auto classes = static_cast<std::size_t>(class_count);
  AnnotationAccuracy accuracy;
  accuracy.frames.resize(classes);
  accuracy.segments.resize(classes);
  accuracy.confusion.assign(classes + 1, std::vector<std::int64_t>(classes + 1));
  for (const JudgedRecording& recording : recordings) {
    CheckClasses(recording.truth, class_count);
    CheckClasses(recording.found, class_count);
    CountFrames(recording, class_count, accuracy);
    CountSegments(recording, accuracy);
  }
  return accuracy;
}

}  // namespace kinebase
