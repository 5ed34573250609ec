#include "kinebase/motion/marker_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Every joint at the marker of its name but those that `replaced` names itself.
std::string SetText(const std::string& head, const std::string& replaced = "") {
  std::string text = "format = \"kinebase-marker-set\"\nversion = 1\nname = \"made\"\n" + head;
  for (int j = 0; j < kStandardJointCount; ++j) {
    const std::string name(ToString(static_cast<StandardJoint>(j)));
    if (replaced.find('"' + name + '"') != std::string::npos) continue;
    text += fmt::format("[[joint]]\nname = \"{0}\"\nmarkers = [\"{0}\"]\n", name);
  }
  return text + replaced;
}

Error ErrorOfText(const std::string& text) {
  return test::ErrorOf([&] { (void)ParseMarkerSet(text, "set.toml"); });
}

TEST(MarkerSet, ReadsWhatTheFileSays) {
  const MarkerSet set = ParseMarkerSet(
      SetText("[size]\nfrom = [\"A\"]\nto = [\"B\", \"C\"]\ncm = 40\n"
              "[markers]\nA = [\"A\", \"A2\"]\n"
              "[axes.part]\nup = [[\"A\"], [\"B\"]]\nleft = [[\"A\", \"B\"], [\"C\"]]\n",
              "[[joint]]\nname = \"lknee\"\nmarkers = [\"A\", \"B\"]\naxes = \"part\"\n"
              "move_cm = [1, -2.5, 3]\nconfidence = 0.5\n"),
      "set.toml");
  EXPECT_EQ(set.name, "made");
  EXPECT_EQ(set.size_cm, 40);
  EXPECT_THAT(set.size_to, ElementsAre("B", "C"));
  EXPECT_THAT(set.labels.at("A"), ElementsAre("A", "A2"));
  const MarkerSet::Axes& axes = set.axes.at("part");
  EXPECT_EQ(axes.first.direction, MarkerSet::Direction::kUp);  // As it stands first in the file.
  EXPECT_EQ(axes.second.direction, MarkerSet::Direction::kLeft);
  EXPECT_THAT(axes.second.from, ElementsAre("A", "B"));
  const MarkerSet::JointRow& knee = set.joints.back();
  EXPECT_EQ(knee.joint, StandardJoint::kLknee);
  EXPECT_EQ(knee.axes, "part");
  EXPECT_EQ(knee.move_cm, Eigen::Vector3d(1, -2.5, 3));
  EXPECT_EQ(knee.confidence, 0.5);
}

TEST(MarkerSet, NamesLineAndMistake) {
  const std::string axes = "[axes.part]\nup = [[\"A\"], [\"B\"]]\nleft = [[\"A\"], [\"C\"]]\n";
  const std::string knee = "[[joint]]\nname = \"lknee\"\nmarkers = [\"A\"]\n";
  const std::pair<std::string, std::string> cases[] = {
      {"format = \"other\"", "set.toml:1: is no marker set"},
      {SetText("colour = 1\n"), "set.toml:4: unknown key 'colour'"},
      {SetText("", "[[joint]]\nname = \"tail\"\nmarkers = [\"A\"]\n"),
       "'tail' is no standard joint"},
      {SetText("", "[[joint]]\nname = \"lknee\"\nmarkers = []\n"), "'markers' must be a list"},
      {SetText("", "[[joint]]\nname = \"lknee\"\nmarkers = [3]\n"),
       "holds something that is no name"},
      {SetText("", knee + "axes = \"part\"\nmove_cm = [1, 2, 3]\n"), "no axes named 'part'"},
      {SetText(axes, knee + "axes = \"part\"\nmove_cm = [1, 2]\n"), "needs three numbers"},
      {SetText(axes, knee + "axes = \"part\"\nmove_cm = [1, 2, \"3\"]\n"), "must be a number"},
      {SetText("", knee + "confidence = 2\n"), "must lie between 0 and 1"},
      {SetText("[axes.part]\nup = [[\"A\"], [\"B\"]]\n"), "needs two of"},
      {SetText("[axes.part]\nup = [[\"A\"]]\nleft = [[\"A\"], [\"C\"]]\n"), "needs two lists"},
      {SetText("[size]\nfrom = [\"A\"]\nto = [\"B\"]\ncm = 0\n"), "'cm' must be positive"},
      {SetText("", "x = \"lknee\"\n"), "unknown key 'x'"},
      {"format = \"kinebase-marker-set\"\nversion = 2\n", "use a newer one"},
      {"format = ", "set.toml:1"},
  };
  for (const auto& [text, expected] : cases) {
    const Error error = ErrorOfText(text);
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.what(), HasSubstr(expected));
  }
}

TEST(MarkerSet, NeedsARowForEveryJoint) {
  EXPECT_THAT(ErrorOfText("format = \"kinebase-marker-set\"\nversion = 1\nname = \"n\"\n"
                          "[[joint]]\nname = \"root\"\nmarkers = [\"A\"]\n")
                  .what(),
              HasSubstr("has no [[joint]] for 'lhip'"));
}

TEST(MarkerSet, BuiltInOnesAreWhole) {
  EXPECT_EQ(BuiltInMarkerSets().size(), 3);
  // What one side has the other has too, mirrored.
  const MarkerSet& body = BuiltInMarkerSets().back();
  ASSERT_EQ(body.name, "full-body");
  for (const MarkerSet::JointRow& row : body.joints) {
    const StandardJoint other = Mirrored(row.joint);
    const bool is_mirrored =
        std::ranges::any_of(body.joints, [&](const MarkerSet::JointRow& candidate) {
          return candidate.joint == other && candidate.markers.size() == row.markers.size() &&
                 candidate.move_cm.x() == -row.move_cm.x() &&
                 candidate.move_cm.tail<2>() == row.move_cm.tail<2>() &&
                 candidate.confidence == row.confidence;
        });
    EXPECT_TRUE(is_mirrored) << ToString(row.joint);
  }
}

}  // namespace
}  // namespace kinebase
