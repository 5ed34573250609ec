// Writing C3D: what was read is given back, what a file cannot hold is refused; cutting and
// changing the storage.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "formats/c3d_generators.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using test::ErrorOf;

// Point p of frame f (from 0) is at (f, p, 1), sample s of its channel c is 100 f + 10 s + c.
C3dRecording Counting(std::size_t frames, std::size_t points = 2) {
  C3dRecording c3d{.rate_hz = 100,
                   .frame_count = frames,
                   .point_count = points,
                   .channel_count = 2,
                   .subframe_count = 3};
  for (std::size_t f = 0; f < frames; ++f) {
    for (std::size_t p = 0; p < points; ++p) {
      c3d.points.push_back({static_cast<float>(f), static_cast<float>(p), 1, 0x0102});
    }
    for (std::size_t i = 0; i < 6; ++i) {
      c3d.analog.push_back(static_cast<float>(100 * f + (i / 2) * 10 + i % 2));
    }
  }
  SetParameter(c3d, "POINT", IntegerParameter("FRAMES", 0));
  SetParameter(c3d, "POINT", IntegerParameter("DATA_START", 0));
  return c3d;
}

RC_GTEST_PROP(C3dWriter, GivesBackAnyRecording, ()) {
  const C3dRecording c3d = test::AnyC3d();
  const std::string bytes = FormatC3d(c3d);
  RC_ASSERT(ParseC3d(bytes, "any.c3d", {.strict = true}) == c3d);
  RC_ASSERT(bytes.size() % 512 == 0U);
}

RC_GTEST_PROP(C3dReader, EndsInARecordingOrOneErrorForBytesThatWereChanged, ()) {
  std::string bytes = FormatC3d(test::AnyC3d());
  for (int i = *rc::gen::inRange(1, 8); i > 0; --i) {
    bytes[*rc::gen::inRange<std::size_t>(0, bytes.size())] = *rc::gen::arbitrary<char>();
  }
  bytes.resize(*rc::gen::inRange<std::size_t>(0, bytes.size() + 1));
  try {
    const C3dRecording c3d = ParseC3d(bytes, "changed.c3d");
    RC_ASSERT(ParseC3d(FormatC3d(c3d), "again.c3d") == c3d);
  } catch (const Error& error) {
    RC_ASSERT(error.code() == ErrorCode::kMalformedFile);
    RC_ASSERT(error.place().byte >= 0);
  }
}

TEST(C3dWriter, TellsMoreFramesThan16BitsHold) {
  C3dRecording c3d = Counting(70000, 1);
  c3d = ParseC3d(FormatC3d(c3d), "many.c3d", {.strict = true});
  EXPECT_EQ(c3d.frame_count, 70000);
  EXPECT_EQ(c3d.points.back().x, 69999.F);
  EXPECT_TRUE(c3d.diagnostics.empty());
  EXPECT_EQ(FindParameter(c3d, "POINT", "FRAMES")->UnsignedNumber(), 65535);
  EXPECT_EQ(FindParameter(c3d, "POINT", "LONG_FRAMES")->Number(), 70000);
  const C3dParameter* end = FindParameter(c3d, "TRIAL", "ACTUAL_END_FIELD");
  ASSERT_NE(end, nullptr);
  EXPECT_EQ(end->UnsignedNumber(0), 70000 - 65536);
  EXPECT_EQ(end->UnsignedNumber(1), 1);
  // Back within 16 bits they go on telling the truth.
  const C3dRecording clip = CutC3d(c3d, 66000, 66009);
  EXPECT_EQ(FindParameter(clip, "POINT", "LONG_FRAMES")->Number(), 10);
  EXPECT_EQ(FindParameter(clip, "POINT", "FRAMES")->Number(), 10);
  const C3dRecording again = ParseC3d(FormatC3d(clip), "clip.c3d");
  EXPECT_EQ(again, clip);
  EXPECT_EQ(again.first_frame, 66001);
  EXPECT_EQ(again.points[0].x, 66000.F);
}

TEST(C3dWriter, HoldsMoreThan255Points) {
  C3dRecording c3d = Counting(2, 1000);
  c3d = ParseC3d(FormatC3d(c3d), "wide.c3d");
  EXPECT_EQ(c3d.point_count, 1000);
  EXPECT_EQ(c3d.point(1, 999).y, 999.F);
}

TEST(C3dWriter, HoldsMoreParametersThanItsBlockCountCanTell) {
  C3dRecording c3d = Counting(2);
  for (int i = 0; i < 400; ++i) {
    SetParameter(c3d, "LOTS", TextParameter("TEXT" + std::to_string(i), std::string(255, 'x')));
  }
  SetParameter(c3d, "LOTS",
               {.name = "BIG", .dimensions = {255, 255}, .values = std::string(65'025, 'y')});
  const C3dRecording again = ParseC3d(FormatC3d(c3d), "lots.c3d");
  EXPECT_EQ(FindParameter(again, "LOTS", "BIG")->size(), 255 * 255);
  EXPECT_EQ(again.points, c3d.points);
}

TEST(C3dWriter, RefusesWhatAFileCannotHold) {
  const auto refused = [](auto change) {
    C3dRecording c3d = Counting(2);
    change(c3d);
    const Error error = ErrorOf([&] { (void)FormatC3d(c3d); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument) << error.what();
    return std::string(error.what());
  };
  EXPECT_NE(refused([](auto& c) { c.points.pop_back(); }).find("holds 3 points"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.analog.pop_back(); }).find("11 samples"), std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.first_frame = -3; }).find("-3"), std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.first_frame = 4294967295; }).find("4294967295"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.scale = 0; }).find("positive"), std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.scale = NAN; }).find("positive"), std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.groups[0].name = std::string(128, 'g'); }).find("128 bytes"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.groups[0].id = 129; }).find("129"), std::string::npos);
  EXPECT_NE(refused([](auto& c) {
              c.groups[0].parameters[0].description = std::string(256, 'd');
            }).find("256 bytes"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) {
              c.groups[0].parameters[0].dimensions = {2};
            }).find("POINT:FRAMES has 1 values"),
            std::string::npos);
  EXPECT_NE(
      refused([](auto& c) {
        SetParameter(
            c, "X",
            {.name = "BIG", .dimensions = {255, 255, 2}, .values = std::string(130'050, 'y')});
      }).find("'BIG' takes 130058 bytes"),
      std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.header_events.resize(19); }).find("18 events"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) { c.header_events = {{.label = "12345"}}; }).find("'12345'"),
            std::string::npos);
  EXPECT_NE(refused([](auto& c) {
              c = Counting(1, 1);
              c.point_count = 65536;
              c.points.resize(65536);
            }).find("up to 65535 points"),
            std::string::npos);
}

TEST(C3dWriter, SaturatesWhatAnotherProcessorCannotHold) {
  C3dRecording c3d = Counting(1, 1);
  c3d.points[0] = {INFINITY, -3e38F, 1e-44F, 0};
  c3d.processor = C3dProcessor::kDec;
  const C3dPoint read = ParseC3d(FormatC3d(c3d), "dec.c3d").points[0];
  EXPECT_NEAR(static_cast<double>(read.x), 1.70141173e38, 1e31);
  EXPECT_EQ(read.y, -read.x);
  EXPECT_EQ(read.z, 0.F);
}

// --- Cutting.

TEST(CutC3d, KeepsFrameNumbersSamplesAndParameters) {
  C3dRecording take = Counting(50);
  take.first_frame = 200;
  SetParameter(take, "TRIAL",
               {.name = "ACTUAL_START_FIELD",
                .dimensions = {2},
                .values = std::vector<std::int16_t>{200, 0}});
  SetParameter(
      take, "TRIAL",
      {.name = "ACTUAL_END_FIELD", .dimensions = {2}, .values = std::vector<std::int16_t>{249, 0}});
  SetParameter(take, "SUBJECTS", TextParameter("NAMES", "made up"));
  take.trailing = "what is behind";
  const C3dRecording clip = CutC3d(take, 10, 19);
  EXPECT_EQ(clip.frame_count, 10);
  EXPECT_EQ(clip.first_frame, 210);
  EXPECT_EQ(clip.last_frame(), 219);
  EXPECT_EQ(clip.point(0, 1), (C3dPoint{10, 1, 1, 0x0102}));
  EXPECT_EQ(clip.points.size(), 20);
  EXPECT_EQ(clip.analog.size(), 60);
  EXPECT_EQ(clip.analog.front(), 1000.F);
  EXPECT_EQ(clip.analog.back(), 1921.F);
  EXPECT_EQ(FindParameter(clip, "TRIAL", "ACTUAL_START_FIELD")->Number(), 210);
  EXPECT_EQ(FindParameter(clip, "TRIAL", "ACTUAL_END_FIELD")->Number(), 219);
  EXPECT_EQ(FindParameter(clip, "POINT", "FRAMES")->Number(), 10);
  EXPECT_EQ(*FindParameter(clip, "SUBJECTS", "NAMES"), *FindParameter(take, "SUBJECTS", "NAMES"));
  EXPECT_TRUE(clip.trailing.empty());
  EXPECT_EQ(clip.diagnostics.size(), 1);
  EXPECT_EQ(ParseC3d(FormatC3d(clip), "clip.c3d"), clip);
}

TEST(CutC3d, KeepsTheTimesOfEventsAndDropsThoseOutside) {
  C3dRecording take = Counting(100);
  take.first_frame = 201;  // 2 s behind frame 1.
  std::vector<C3dEvent> events;
  for (int i = 0; i < 100; ++i) {
    events.push_back({.time_s = 2 + i * .01, .label = "F" + std::to_string(i), .icon_id = i});
  }
  events.push_back({.time_s = 2.105, .label = "in", .is_in_header = true});
  events.push_back({.time_s = 2.5, .label = "out", .is_in_header = true});
  SetEvents(take, events);
  // A parameter of another maker with a value an event, and one without.
  SetParameter(take, "EVENT",
               {.name = "EXTRA", .dimensions = {100}, .values = std::vector<std::int16_t>(100, 5)});
  SetParameter(take, "EVENT", TextParameter("NOTE", "about all"));
  const C3dRecording clip = ParseC3d(FormatC3d(CutC3d(take, 10, 19)), "clip.c3d");
  const std::vector<C3dEvent> kept = Events(clip);
  ASSERT_EQ(kept.size(), 11);
  for (int i = 0; i < 10; ++i) {
    EXPECT_NEAR(kept[i].time_s, 2.1 + i * .01, 1e-6);
    EXPECT_EQ(kept[i].label, "F" + std::to_string(i + 10));
    EXPECT_EQ(kept[i].icon_id, i + 10);
  }
  EXPECT_EQ(kept[10].label, "in");
  EXPECT_NEAR(kept[10].time_s, 2.105, 1e-6);
  EXPECT_NEAR(static_cast<double>(clip.header_events[0].time_s), .005, 1e-6);
  EXPECT_EQ(FindParameter(clip, "EVENT", "EXTRA")->size(), 10);
  EXPECT_EQ(FindParameter(clip, "EVENT", "NOTE")->size(), 9);
}

TEST(CutC3d, DropsEventsFromListsOfMoreThan255) {
  C3dRecording take = Counting(1000);
  std::vector<C3dEvent> events;
  for (int i = 0; i < 1000; i += 2) {
    events.push_back({.time_s = i * .01, .label = "F" + std::to_string(i)});
  }
  SetEvents(take, events);
  const std::vector<C3dEvent> kept = Events(CutC3d(take, 500, 530));
  ASSERT_EQ(kept.size(), 16);
  EXPECT_EQ(kept.front().label, "F500");
  EXPECT_EQ(kept.back().label, "F530");
}

RC_GTEST_PROP(CutC3d, GivesEveryFrameAndEventToOnePart, ()) {
  C3dRecording take = Counting(*rc::gen::inRange<std::size_t>(2, 40));
  take.first_frame = *rc::gen::inRange(0, 3000);
  const double start_s = static_cast<double>(take.first_frame - 1) / 100;
  std::vector<C3dEvent> events;
  for (int i = *rc::gen::inRange(0, 18); i > 0; --i) {
    const double share = *rc::gen::inRange(0, 1000) / 1000.;
    const double length_s = static_cast<double>(take.frame_count - 1) / 100;
    events.push_back({.time_s = start_s + share * length_s, .label = "E"});
    events.back().is_in_header = *rc::gen::arbitrary<bool>();
  }
  SetEvents(take, events);
  const auto last = static_cast<std::int64_t>(take.frame_count) - 1;
  const std::int64_t middle = *rc::gen::inRange<std::int64_t>(0, last);
  const C3dRecording left = CutC3d(take, 0, middle);
  const C3dRecording right = CutC3d(take, middle + 1, last);
  std::vector<C3dPoint> points = left.points;
  points.insert(points.end(), right.points.begin(), right.points.end());
  RC_ASSERT(points == take.points);
  RC_ASSERT(right.first_frame == left.last_frame() + 1);
  RC_ASSERT(Events(left).size() + Events(right).size() == events.size());
  const C3dRecording read = ParseC3d(FormatC3d(take), "take.c3d");
  RC_ASSERT(CutC3d(read, 0, last) == read);
}

TEST(CutC3d, RefusesFramesThatAreNotThere) {
  const C3dRecording take = Counting(5);
  for (const auto& [first, last] : {std::pair(-1, 2), std::pair(3, 2), std::pair(0, 5)}) {
    EXPECT_EQ(ErrorOf([&, f = first, l = last] { (void)CutC3d(take, f, l); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

// --- Storage.

TEST(ChangeStorage, ToIntegersStaysWithinHalfAStep) {
  C3dRecording c3d = Counting(3);
  c3d.points[0] = {1234.567F, -2000, .01F, 0x0301};
  c3d.points[1] = {NAN, 5, 5, -1};
  for (float& sample : c3d.analog) sample = sample * .37F - 12;
  SetParameter(c3d, "ANALOG", RealParameter("GEN_SCALE", 2));
  const std::vector<double> before = ScaledAnalog(c3d);
  const C3dRecording original = c3d;
  ChangeStorage(c3d, C3dStorage::kInteger);
  c3d = ParseC3d(FormatC3d(c3d), "integers.c3d", {.strict = true});
  EXPECT_EQ(c3d.storage, C3dStorage::kInteger);
  EXPECT_NEAR(static_cast<double>(c3d.scale), 2000. / 32000, 1e-9);
  EXPECT_NEAR(c3d.points[0].x, 1234.567F, c3d.scale * .51);
  EXPECT_NEAR(c3d.points[0].y, -2000, c3d.scale * .51);
  EXPECT_EQ(c3d.points[0].camera_mask(), 3);
  EXPECT_EQ(c3d.points[0].residual_steps(), 2) << ".1 in steps of .0625";
  EXPECT_FALSE(c3d.points[1].is_valid());
  const std::vector<double> after = ScaledAnalog(c3d);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], .005);

  C3dRecording back = c3d;
  ChangeStorage(back, C3dStorage::kFloat);
  back = ParseC3d(FormatC3d(back), "floats.c3d");
  EXPECT_EQ(back.storage, C3dStorage::kFloat);
  EXPECT_EQ(back.points, c3d.points);
  EXPECT_EQ(ScaledAnalog(back), after);
}

TEST(ChangeStorage, LeavesSamplesThatAreWholeNumbersAlone) {
  C3dRecording c3d = Counting(3);
  const std::vector<float> analog = c3d.analog;
  ChangeStorage(c3d, C3dStorage::kInteger);
  EXPECT_EQ(c3d.analog, analog);
  EXPECT_EQ(FindParameter(c3d, "ANALOG", "SCALE"), nullptr);
}

}  // namespace
}  // namespace kinebase
