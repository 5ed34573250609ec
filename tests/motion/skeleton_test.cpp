#include "kinebase/motion/skeleton.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinebase/core/error.h"
#include "motion/figure.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Joint MakeJoint(const std::string& name, int parent, std::vector<Dof> dofs = {}) {
  Joint joint{.name = name, .bone_name = name, .parent = parent};
  joint.dofs = std::move(dofs);
  return joint;
}

// The error that a list of joints gives.
std::string Refusal(const std::vector<Joint>& joints) {
  const Error error = test::ErrorOf([&] { const Skeleton skeleton(joints); });
  EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  return error.message();
}

TEST(Skeleton, RefusesWhatIsNoTreeInOrder) {
  EXPECT_THAT(Refusal({}), HasSubstr("needs a joint"));
  EXPECT_THAT(Refusal({MakeJoint("a", 0)}), HasSubstr("'a'"));
  EXPECT_THAT(Refusal({MakeJoint("root", -1), MakeJoint("b", -1)}), HasSubstr("joint 1 ('b')"));
  EXPECT_THAT(Refusal({MakeJoint("root", -1), MakeJoint("b", 1)}), HasSubstr("its parent"));
  EXPECT_THAT(Refusal({MakeJoint("root", -1), MakeJoint("b", 2), MakeJoint("c", 0)}),
              HasSubstr("its parent"));
  EXPECT_THAT(Refusal({MakeJoint("root", -1), MakeJoint("b", -2)}), HasSubstr("'b'"));
}

TEST(Skeleton, RefusesTwoBonesOfOneName) {
  EXPECT_THAT(Refusal({MakeJoint("root", -1), MakeJoint("b", 0), MakeJoint("b", 1)}),
              HasSubstr("two bones named 'b'"));
}

TEST(Skeleton, RefusesLimitsThatDoNotFit) {
  Joint joint = MakeJoint("b", 0, {Dof::kRx, Dof::kRy});
  joint.limits = {{-1, 1}};
  EXPECT_THAT(Refusal({MakeJoint("root", -1), joint}), HasSubstr("limits"));
}

TEST(Skeleton, KnowsItsChainsAndWhatMoves) {
  // root ─ a ─ b ─ c
  //   │    └ d
  //   └ e
  const Skeleton skeleton({MakeJoint("root", -1, {Dof::kTx}), MakeJoint("a", 0, {Dof::kRx}),
                           MakeJoint("b", 1), MakeJoint("c", 2, {Dof::kRz}), MakeJoint("d", 1),
                           MakeJoint("e", 0)});
  EXPECT_THAT(skeleton.chains(),
              ElementsAre(ElementsAre(0, 1, 2, 3), ElementsAre(1, 4), ElementsAre(0, 5)));
  EXPECT_THAT(skeleton.animated(), ElementsAre(0, 1, 3));
  EXPECT_THAT(skeleton.unanimated(), ElementsAre(2, 4, 5));
  EXPECT_THAT(skeleton.children(1), ElementsAre(2, 4));
}

TEST(Skeleton, VisitsEveryBoneOnceInItsChains) {
  const auto skeleton = test::FigureSkeleton();
  std::vector<int> visits(skeleton->joint_count(), 0);
  for (const auto& chain : skeleton->chains()) {
    for (std::size_t i = 1; i < chain.size(); ++i) {
      EXPECT_EQ(skeleton->joints()[chain[i]].parent, chain[i - 1]);
      ++visits[chain[i]];
    }
  }
  for (int joint = 1; joint < skeleton->joint_count(); ++joint) EXPECT_EQ(visits[joint], 1);
}

TEST(Skeleton, MayBeASingleJoint) {
  const Skeleton skeleton({MakeJoint("root", -1)});
  EXPECT_THAT(skeleton.chains(), ElementsAre(ElementsAre(0)));
}

TEST(Skeleton, FindsBonesInAnyCaseButPrefersTheirOwn) {
  const Skeleton skeleton(
      {MakeJoint("root", -1), MakeJoint("Arm", 0), MakeJoint("arm", 0), MakeJoint("leg", 0)});
  EXPECT_EQ(skeleton.FindBone("arm"), 2);
  EXPECT_EQ(skeleton.FindBone("Arm"), 1);
  EXPECT_EQ(skeleton.FindBone("LEG"), 3);
  EXPECT_FALSE(skeleton.FindBone("hand"));
}

TEST(Skeleton, MapsEachStandardJointToTheBonesAroundIt) {
  const auto skeleton = test::FigureSkeleton();
  const auto& elbow = skeleton->name_map()[static_cast<int>(StandardJoint::kLelbow)];
  EXPECT_EQ(skeleton->joints()[elbow.rotation_joint].bone_name, "lradius");
  EXPECT_EQ(skeleton->joints()[elbow.trajectory_joint].bone_name, "lhumerus");
  const auto& headtop = skeleton->name_map()[static_cast<int>(StandardJoint::kHeadtop)];
  EXPECT_EQ(headtop.rotation_joint, -1);
  EXPECT_EQ(skeleton->joints()[headtop.trajectory_joint].bone_name, "head");
  const Skeleton bare({MakeJoint("root", -1)});
  EXPECT_EQ(bare.name_map()[static_cast<int>(StandardJoint::kLelbow)].trajectory_joint, -1);
}

TEST(StandardSkeleton, NamesMirrorsAndParentsItsJoints) {
  for (int i = 0; i < kStandardJointCount; ++i) {
    const auto joint = static_cast<StandardJoint>(i);
    EXPECT_EQ(ParseStandardJoint(ToString(joint)), joint);
    EXPECT_EQ(Mirrored(Mirrored(joint)), joint);
    const auto parent = StandardParent(joint);
    EXPECT_EQ(parent.has_value(), joint != StandardJoint::kRoot);
    if (!parent) continue;
    EXPECT_EQ(StandardParent(Mirrored(joint)), Mirrored(*parent));
  }
  EXPECT_EQ(Mirrored(StandardJoint::kLwrist), StandardJoint::kRwrist);
  EXPECT_EQ(Mirrored(StandardJoint::kRoot), StandardJoint::kRoot);
  EXPECT_EQ(Mirrored(StandardJoint::kNeck), StandardJoint::kNeck);
  EXPECT_FALSE(ParseStandardJoint("hand"));
  EXPECT_FALSE(ParseStandardJoint(""));
}

TEST(EulerOrder, HasANameInAnyCase) {
  EXPECT_EQ(ParseEulerOrder("zyx"), EulerOrder::kZyx);
  EXPECT_EQ(ToString(EulerOrder::kYzx), "YZX");
  for (const char* text : {"", "XY", "XXY", "XYZX", "ABC"}) EXPECT_FALSE(ParseEulerOrder(text));
}

}  // namespace
}  // namespace kinebase
