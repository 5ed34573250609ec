// The way back: a Motion as a BVH record.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/motion/bvh_motion.h"
#include "motion/name_map.h"

namespace kinebase {
namespace {

std::size_t At(int index) { return static_cast<std::size_t>(index); }

// Where the numbers of a joint that is written come from.
struct Source {
  int rotation = -1;  // Bone whose rotation it has; -1: none, so no channels for one.
  int stretch = -1;   // Bone whose changing offset is its place; -1: it stays at its offset.
  EulerOrder order = EulerOrder::kYxz;
};

// All siblings of a skeleton that came from BVH have one rotation, that of the joint where they
// begin, unless the motion was changed since.
bool SiblingsTurnAlike(const Motion& motion) {
  constexpr double kSame = 1e-14;  // 1 − |cos| of half the angle: about 1e-7 rad.
  const Skeleton& skeleton = *motion.skeleton;
  const Eigen::Quaterniond none = Eigen::Quaterniond::Identity();
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    for (const int child : skeleton.children(joint)) {
      for (int frame = 0; frame < motion.frame_count; ++frame) {
        const auto& expected =
            joint == 0 ? none : motion.rotation(frame, skeleton.children(joint).front());
        if (1 - std::abs(motion.rotation(frame, child).dot(expected)) > kSame) return false;
      }
    }
  }
  return true;
}

// The angles of a rotation in degrees, by axis, next to those of the frame before: each may gain
// full turns, and with the middle angle b of the order (a + 180, 180 − b, c + 180) is the same
// rotation as (a, b, c).
Eigen::Vector3d AnglesNear(const Eigen::Quaterniond& rotation, EulerOrder order,
                           const Eigen::Vector3d& before) {
  const int middle = ToString(order)[1] - 'X';
  const auto unwound = [&](Eigen::Vector3d angles) {
    for (int i = 0; i < 3; ++i) angles[i] -= 360 * std::round((angles[i] - before[i]) / 360);
    return angles;
  };
  const Eigen::Vector3d angles = QuaternionToEuler(rotation, order) / kRadiansPerDegree;
  Eigen::Vector3d flipped = angles + Eigen::Vector3d::Constant(180);
  flipped[middle] = 180 - angles[middle];
  const Eigen::Vector3d first = unwound(angles);
  const Eigen::Vector3d second = unwound(flipped);
  return (second - before).squaredNorm() < (first - before).squaredNorm() ? second : first;
}

// Names end with their line and before a brace.
std::string WritableName(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return (c >= 0 && c < 0x20) || c == '{' || c == '}'; }, '_');
  return name;
}

// Nine decimals hold a place within 1e-8 cm; what is noise below becomes 0.
double Rounded(double value) {
  constexpr double kDecimals = 1e9;
  const double rounded = std::round(value * kDecimals) / kDecimals;
  return rounded == 0 ? 0 : rounded;  // No "-0".
}

class BvhBuilder {
 public:
  BvhBuilder(const Motion& motion, const BvhWriteOptions& options)
      : motion_(motion),
        skeleton_(*motion.skeleton),
        units_per_cm_(1 / CentimetresInOrFail(options.units)),
        from_y_up_(ToYUp(options.up_axis).transpose()),
        turn_(from_y_up_),
        stretches_(skeleton_.joints().size(), false) {
    const std::size_t joints = stretches_.size();
    for (std::size_t i = 0; i < motion.extra_offsets_cm.size(); ++i) {
      if (!motion.extra_offsets_cm[i].isZero(0)) stretches_[i % joints] = true;
    }
  }

  BvhMotion Build() {
    AddRoot();
    if (HasJointNames() && SiblingsTurnAlike(motion_)) {
      AddJointsOfBvh();
    } else {
      AddBones();
    }
    SetChannels();
    SetValues();
    bvh_.declared_frame_count = motion_.frame_count;
    bvh_.frame_time_s = 1 / motion_.rate_hz;
    bvh_.frame_time_text = ToShortestText(bvh_.frame_time_s);
    return std::move(bvh_);
  }

 private:
  // Whether bones are named after the joints where they end: not as in an ASF of its own, but as in
  // one that was written from a BVH file.
  bool HasJointNames() const {
    return skeleton_.source().file_type == "BVH" ||
           !internal::NamesStandardJoints(skeleton_.joints());
  }

  const Joint& BoneOf(int joint) const { return skeleton_.joints()[At(joint)]; }

  std::array<double, 3> Offset(const Eigen::Vector3d& offset_cm) const {
    const Eigen::Vector3d offset = from_y_up_ * offset_cm * units_per_cm_;
    return {Rounded(offset.x()), Rounded(offset.y()), Rounded(offset.z())};
  }

  int Add(const std::string& name, int parent, const Eigen::Vector3d& offset_cm, Source source) {
    bvh_.joints.push_back(
        {.name = WritableName(name), .parent = parent, .offset = Offset(offset_cm)});
    sources_.push_back(source);
    return static_cast<int>(bvh_.joints.size()) - 1;
  }

  void AddEndSite(int joint, const Eigen::Vector3d& offset_cm) {
    bvh_.joints[At(joint)].end_sites.push_back({.name = "Site", .offset = Offset(offset_cm)});
  }

  void AddRoot() {
    const Joint& root = skeleton_.joints().front();
    Add(root.name, -1, Eigen::Vector3d::Zero(), {.rotation = 0, .order = root.euler_order});
  }

  // Each bone ends at a joint of the file; that joint's rotation is the one of the bones behind it.
  void AddJointsOfBvh() {
    std::vector<int> written(skeleton_.joints().size(), 0);
    for (int bone = 1; bone < skeleton_.joint_count(); ++bone) {
      const Joint& joint = BoneOf(bone);
      const int parent = written[At(joint.parent)];
      const bool is_tip = skeleton_.children(bone).empty();
      if (is_tip && !stretches_[At(bone)]) {
        AddEndSite(parent, joint.offset_cm);
        continue;
      }
      Source source{.stretch = stretches_[At(bone)] ? bone : -1};
      if (!is_tip) {
        source.rotation = skeleton_.children(bone).front();
        source.order = BoneOf(source.rotation).euler_order;
      }
      written[At(bone)] = Add(joint.bone_name, parent, joint.offset_cm, source);
    }
  }

  // Each bone is a joint where it begins, that is at the end of the bone before.
  void AddBones() {
    std::vector<int> written(skeleton_.joints().size(), 0);
    for (int bone = 1; bone < skeleton_.joint_count(); ++bone) {
      const Joint& joint = BoneOf(bone);
      const bool at_root = joint.parent == 0;
      const bool moves = !at_root && stretches_[At(joint.parent)];
      const int index =
          Add(joint.bone_name, written[At(joint.parent)],
              at_root ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : BoneOf(joint.parent).offset_cm,
              {.rotation = bone, .stretch = moves ? joint.parent : -1, .order = joint.euler_order});
      written[At(bone)] = index;
      if (!skeleton_.children(bone).empty()) continue;
      if (stretches_[At(bone)]) {
        // An end site has no channels, so the tip that moves becomes a joint.
        AddEndSite(Add(joint.bone_name + "_tip", index, joint.offset_cm, {.stretch = bone}),
                   Eigen::Vector3d::Zero());
      } else {
        AddEndSite(index, joint.offset_cm);
      }
    }
  }

  void SetChannels() {
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      BvhJoint& joint = bvh_.joints[i];
      joint.first_column = bvh_.column_count;
      if (i == 0 || sources_[i].stretch >= 0) {
        joint.channels = {BvhChannel::kXPosition, BvhChannel::kYPosition, BvhChannel::kZPosition};
      }
      if (sources_[i].rotation >= 0) {
        // Fixed axes of the order, read backwards, are moving axes left to right.
        const std::string_view order = ToString(sources_[i].order);
        for (const char axis : {order[2], order[1], order[0]}) {
          joint.channels.push_back(
              static_cast<BvhChannel>(static_cast<int>(BvhChannel::kXRotation) + axis - 'X'));
        }
      }
      bvh_.column_count += joint.channels.size();
    }
  }

  void SetValues() {
    bvh_.values.reserve(At(motion_.frame_count) * bvh_.column_count);
    std::vector<Eigen::Vector3d> angles(sources_.size(), Eigen::Vector3d::Zero());
    for (int frame = 0; frame < motion_.frame_count; ++frame) {
      for (std::size_t i = 0; i < sources_.size(); ++i) {
        if (sources_[i].rotation >= 0) {
          angles[i] =
              AnglesNear(Rotation(frame, sources_[i].rotation), sources_[i].order, angles[i]);
        }
        const Eigen::Vector3d place = Place(frame, static_cast<int>(i));
        for (const BvhChannel channel : bvh_.joints[i].channels) {
          bvh_.values.push_back(Rounded(IsRotationChannel(channel)
                                            ? angles[i][AxisOfChannel(channel)]
                                            : place[AxisOfChannel(channel)]));
        }
      }
    }
  }

  Eigen::Quaterniond Rotation(int frame, int bone) const {
    Eigen::Quaterniond rotation = motion_.rotation(frame, bone);
    if (bone == 0) rotation = skeleton_.root_orientation() * rotation;
    return turn_ * rotation * turn_.conjugate();
  }

  Eigen::Vector3d Place(int frame, int index) const {
    if (index == 0) return from_y_up_ * motion_.root_position_cm[At(frame)] * units_per_cm_;
    const int bone = sources_[At(index)].stretch;
    if (bone < 0) return Eigen::Vector3d::Zero();
    const std::size_t row = At(frame) * skeleton_.joints().size();
    return from_y_up_ * (BoneOf(bone).offset_cm + motion_.extra_offsets_cm[row + At(bone)]) *
           units_per_cm_;
  }

  const Motion& motion_;
  const Skeleton& skeleton_;
  double units_per_cm_;
  Eigen::Matrix3d from_y_up_;
  Eigen::Quaterniond turn_;
  std::vector<bool> stretches_;  // [bone] Its offset changes.
  BvhMotion bvh_;
  std::vector<Source> sources_;  // [joint that is written]
};

}  // namespace

BvhMotion ToBvh(const Motion& motion, const BvhWriteOptions& options, Diagnostics& diagnostics) {
  BvhMotion bvh = BvhBuilder(motion, options).Build();
  const auto say = [&](std::string message) {
    diagnostics.push_back({Severity::kInfo, std::move(message)});
  };
  const auto& joints = motion.skeleton->joints();
  if (std::ranges::any_of(joints, [](const Joint& joint) { return !joint.limits.empty(); })) {
    say("BVH has no place for the limits of degrees of freedom; they are left out");
  }
  if (const double read = SnapRate(bvh.frame_time_s); std::abs(read / motion.rate_hz - 1) > 1e-9) {
    say(fmt::format("a rate of {:g} Hz reads as {:g} Hz where readers round the frame time",
                    motion.rate_hz, read));
  }
  return bvh;
}

}  // namespace kinebase
