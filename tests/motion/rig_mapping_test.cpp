// Which joints of a rig stand for the standard joints: every rig of the table, and none of them.

#include "kinebase/motion/rig_mapping.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "motion/person.h"
#include "motion/recording_files.h"

namespace kinebase {
namespace {

using testing::AllOf;
using testing::HasSubstr;

struct Rig {
  std::string name;
  test::Person person;
  std::set<StandardJoint> nearby;  // Those that the table says are only about there.
};

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// A person with the names of one column, each the first that the table allows.
Rig PersonOfRig(const CsvTable& table, std::size_t column) {
  Rig rig{.name = table.columns[column]};
  std::map<StandardJoint, std::string> names;
  std::vector<std::string> others;
  for (const auto& row : table.rows) {
    const auto joint = ParseStandardJoint(row[0]);
    if (!joint) {
      others = Split(row[column], ';');
      continue;
    }
    std::string name = Split(row[column], '|').front();
    if (name.starts_with('~')) {
      rig.nearby.insert(*joint);
      name.erase(0, 1);
    }
    names[*joint] = name;
  }
  rig.person = test::MakePerson([&](StandardJoint joint) { return names.at(joint); });
  for (const std::string& other : others) {
    const bool is_there = std::ranges::any_of(rig.person.joints,
                                              [&](const auto& made) { return made.name == other; });
    if (other.empty() || is_there) continue;
    rig.person.joints.push_back({other, 0, test::PlaceOnPerson(StandardJoint::kRoot)});
  }
  return rig;
}

std::vector<Rig> AllRigs() {
  const CsvTable table =
      test::ReadCsv(std::filesystem::path(KINEBASE_SOURCE_DIR) / "data/rigs/rigs.csv");
  std::vector<Rig> rigs;
  for (std::size_t c = 1; c < table.columns.size(); ++c) rigs.push_back(PersonOfRig(table, c));
  return rigs;
}

void ExpectMapped(const Rig& rig, const RigMapping& mapping) {
  EXPECT_EQ(mapping.rig, rig.name);
  ASSERT_EQ(mapping.sources.size(), static_cast<std::size_t>(kStandardJointCount));
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    SCOPED_TRACE(ToString(joint));
    EXPECT_EQ(mapping.name_map[j].trajectory_joint, rig.person.at(joint));
    EXPECT_EQ(mapping.sources[j].joint, joint);
    EXPECT_EQ(mapping.sources[j].match, JointMatch::kTable);
    EXPECT_EQ(mapping.sources[j].confidence, rig.nearby.contains(joint) ? .75 : 1);
    EXPECT_EQ(mapping.sources[j].source, rig.person.joints[rig.person.at(joint)].name);
  }
}

TEST(RigMapping, KnowsEveryRigOfTheTableByItsNames) {
  const std::vector<Rig> rigs = AllRigs();
  EXPECT_GE(rigs.size(), 14);
  for (const Rig& rig : rigs) {
    SCOPED_TRACE(rig.name);
    ExpectMapped(rig, MapRig(test::JointsOf(rig.person)));
  }
}

TEST(RigMapping, LooksThroughPrefixesCaseAndSeparators) {
  const auto upper = [](std::string name) {
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
    return name;
  };
  for (Rig& rig : AllRigs()) {
    SCOPED_TRACE(rig.name);
    for (const std::string prefix : {"mixamorig:", "Bip01 ", "Character1_", "a:b:"}) {
      SCOPED_TRACE(prefix);
      Rig named = rig;
      for (auto& joint : named.person.joints) joint.name = prefix + joint.name;
      ExpectMapped(named, MapRig(test::JointsOf(named.person)));
    }
    Rig loud = rig;
    for (auto& joint : loud.person.joints) joint.name = upper(joint.name);
    ExpectMapped(loud, MapRig(test::JointsOf(loud.person)));
  }
}

// A rig's rotation for a joint is that of the bone that leads on from it.
TEST(RigMapping, TakesTheRotationOfTheBoneBehindAJoint) {
  const test::Person person =
      test::MakePerson([](StandardJoint joint) { return std::string(ToString(joint)); });
  const RigMapping mapping = MapRig(test::JointsOf(person));
  ASSERT_EQ(mapping.rig, "standard");
  using enum StandardJoint;
  const auto rotation = [&](StandardJoint joint) {
    return mapping.name_map[static_cast<int>(joint)].rotation_joint;
  };
  EXPECT_EQ(rotation(kRoot), 0);
  EXPECT_EQ(rotation(kLelbow), person.at(kLwrist));
  EXPECT_EQ(rotation(kRhip), person.at(kRknee));
  EXPECT_EQ(rotation(kHeadtop), -1);
}

test::Person Nameless() {
  return test::MakePerson(
      [](StandardJoint joint) { return fmt::format("n{}", static_cast<int>(joint)); });
}

void ExpectByTopology(const test::Person& person) {
  const RigMapping mapping = MapRig(test::JointsOf(person));
  EXPECT_EQ(mapping.rig, "");
  for (int j = 0; j < kStandardJointCount; ++j) {
    SCOPED_TRACE(ToString(static_cast<StandardJoint>(j)));
    EXPECT_EQ(mapping.name_map[j].trajectory_joint, person.standard[j]);
    EXPECT_EQ(mapping.sources[j].match, JointMatch::kTopology);
    EXPECT_EQ(mapping.sources[j].confidence, .7);
  }
}

TEST(RigMapping, FindsUnknownNamesByTheShapeOfTheTree) { ExpectByTopology(Nameless()); }

TEST(RigMapping, TellsLeftByTheToesWhicheverWayThePersonLooks) {
  for (const double degrees : {90., 180., 235.}) {
    const Eigen::AngleAxisd turn(degrees * 3.14159265358979 / 180, Eigen::Vector3d::UnitY());
    test::Person person = Nameless();
    for (auto& joint : person.joints) joint.place_cm = turn * joint.place_cm;
    ExpectByTopology(person);
    test::Person lying = person;
    const Eigen::AngleAxisd down(1.5707963267949, Eigen::Vector3d::UnitX());
    for (auto& joint : lying.joints) joint.place_cm = down * joint.place_cm;
    ExpectByTopology(lying);
  }
}

TEST(RigMapping, SaysWhichJointStandsInForOneThatIsNotThere) {
  test::Person person =
      test::MakePerson([](StandardJoint joint) { return std::string(ToString(joint)); });
  std::vector<Joint> joints = test::JointsOf(person);
  // Without the tip of the head, the last joint of the trunk.
  ASSERT_EQ(joints[person.at(StandardJoint::kHeadtop)].bone_name, "headtop");
  joints[person.at(StandardJoint::kHeadtop)].bone_name = "hat";
  const RigMapping mapping = MapRig(joints);
  const JointSource& source = mapping.sources[static_cast<int>(StandardJoint::kHeadtop)];
  EXPECT_EQ(source.match, JointMatch::kTopology);
  EXPECT_EQ(source.source, "hat");
  EXPECT_EQ(source.confidence, .7);
}

TEST(RigMapping, NamesWithoutNameSpace) {
  EXPECT_EQ(BareJointName("mixamorig:Hips"), "Hips");
  EXPECT_EQ(BareJointName("a:b:Hips"), "Hips");
  EXPECT_EQ(BareJointName("Hips"), "Hips");
  EXPECT_EQ(BareJointName("Hips:"), "Hips:");
  EXPECT_EQ(BareJointName(""), "");
}

using RigFiles = test::RecordingFiles;

TEST_F(RigFiles, OfSomethingThatIsNoPersonNameWhatIsMissing) {
  constexpr std::string_view kCrane =
      "HIERARCHY\nROOT Base\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n"
      "JOINT Boom\n{\nOFFSET 0 300 0\nCHANNELS 1 Zrotation\nEnd Site\n{\nOFFSET 500 0 0\n}\n}\n}\n"
      "MOTION\nFrames: 1\nFrame Time: 0.04\n0 0 0 10\n";
  const Recording crane = LoadText("crane.bvh", kCrane);
  EXPECT_EQ(crane.frame_count(), 1);
  Diagnostics diagnostics;
  const Error error = test::ErrorOf([&] { (void)StandardJoints(crane, diagnostics); });
  EXPECT_EQ(error.code(), ErrorCode::kMismatch);
  EXPECT_THAT(error.what(),
              AllOf(HasSubstr("crane.bvh"), HasSubstr("lacks bones for 23 of the 24")));
}

TEST_F(RigFiles, GiveTheStandardJointsOfTheirRig) {
  for (const Rig& rig : AllRigs()) {
    SCOPED_TRACE(rig.name);
    const Recording loaded = LoadText("person.bvh", test::BvhOf(rig.person));
    Diagnostics diagnostics;
    const JointTrajectories joints = StandardJoints(loaded, diagnostics);
    for (int j = 0; j < kStandardJointCount; ++j) {
      const auto joint = static_cast<StandardJoint>(j);
      EXPECT_LE((joints.at(1, joint) - test::PlaceOnPerson(joint)).norm(), 1e-9) << ToString(joint);
    }
    EXPECT_EQ(FindStandardJoints(loaded, diagnostics).size(), 24);
  }
}

}  // namespace
}  // namespace kinebase
