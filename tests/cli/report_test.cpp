// evaluate --report, and search --curve as a picture.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "pictures/png_reader.h"
#include "pictures/svg_reader.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

class Report : public testing::Test {
 protected:
  ProgramResult Evaluate(std::vector<std::string> more) {
    std::vector<std::string> arguments = {"evaluate", "--clips", library_.list()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunKinebase(arguments);
  }

  SyntheticLibrary library_;
  fs::path folder_ = library_.scratch() / "report";
};

TEST_F(Report, HoldsTablesPicturesAndJson) {
  const ProgramResult run =
      Evaluate({"--methods", "mt,mt+", "--report", folder_, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(NamesBelow(folder_),
              ElementsAre("confusion-mt+.svg", "confusion-mt.svg", "evaluation.json",
                          "precision.svg", "reliability.svg", "report.md"));
  EXPECT_EQ(ReadText(folder_ / "evaluation.json"), run.out);
  const std::string document = ReadText(folder_ / "report.md");
  for (const std::string& name : NamesBelow(folder_)) {
    if (!name.ends_with(".svg")) continue;
    EXPECT_THAT(document, HasSubstr("](" + name + ")"));
    const SvgReader svg(ReadText(folder_ / name));
    EXPECT_THAT(svg.Texts(), Contains(HasSubstr("mt"))) << name;
  }
  EXPECT_THAT(document, HasSubstr("| classes | 3 |"));
  EXPECT_THAT(document, HasSubstr("| actors | 2 |"));
  EXPECT_THAT(document, HasSubstr("| squat1Reps | "));
  EXPECT_THAT(document, HasSubstr("kinebase evaluate --clips …/clips.csv --methods mt,mt+"));
  EXPECT_THAT(document, Not(HasSubstr(library_.scratch().string())));
  EXPECT_THAT(document, Not(HasSubstr("--quiet")));
}

TEST_F(Report, CountsEveryClipOnce) {
  const json methods = json::parse(Evaluate({"--json", "--quiet"}).out).at("methods");
  for (const json& method : methods) {
    const json& confusion = method.at("confusion");
    EXPECT_EQ(confusion.at("classes"), json({"jumpingJack1Reps", "kickRFront1Reps", "squat1Reps"}));
    std::size_t wrong = 0;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto counts = confusion.at("clips").at(row).get<std::vector<std::size_t>>();
      ASSERT_EQ(counts.size(), 4U);  // The last for those that no template fits.
      EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::size_t{0}), 4U);
      wrong += 4 - counts[row];
    }
    EXPECT_EQ(method.at("mistaken").size(), wrong);
  }
}

TEST_F(Report, HasPngPicturesAndNamesOthersByTheirOwnFolder) {
  const ProgramResult run = RunKinebase({"evaluate", "--clips", "library/clips.csv", "--methods",
                                         "mt", "--report", "made/here", "--picture-format", "png"},
                                        {.folder = library_.scratch()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("written to made/here"));
  EXPECT_THAT(run.out, HasSubstr("squat1Reps"));
  const fs::path folder = library_.scratch() / "made/here";
  EXPECT_GT(PngReader(folder / "precision.png").width(), 500);
  EXPECT_GT(PngReader(folder / "reliability.png").width(), 500);
  EXPECT_GT(PngReader(folder / "confusion-mt.png").width(), 200);
  EXPECT_THAT(ReadText(folder / "report.md"),
              HasSubstr("kinebase evaluate --clips library/clips.csv --methods mt --report "
                        "made/here --picture-format png\n"));
}

TEST_F(Report, OfAnnotationHasFrames) {
  const ProgramResult run =
      Evaluate({"--protocol", "annotate", "--methods", "mt", "--distractors",
                library_.folder() / "cut_amc", "--report", folder_, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(NamesBelow(folder_), ElementsAre("confusion-mt.svg", "evaluation.json", "report.md"));
  EXPECT_THAT(SvgReader(ReadText(folder_ / "confusion-mt.svg")).Texts(),
              IsSupersetOf({"squat1Reps", "none of them", "frames"}));
}

TEST_F(Report, OverwritesOnlyWhenAskedTo) {
  const fs::path picture = folder_ / "precision.svg";
  fs::create_directories(folder_);
  WriteText(picture, "mine");
  ExpectOneError(Evaluate({"--report", folder_, "-q"}), 1, {"precision.svg", "--force"});
  EXPECT_THAT(NamesBelow(folder_), ElementsAre("precision.svg"));
  EXPECT_EQ(Evaluate({"--report", folder_, "-q", "--force"}).exit_code, 0);
  EXPECT_THAT(ReadText(picture), HasSubstr("<svg"));
  ExpectOneError(Evaluate({"--report", picture / "x", "-q"}), 1, {"precision.svg"});
  ExpectOneError(Evaluate({"--report", picture, "-q", "-f"}), 1, {"is no folder"});
  ExpectOneError(Evaluate({"--picture-format", "png"}), 2, {"--report"});
  ExpectOneError(Evaluate({"--picture-format", "pdf", "--report", folder_}), 2, {"svg, png"});
}

TEST_F(Report, IsMadeOfRealClips) {
  KINEBASE_NEEDS_TEST_DATA();
  const fs::path clips = TestData("data/hdm05/clips.csv");
  const ProgramResult run = RunKinebase(
      {"evaluate", "--clips", clips, "--methods", "mt", "--report", folder_, "--json", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json method = json::parse(run.out).at("methods").at(0);
  // Each clip that is taken for another class takes its part from the mean over actors and classes,
  // which an independent implementation gives as .986: one of three jogs of one actor of three.
  const json& mistaken = method.at("mistaken");
  ASSERT_EQ(mistaken.size(), 1U);
  EXPECT_EQ(mistaken[0].at("class"), "jogLeftCircle4StepsRstart");
  EXPECT_NEAR(method.at("macro").at("classified").get<double>(), 1 - 1.0 / 3 / 3 / 8, 1e-9);
  const SvgReader confusion(ReadText(folder_ / "confusion-mt.svg"));
  EXPECT_EQ(confusion.Groups("row").size(), 8U);
  EXPECT_EQ(SvgReader(ReadText(folder_ / "precision.svg")).Groups("panel").size(), 9U);
}

class CurvePicture : public testing::Test {
 protected:
  SyntheticLibrary library_;
  fs::path picture_ = library_.scratch() / "curve.svg";
  std::string take_ = library_.Clip("jumpingJack1Reps", "sa", 1);
};

TEST_F(CurvePicture, HasACurveForEachTemplateAndRecording) {
  const std::string squat = library_.Learn("squat1Reps");
  const std::string kick = library_.Learn("kickRFront1Reps");
  const ProgramResult run = RunKinebase({"search", squat, kick, "--in", library_.Squat(), take_,
                                         "--curve", picture_, "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const SvgReader svg(ReadText(picture_));
  EXPECT_EQ(svg.Groups("recording").size(), 2U);
  EXPECT_EQ(svg.Groups("curve").size(), 4U);
  EXPECT_EQ(std::ranges::count(svg.Texts(), "squat1Reps"), 2);
  // A hit for each, no more and no less.
  const std::size_t hits = json::parse(run.out).at("hits").size();
  EXPECT_GE(hits, 1U);
  EXPECT_EQ(svg.Named("rect", "curve").size(), hits);
}

TEST_F(CurvePicture, ShowsHitsWherePosesCountToo) {
  const fs::path classes = library_.scratch() / "classes";
  ASSERT_EQ(RunKinebase({"learn", "--list", library_.list(), "--all-classes", "--method", "mt+",
                         "-o", classes, "-q"})
                .exit_code,
            0);
  const ProgramResult run = RunKinebase({"search", classes / "squat1Reps.template.json",
                                         classes / "jumpingJack1Reps.template.json", "--in",
                                         library_.Squat(), "--curve", picture_, "--json", "-q"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  ASSERT_EQ(json::parse(run.out).at("hits").size(), 1U);
  const auto curves = SvgReader(ReadText(picture_)).Groups("curve");
  ASSERT_EQ(curves.size(), 2U);
  const auto rectangles = [](const std::vector<SvgElement>& elements) {
    return std::ranges::count(elements, "rect", &SvgElement::name);
  };
  EXPECT_EQ(rectangles(curves[0]), 1);
  EXPECT_EQ(rectangles(curves[1]), 0);
}

TEST_F(CurvePicture, HasLabelsBeneath) {
  const std::string squat = library_.Learn("squat1Reps");
  const fs::path labels = library_.scratch() / "labels.csv";
  WriteText(labels, "file,class,first_frame,last_frame\n" + fs::path(take_).stem().string() +
                        ",jack,10,90\nother,kick,1,5\n");
  const std::vector<std::string> arguments = {"search", squat,      "--in", take_, "--curve",
                                              picture_, "--labels", labels, "-q"};
  ASSERT_EQ(RunKinebase(arguments).exit_code, 0);
  const SvgReader svg(ReadText(picture_));
  EXPECT_EQ(svg.Groups("label").size(), 1U);
  EXPECT_THAT(svg.Texts(), Contains("jack"));
  EXPECT_THAT(svg.Texts(), Not(Contains("kick")));
  ExpectOneError(RunKinebase(arguments), 1, {"curve.svg", "--force"});
  WriteText(labels, "file,class,first_frame,last_frame\nother,kick,1,5\n");
  ExpectOneError(RunKinebase({"search", squat, "--in", take_, "--curve", picture_, "--labels",
                              labels, "-q", "-f"}),
                 1, {"labels.csv", "no labels for any of the recordings"});
}

TEST_F(CurvePicture, SaysWhatGoesTogether) {
  const std::string squat = library_.Learn("squat1Reps");
  ExpectOneError(RunKinebase({"search", squat, squat, "--in", take_, "--curve", "a.csv"}), 2,
                 {"one template", ".svg"});
  ExpectOneError(RunKinebase({"search", squat, "--in", take_, "--labels", take_}), 2, {"--curve"});
  ExpectOneError(RunKinebase({"search", squat, "--in", take_, "--labels", take_, "--curve", "a"}),
                 2, {".svg"});
}

}  // namespace
}  // namespace kinebase::test
