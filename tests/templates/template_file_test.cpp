#include "kinebase/templates/template_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "kinebase/core/error.h"
#include "kinebase/features/pose_stream.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::filesystem::path SamplePath(int version = 1) {
  return std::filesystem::path(KINEBASE_SOURCE_DIR) / "tests/templates/samples" /
         ("version_" + std::to_string(version) + ".json");
}

MotionTemplate SampleTemplate() {
  MotionTemplate result;
  result.name = "arm up";
  result.learning = Profile::kPaper;
  result.matching = Profile::kBonn;
  result.feature_set = "my set";
  result.feature_set_hash = 0x00f1e2d3c4b5a697;
  result.clips = {{"takes/bd 01.amc", 121, 480}, {"takes/whole.bvh", 0, 0}};
  result.rounds = 4;
  result.quantisation = 0.05;
  result.tau = 0.0625;
  result.tau_origin = "best F1 on the training clips";
  result.matrix =
      MakeMatrix({{0, 1, 0.5}, {0.3333333333333333, 1, 1}, {1, 0, 2.5e-9}}, {1, 0.875, 1.1});
  return result;
}

PoseModel RandomPoses(Random& random, int columns) {
  PoseModel model;
  for (int i = 0; i < kPoseValues; ++i) model.spread.push_back(static_cast<float>(random.Unit()));
  model.spread[3] = 1e-30F;
  for (int i = 0; i < columns * kPoseValues; ++i) {
    model.mean.push_back(static_cast<float>(random.Unit() - 0.5));
    model.weight.push_back(static_cast<float>(random.Unit() / kPoseValues));
  }
  return model;
}

Contrast RandomContrast(Random& random, const TemplateMatrix& matrix) {
  Contrast contrast;
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    contrast.entry_weights.push_back(random.Below(3) == 0 ? 0 : random.Unit());
  }
  contrast.places = RandomPoses(random, matrix.column_count());
  return contrast;
}

Background RandomBackground(Random& random, int features) {
  Background background;
  for (int i = 0; i < features; ++i) background.ones.push_back(0.01 + 0.98 * random.Unit());
  for (int i = 0; i < kPoseValues; ++i) {
    background.places.mean.push_back(random.Unit() - 0.5);
    background.places.variance.push_back(random.Unit());
  }
  return background;
}

// The same with keyframes; they came with version 2.
MotionTemplate SampleWithKeyframes() {
  MotionTemplate result = SampleTemplate();
  result.keyframes = {{.column = 1, .tested = 0b110, .ones = 0b110, .misses = 1},
                      {.column = 2, .tested = 0b011, .ones = 0b001, .stiffness = 0.25}};
  return result;
}

// The same with marks; they came with version 3.
MotionTemplate SampleWithMarks() {
  MotionTemplate result = SampleTemplate();
  result.marks = {{"takes/bd 02.amc", 31, 150, Verdict::kRight},
                  {"walk.bvh", 1, 1, Verdict::kWrong}};
  return result;
}

// The same with look-alikes; they came with version 4.
MotionTemplate SampleWithLookalikes() {
  MotionTemplate result = SampleTemplate();
  Contrast contrast{.entry_weights = {0.5, 0.5, 0, 0.25, 0.25, 0.5, 1, 0, 0}};
  contrast.places.spread.assign(kPoseValues, 2);
  for (int i = 0; i < 3 * kPoseValues; ++i) {
    contrast.places.mean.push_back(static_cast<float>(i % kPoseValues));
    contrast.places.weight.push_back(i % kPoseValues == 1 ? 1.0F : 0.0F);
    contrast.places.lookalikes.push_back(static_cast<float>(i % kPoseValues) / 4);
  }
  result.contrast = std::move(contrast);
  return result;
}

Keyframe RandomKeyframe(Random& random, const MotionTemplate& motion_template, int column) {
  Keyframe keyframe{.column = column, .tested = 1};
  keyframe.tested |= random.Word() >> (64 - motion_template.matrix.feature_count);
  keyframe.ones = keyframe.tested & random.Word();
  keyframe.misses = random.Below(std::popcount(keyframe.tested));
  if (random.Below(2) == 0) keyframe.stiffness = random.Unit();
  return keyframe;
}

MotionTemplate RandomTemplate(Random& random) {
  const auto text = [&] {
    const char* const pieces[] = {"a", "\"", "\\", "\n", "ü", "/", "\x01", "走", " "};
    std::string result;
    for (int i = random.Below(8); i > 0; --i) result += pieces[random.Below(9)];
    return result;
  };
  const auto profile = [&] { return random.Below(2) == 0 ? Profile::kBonn : Profile::kPaper; };
  MotionTemplate result;
  result.name = text();
  result.learning = profile();
  result.matching = profile();
  result.feature_set = text();
  result.feature_set_hash = random.Word();
  for (int i = random.Below(4); i > 0; --i) {
    const std::int64_t first = 1 + static_cast<std::int64_t>(random.Word() >> 20U);
    result.clips.push_back({text(), first, first + random.Below(1000)});
  }
  result.origin = text();
  result.rounds = random.Below(11);
  result.quantisation = random.Unit() / 2;
  if (random.Below(2) == 0) result.tau = random.Unit() * 1e-3;
  result.tau_origin = text();
  result.matrix = RandomMatrix(random, 1 + random.Below(20), 1 + random.Below(64));
  result.matrix.rate_hz = 120 * random.Unit() + 1e-9;
  if (random.Below(2) == 0) result.contrast = RandomContrast(random, result.matrix);
  if (result.contrast && random.Below(2) == 0) {
    result.contrast->background = RandomBackground(random, result.matrix.feature_count);
  }
  if (result.contrast && random.Below(2) == 0) {
    result.contrast->places.lookalikes = RandomPoses(random, result.matrix.column_count()).mean;
  }
  for (int i = random.Below(3); i > 0; --i) {
    const std::int64_t first = 1 + random.Below(1000);
    const Verdict verdict = random.Below(2) == 0 ? Verdict::kRight : Verdict::kWrong;
    result.marks.push_back({text(), first, first + random.Below(1000), verdict});
  }
  if (random.Below(2) == 0) result.calibration = Calibration{random.Unit(), -random.Unit()};
  for (int column = 0; column < result.matrix.column_count(); ++column) {
    if (random.Below(4) == 0) result.keyframes.push_back(RandomKeyframe(random, result, column));
  }
  return result;
}

TEST(TemplateFile, OpensVersionOne) { EXPECT_EQ(ReadTemplate(SamplePath()), SampleTemplate()); }

TEST(TemplateFile, OpensVersionTwo) {
  EXPECT_EQ(ReadTemplate(SamplePath(2)), SampleWithKeyframes());
}

TEST(TemplateFile, OpensVersionThree) {
  EXPECT_EQ(ReadTemplate(SamplePath(3)), SampleWithMarks());
  EXPECT_EQ(FormatTemplate(SampleWithMarks()), ReadText(SamplePath(3)));
}

TEST(TemplateFile, OpensVersionFour) {
  EXPECT_EQ(ReadTemplate(SamplePath(4)), SampleWithLookalikes());
  EXPECT_EQ(FormatTemplate(SampleWithLookalikes()), ReadText(SamplePath(4)));
}

TEST(TemplateFile, IsWrittenInTheFirstVersionThatCanHoldIt) {
  EXPECT_EQ(json::parse(FormatTemplate(SampleTemplate()))["version"], 1);
  EXPECT_EQ(FormatTemplate(SampleWithKeyframes()), ReadText(SamplePath(2)));
}

TEST(TemplateFile, IsWrittenAsTheDocumentationShowsIt) {
  EXPECT_EQ(FormatTemplate(SampleTemplate()), ReadText(SamplePath()));
}

RC_GTEST_PROP(TemplateFile, ReadsBackWhatItWrote, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const MotionTemplate original = RandomTemplate(random);
  const std::string text = FormatTemplate(original);
  const MotionTemplate read = ParseTemplate(text, "a.json");
  RC_ASSERT(read == original);
  RC_ASSERT(FormatTemplate(read) == text);
}

TEST(TemplateFile, KeepsExtremeNumbersToTheLastBit) {
  MotionTemplate original = SampleTemplate();
  original.matrix.values = {-0.0,    std::numeric_limits<double>::denorm_min(),
                            0.1,     std::nextafter(1.0, 0.0),
                            1.0 / 3, 1,
                            0,       1,
                            1e-300};
  original.matrix.weights = {1e-12, 1e12, std::nextafter(1.0, 2.0)};
  const MotionTemplate read = ParseTemplate(FormatTemplate(original), "a.json");
  EXPECT_EQ(read, original);
  EXPECT_TRUE(std::signbit(read.matrix.values[0]));
}

TEST(TemplateFile, MayHaveAnOriginAndMayNot) {
  MotionTemplate drawn = SampleTemplate();
  drawn.origin = "query: \"lknee bent\"";
  EXPECT_EQ(ParseTemplate(FormatTemplate(drawn), "a.json"), drawn);
  json document = json::parse(FormatTemplate(drawn));
  document["origin"] = 3;
  EXPECT_THAT(ErrorOf([&] { (void)ParseTemplate(document.dump(), "bad.json"); }).what(),
              HasSubstr("origin is 3; expected a string"));
  document.erase("origin");
  EXPECT_EQ(ParseTemplate(document.dump(), "a.json"), SampleTemplate());
}

TEST(TemplateFile, WritesAFileAndNeverOverAnotherUnasked) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "templates" / "arm.json";
  MotionTemplate motion_template = SampleTemplate();
  WriteTemplate(motion_template, path, Overwrite::kNo);
  motion_template.name = "other";
  const Error error = ErrorOf([&] { WriteTemplate(motion_template, path, Overwrite::kNo); });
  EXPECT_EQ(error.code(), ErrorCode::kAlreadyExists);
  EXPECT_EQ(ReadTemplate(path), SampleTemplate());
  WriteTemplate(motion_template, path, Overwrite::kYes);
  EXPECT_EQ(ReadTemplate(path).name, "other");
}

TEST(TemplateFile, RefusesANewerVersionInPlainWords) {
  json document = json::parse(FormatTemplate(SampleTemplate()));
  document["version"] = 5;
  document["invention"] = "of tomorrow";
  const Error error = ErrorOf([&] { (void)ParseTemplate(document.dump(), "new.json"); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(), HasSubstr("new.json"));
  EXPECT_THAT(error.what(), HasSubstr("version 5"));
  EXPECT_THAT(error.what(), HasSubstr("newer Kinebase"));
}

// Programs that know no contrast would take such a template for a plain one.
TEST(TemplateFile, IsOfVersionTwoOnlyIfItNeedsToBe) {
  Random random(3);
  MotionTemplate motion_template = SampleTemplate();
  const auto version = [&] { return json::parse(FormatTemplate(motion_template))["version"]; };
  EXPECT_EQ(version(), 1);
  motion_template.calibration = Calibration{.slope = 30, .offset = -4};
  EXPECT_EQ(version(), 2);
  motion_template.calibration.reset();
  motion_template.contrast = RandomContrast(random, motion_template.matrix);
  EXPECT_EQ(version(), 2);
  motion_template.contrast->background = RandomBackground(random, 3);
  EXPECT_EQ(version(), 3);
  motion_template.contrast->places.lookalikes = motion_template.contrast->places.mean;
  EXPECT_EQ(version(), 4);
  json early = json::parse(FormatTemplate(motion_template));
  early["version"] = 3;
  EXPECT_THAT(ErrorOf([&] { (void)ParseTemplate(early.dump(), "early.json"); }).what(),
              HasSubstr("lookalikes in a file of version 3; they came with 4"));
}

TEST(TemplateFile, RefusesAContrastThatDoesNotFit) {
  Random random(4);
  MotionTemplate motion_template = SampleTemplate();
  motion_template.contrast = RandomContrast(random, motion_template.matrix);
  motion_template.calibration = Calibration{.slope = 30, .offset = -4};
  const json good = json::parse(FormatTemplate(motion_template));
  struct Change {
    std::string pointer;
    json value;
    std::string message;
  };
  for (const auto& [pointer, value, message] : std::vector<Change>{
           {"/contrast/entry_weights/1/0", -1, "below 0"},
           {"/contrast/entry_weights/1", json::array({1}), "contrast.entry_weights[1]"},
           {"/contrast/entry_weights", json::array(), "each of the 3 columns"},
           {"/contrast/places/mean/2", 7, "contrast.places.mean[2]"},
           {"/contrast/places/spread", json::array({1}), "72 numbers"},
           {"/contrast/places/spread/3", 0, "where the spread is 0"},
           {"/contrast/places/weight/0/0", "much", "expected a number"},
           {"/contrast/places", 7, "an object"},
           {"/contrast/places/mode", 7, "unknown field"},
           {"/contrast/places/lookalikes", json::array({1, 2}), "each of the 3 columns"},
           {"/calibration/slope", "steep", "a number"},
       }) {
    json bad = good;
    bad[json::json_pointer(pointer)] = value;
    const Error error = ErrorOf([&] { (void)ParseTemplate(bad.dump(), "bad.json"); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << pointer;
    EXPECT_THAT(error.what(), HasSubstr(message)) << pointer;
  }
  motion_template.contrast->places.mean.pop_back();
  EXPECT_EQ(ErrorOf([&] { (void)FormatTemplate(motion_template); }).code(),
            ErrorCode::kInvalidArgument);
}

void ExpectMalformed(const json& document, const std::string& expected) {
  const Error error = ErrorOf([&] { (void)ParseTemplate(document.dump(), "bad.json"); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << expected;
  EXPECT_THAT(error.what(), HasSubstr(expected));
  EXPECT_THAT(error.what(), HasSubstr("bad.json"));
}

TEST(TemplateFile, RefusesMarksAndBackgroundsThatMakeNoSense) {
  Random random(5);
  MotionTemplate motion_template = SampleWithMarks();
  motion_template.contrast = RandomContrast(random, motion_template.matrix);
  motion_template.contrast->background = RandomBackground(random, 3);
  const json good = json::parse(FormatTemplate(motion_template));
  ASSERT_EQ(ParseTemplate(good.dump(), "good.json"), motion_template);
  struct Change {
    std::string pointer;
    json value;
    std::string message;
  };
  for (const auto& [pointer, value, message] : std::vector<Change>{
           {"/version", 2, "marks in a file of version 2"},
           {"/marks/0/verdict", "maybe", "marks[0].verdict"},
           {"/marks/1/first_frame", 0, "marks[1].first_frame"},
           {"/marks/0/last_frame", 30, "marks[0].last_frame"},
           {"/marks/0/who", "me", "unknown field"},
           {"/contrast/background/ones/1", 1, "between 0 and 1"},
           {"/contrast/background/ones", json::array(), "another size"},
           {"/contrast/background/variance/0", -1, "below 0"},
       }) {
    json bad = good;
    bad[json::json_pointer(pointer)] = value;
    ExpectMalformed(bad, message);
  }
  motion_template.marks[0].first_frame = 0;
  EXPECT_EQ(ErrorOf([&] { (void)FormatTemplate(motion_template); }).code(),
            ErrorCode::kInvalidArgument);
}

// Every object of the document, as a pointer into it.
const char* const kObjects[] = {"", "/feature_set", "/clips/0", "/matrix"};

TEST(TemplateFile, NamesEveryFieldThatIsMissing) {
  const json good = json::parse(FormatTemplate(SampleTemplate()));
  int fields = 0;
  for (const char* pointer : kObjects) {
    for (const auto& [key, value] : good.at(json::json_pointer(pointer)).items()) {
      json bad = good;
      bad.at(json::json_pointer(pointer)).erase(key);
      ExpectMalformed(bad, key + "' is missing");
      ++fields;
    }
  }
  EXPECT_EQ(fields, 12 + 2 + 3 + 4);
}

TEST(TemplateFile, NamesEveryFieldOfAWrongType) {
  const json good = json::parse(FormatTemplate(SampleTemplate()));
  for (const char* pointer : kObjects) {
    for (const auto& [key, value] : good.at(json::json_pointer(pointer)).items()) {
      for (const json& wrong : {json(true), json::object({{"a", 1}}), json("text"), json(-7.5)}) {
        if (wrong.is_number() && value.is_number()) continue;
        if (wrong.is_string() && value.is_string()) continue;
        json bad = good;
        bad.at(json::json_pointer(pointer))[key] = wrong;
        if (wrong.is_object() && (key == "feature_set" || key == "matrix")) {
          ExpectMalformed(bad, "unknown field");
        } else {
          ExpectMalformed(bad, key);
        }
      }
    }
  }
}

TEST(TemplateFile, NamesFieldsThatItDoesNotKnow) {
  const json good = json::parse(FormatTemplate(SampleTemplate()));
  for (const char* pointer : kObjects) {
    json bad = good;
    bad.at(json::json_pointer(pointer))["colour"] = 1;
    ExpectMalformed(bad, "colour");
  }
}

TEST(TemplateFile, RefusesKeyframesInAVersionThatHadNone) {
  json document = json::parse(FormatTemplate(SampleWithKeyframes()));
  document["version"] = 1;
  ExpectMalformed(document, "keyframes in a file of version 1");
}

struct BadValue {
  const char* pointer;
  json value;
  const char* expected;
};

TEST(TemplateFile, NamesEveryValueOutOfRange) {
  const BadValue cases[] = {
      {"/format", "kinebase-take", "no template file"},
      {"/version", 0, "version is 0"},
      {"/version", 1.5, "version is 1.5"},
      {"/learning", "Bonn", "learning is"},
      {"/matching", "", "matching is"},
      {"/feature_set/hash", "12", "16 hexadecimal digits"},
      {"/feature_set/hash", "00f1e2d3c4b5a69g", "16 hexadecimal digits"},
      {"/feature_set/hash", "-0f1e2d3c4b5a697", "16 hexadecimal digits"},
      {"/clips/0/first_frame", -1, "clips[0].first_frame is -1"},
      {"/clips/0/first_frame", 0, "clips[0].last_frame"},
      {"/clips/0/last_frame", 120, "clips[0].last_frame is 120"},
      {"/clips/1/last_frame", 5, "clips[1].last_frame is 5"},
      {"/clips/1", 3, "clips[1] is 3"},
      {"/rounds", -1, "rounds is -1"},
      {"/rounds", 2.5, "rounds is 2.5"},
      {"/rounds", 3000000000, "rounds is 3000000000"},
      {"/rounds", 18446744073709551615U, "rounds is 18446744073709551615"},
      {"/quantisation", 0.5, "quantisation is 0.5"},
      {"/quantisation", -0.1, "quantisation is -0.1"},
      {"/tau", -0.1, "tau is -0.1"},
      {"/tau", "0.1", "tau is"},
      {"/matrix/rate_hz", 0, "rate 0 Hz"},
      {"/matrix/rate_hz", -30, "rate -30 Hz"},
      {"/matrix/feature_count", 0, "matrix.feature_count is 0"},
      {"/matrix/feature_count", 65, "matrix.feature_count is 65"},
      {"/matrix/feature_count", 2, "expected a list of 2 numbers"},
      {"/matrix/weights", json::array(), "matrix.columns has 3 columns, matrix.weights has 0"},
      {"/matrix/weights/1", 0, "weight 0 of column 2"},
      {"/matrix/weights/1", -2, "weight -2 of column 2"},
      {"/matrix/weights/1", nullptr, "matrix.weights[1] is null"},
      {"/matrix/columns/1", json::array({1, 1}), "matrix.columns[1]"},
      {"/matrix/columns/1", 1, "matrix.columns[1]"},
      {"/matrix/columns/2/1", 1.25, "value 1.25 of feature 2 in column 3"},
      {"/matrix/columns/2/1", -1, "value -1 of feature 2 in column 3"},
      {"/matrix/columns/2/1", "1", "matrix.columns[2][1]"},
  };
  const json good = json::parse(FormatTemplate(SampleTemplate()));
  for (const BadValue& bad : cases) {
    json document = good;
    document.at(json::json_pointer(bad.pointer)) = bad.value;
    SCOPED_TRACE(bad.pointer);
    ExpectMalformed(document, bad.expected);
  }
  json empty = good;
  empty["matrix"]["weights"] = json::array();
  empty["matrix"]["columns"] = json::array();
  ExpectMalformed(empty, "no columns");
}

TEST(TemplateFile, NamesWhatIsWrongWithKeyframes) {
  const BadValue cases[] = {
      {"/keyframes", 3, "keyframes is 3"},
      {"/keyframes/0", 3, "keyframes[0] is 3"},
      {"/keyframes/0/colour", 3, "colour"},
      {"/keyframes/0/column", -1, "keyframes[0].column is -1"},
      {"/keyframes/0/column", 3, "keyframe 1 has column 3; expected 0 to 2"},
      {"/keyframes/1/column", 0, "keyframe 2 is before the one before it"},
      {"/keyframes/0/ones", json::array({0}), "keyframes[0].ones has 0"},
      {"/keyframes/0/ones", json::array({65}), "keyframes[0].ones has 65"},
      {"/keyframes/0/ones", json::array({1.5}), "keyframes[0].ones has 1.5"},
      {"/keyframes/0/ones", json::array({4}), "keyframe 1 has feature 4; expected 1 to 3"},
      {"/keyframes/0/ones", json::array(), "keyframe 1 has no feature to test"},
      {"/keyframes/1/zeros", json::array({1}), "features that are not in ones too"},
      {"/keyframes/0/misses", 2, "keyframe 1 has 2 misses; expected 0 to 1"},
      {"/keyframes/0/misses", -1, "keyframes[0].misses is -1"},
      {"/keyframes/1/stiffness", 1.5, "keyframe 2 has stiffness 1.5"},
      {"/keyframes/1/stiffness", "stiff", "keyframes[1].stiffness is"},
  };
  const json good = json::parse(FormatTemplate(SampleWithKeyframes()));
  for (const BadValue& bad : cases) {
    json document = good;
    document[json::json_pointer(bad.pointer)] = bad.value;
    SCOPED_TRACE(bad.pointer);
    ExpectMalformed(document, bad.expected);
  }
}

TEST(TemplateFile, RefusesWhatIsNotJsonWithItsPlace) {
  for (const char* text : {"", "{", "[1, 2", "{\"format\": nan}", "\xff\xfe", "{} {}", "null x"}) {
    const Error error = ErrorOf([&] { (void)ParseTemplate(text, "bad.json"); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), HasSubstr("not JSON"));
    EXPECT_GE(error.place().byte, 0);
  }
  for (const char* text : {"null", "[]", "3", "\"kinebase-template\""}) {
    const Error error = ErrorOf([&] { (void)ParseTemplate(text, "bad.json"); });
    EXPECT_THAT(error.what(), HasSubstr("expected an object"));
  }
}

TEST(TemplateFile, RefusesNumbersThatNoDoubleHolds) {
  std::string text = FormatTemplate(SampleTemplate());
  text.replace(text.find("0.0625"), 6, "1e9999");
  const Error error = ErrorOf([&] { (void)ParseTemplate(text, "bad.json"); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_THAT(error.what(), HasSubstr("too large"));
}

TEST(TemplateFile, SurvivesDeepNesting) {
  constexpr std::size_t kDepth = 300'000;
  const std::string text =
      "{\"format\": " + std::string(kDepth, '[') + std::string(kDepth, ']') + "}";
  EXPECT_EQ(ErrorOf([&] { (void)ParseTemplate(text, "deep.json"); }).code(),
            ErrorCode::kMalformedFile);
}

TEST(TemplateFile, RefusesEveryCutThatLosesSomething) {
  const std::string text = FormatTemplate(SampleTemplate());
  for (std::size_t length = 0; length + 2 < text.size(); ++length) {
    const Error error =
        ErrorOf([&] { (void)ParseTemplate(std::string_view(text).substr(0, length), "cut.json"); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  }
}

TEST(TemplateFile, DoesNotWriteWhatItWouldNotRead) {
  std::vector<MotionTemplate> bad(8, SampleTemplate());
  bad[0].matrix.values[0] = std::numeric_limits<double>::quiet_NaN();
  bad[1].quantisation = 0.5;
  bad[2].tau = std::numeric_limits<double>::infinity();
  bad[3].rounds = -1;
  bad[4].clips[0].last_frame = 7;
  bad[5].name = "\xff";
  bad[6].matrix = {};
  bad[7].keyframes = {{.column = 3, .tested = 1}};
  for (const MotionTemplate& motion_template : bad) {
    EXPECT_EQ(ErrorOf([&] { (void)FormatTemplate(motion_template); }).code(),
              ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace kinebase::test
