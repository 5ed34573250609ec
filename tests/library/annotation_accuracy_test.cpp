#include "kinebase/library/annotation_accuracy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"

namespace kinebase {
namespace {

using ::testing::ElementsAre;

// Classes 0 and 1. Frames    0         10        20        30
// truth                      0000000000----------1111111111----------
// found                      --00000000000-------0000011111----------
JudgedRecording Recording() {
  return {.length = 40,
          .truth = {{0, 0, 9}, {1, 20, 29}},
          .found = {{0, 2, 12}, {0, 20, 24}, {1, 25, 29}}};
}

TEST(MeasureAnnotation, CountsFrames) {
  const std::vector<JudgedRecording> recordings = {Recording()};
  const AnnotationAccuracy accuracy = MeasureAnnotation(recordings, 2);
  EXPECT_THAT(accuracy.frames, ElementsAre(AccuracyCounts{8, 16, 10}, AccuracyCounts{5, 5, 10}));
  const AccuracyCounts micro = AnnotationAccuracy::Micro(accuracy.frames);
  EXPECT_DOUBLE_EQ(micro.precision(), 13 / 21.0);
  EXPECT_DOUBLE_EQ(micro.recall(), 13 / 20.0);
  EXPECT_DOUBLE_EQ(micro.f1(), 2 * (13 / 21.0) * (13 / 20.0) / (13 / 21.0 + 13 / 20.0));
  const MacroAccuracy macro = AnnotationAccuracy::Macro(accuracy.frames);
  EXPECT_DOUBLE_EQ(macro.precision, (8 / 16.0 + 1) / 2);
  EXPECT_DOUBLE_EQ(macro.recall, (0.8 + 0.5) / 2);
  EXPECT_THAT(accuracy.confusion,
              ElementsAre(ElementsAre(8, 0, 2), ElementsAre(5, 5, 0), ElementsAre(3, 0, 17)));
}

TEST(MeasureAnnotation, CountsSegmentsByIntersectionOverUnion) {
  const std::vector<JudgedRecording> recordings = {Recording()};
  const AnnotationAccuracy accuracy = MeasureAnnotation(recordings, 2);
  // 8 of 13 frames are common; 5 of 10, which is just enough.
  EXPECT_THAT(accuracy.segments, ElementsAre(AccuracyCounts{1, 2, 1}, AccuracyCounts{1, 1, 1}));
}

TEST(MeasureAnnotation, LetsASegmentBeClaimedOnce) {
  const std::vector<JudgedRecording> recordings = {
      {.length = 20, .truth = {{0, 0, 19}}, .found = {{0, 0, 9}, {0, 10, 19}}}};
  EXPECT_THAT(MeasureAnnotation(recordings, 1).segments, ElementsAre(AccuracyCounts{1, 2, 1}));
  EXPECT_THAT(MeasureAnnotation(recordings, 1).frames, ElementsAre(AccuracyCounts{20, 20, 20}));
}

TEST(MeasureAnnotation, CutsSegmentsToTheRecordingAndAddsUpRecordings) {
  const JudgedRecording cut{.length = 10, .truth = {{0, 5, 14}}, .found = {{0, 5, 9}, {0, 30, 40}}};
  const std::vector<JudgedRecording> recordings = {cut, cut};
  const AnnotationAccuracy accuracy = MeasureAnnotation(recordings, 1);
  EXPECT_THAT(accuracy.frames, ElementsAre(AccuracyCounts{10, 10, 10}));
  EXPECT_THAT(accuracy.segments, ElementsAre(AccuracyCounts{2, 2, 2}));
}

TEST(MeasureAnnotation, KnowsSeveralClassesAtATime) {
  const std::vector<JudgedRecording> recordings = {
      {.length = 4, .truth = {{0, 0, 3}, {1, 0, 3}}, .found = {{0, 0, 3}, {2, 0, 1}}}};
  const AnnotationAccuracy accuracy = MeasureAnnotation(recordings, 3);
  EXPECT_THAT(accuracy.frames, ElementsAre(AccuracyCounts{4, 4, 4}, AccuracyCounts{0, 0, 4},
                                           AccuracyCounts{0, 2, 0}));
  EXPECT_THAT(accuracy.confusion, ElementsAre(ElementsAre(4, 0, 0, 0), ElementsAre(0, 0, 2, 2),
                                              ElementsAre(0, 0, 0, 0), ElementsAre(0, 0, 0, 0)));
}

TEST(MeasureAnnotation, SaysNothingOfNothing) {
  const AnnotationAccuracy accuracy = MeasureAnnotation({}, 2);
  EXPECT_EQ(AnnotationAccuracy::Micro(accuracy.frames).f1(), 0);
  EXPECT_EQ(AnnotationAccuracy::Macro(accuracy.frames).f1, 0);
}

TEST(MeasureAnnotation, RefusesClassesThatThereAreNot) {
  const std::vector<JudgedRecording> recordings = {Recording()};
  EXPECT_THROW((void)MeasureAnnotation(recordings, 1), Error);
}

}  // namespace
}  // namespace kinebase
