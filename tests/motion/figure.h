// A made-up figure with every bone of the standard skeleton whose two sides mirror each other
// exactly, and smooth random motions of it.
#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "kinebase/formats/asf.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/motion.h"

namespace kinebase::test {

struct FigureBone {
  const char* parent;
  const char* name;              // Of the left side, or in the middle.
  std::array<double, 3> end_cm;  // From the parent's end, neutral pose; left is +x.
  std::array<double, 3> axis;    // Degrees.
  const char* dofs;
};

// In depth-first order of one side; the other side follows by mirroring.
inline const std::vector<FigureBone>& FigureBones() {
  static const std::vector<FigureBone> bones = {
      {"root", "lhipjoint", {9, -8, 3}, {0, 0, 0}, ""},
      {"lhipjoint", "lfemur", {6, -40, 1}, {0, 0, 20}, "xyz"},
      {"lfemur", "ltibia", {5, -41, -2}, {0, 0, 20}, "x"},
      {"ltibia", "lfoot", {1, -5, 12}, {-90, 10, 20}, "xz"},
      {"lfoot", "ltoes", {0, 0, 7}, {-90, 10, 20}, "x"},
      {"root", "lowerback", {0, 12, -1}, {0, 0, 0}, "xyz"},
      {"lowerback", "upperback", {0, 12, 0}, {0, 0, 0}, "xyz"},
      {"upperback", "thorax", {0, 12, 1}, {0, 0, 0}, "xyz"},
      {"thorax", "lowerneck", {0, 9, 1}, {0, 0, 0}, "xyz"},
      {"lowerneck", "upperneck", {0, 9, 1}, {0, 0, 0}, "xyz"},
      {"upperneck", "head", {0, 9, 0}, {0, 0, 0}, "xyz"},
      {"thorax", "lclavicle", {18, 6, 0}, {10, 0, 30}, "yz"},
      {"lclavicle", "lhumerus", {28, 0, 1}, {180, 30, 90}, "xyz"},
      {"lhumerus", "lradius", {17, 0, 0}, {180, 30, 90}, "x"},
      {"lradius", "lwrist", {9, 0, 0}, {180, 30, 90}, "y"},
      {"lwrist", "lhand", {5, 0, 0}, {-90, 90, 45}, "xz"},
      {"lhand", "lfingers", {4, 0, 0}, {-90, 90, 45}, "x"},
  };
  return bones;
}

inline std::string OtherSide(std::string name) {
  if (name != "lowerback" && name != "lowerneck" && name[0] == 'l') name[0] = 'r';
  return name;
}

// With `:units length` as HDM05 has it.
inline AsfSkeleton FigureAsf() {
  constexpr double kCmPerUnit = 2.54 / 0.45;
  AsfSkeleton asf;
  asf.file_name = "figure.asf";
  asf.name = "figure";
  asf.length_unit = 0.45;
  asf.root_order = {AsfDof::kTx, AsfDof::kTy, AsfDof::kTz, AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  for (const int side : {1, -1}) {
    for (const FigureBone& from : FigureBones()) {
      const std::string name = side > 0 ? from.name : OtherSide(from.name);
      if (side < 0 && name == from.name) continue;  // In the middle.
      const auto& [x, y, z] = from.end_cm;
      AsfBone bone;
      bone.name = name;
      bone.direction = {side * x, y, z};
      bone.length = std::sqrt(x * x + y * y + z * z) / kCmPerUnit;
      bone.axis = {from.axis[0], side * from.axis[1], side * from.axis[2]};
      for (const char* dof = from.dofs; *dof != '\0'; ++dof) {
        bone.dofs.push_back(*dof == 'x' ? AsfDof::kRx : *dof == 'y' ? AsfDof::kRy : AsfDof::kRz);
      }
      asf.bones.push_back(bone);
      asf.hierarchy.push_back({side > 0 ? from.parent : OtherSide(from.parent), {name}});
    }
  }
  return asf;
}

inline std::shared_ptr<const Skeleton> FigureSkeleton() {
  Diagnostics ignored;
  return BuildSkeleton(FigureAsf(), {}, ignored);
}

// A number that wanders smoothly between −amplitude and amplitude, at most `fastest_hz` a wave.
class SmoothWalk {
 public:
  SmoothWalk(std::mt19937& random, double amplitude, double fastest_hz) {
    std::uniform_real_distribution<double> share(0, 1);
    for (Wave& wave : waves_) {
      wave = {amplitude / 3 * share(random), fastest_hz * share(random),
              2 * std::numbers::pi * share(random)};
    }
  }

  double operator()(double time_s) const {
    double sum = 0;
    for (const Wave& wave : waves_) {
      sum += wave.size * std::sin(2 * std::numbers::pi * wave.hz * time_s + wave.phase);
    }
    return sum;
  }

 private:
  struct Wave {
    double size = 0;
    double hz = 0;
    double phase = 0;
  };
  std::array<Wave, 3> waves_;
};

// Every DOF of the skeleton wanders: angles within ±`amplitude_rad`, the root within two metres.
inline Motion SmoothMotion(std::shared_ptr<const Skeleton> skeleton, unsigned seed, int frames,
                           double rate_hz, double amplitude_rad = 1.5) {
  std::mt19937 random(seed);
  Motion motion{.skeleton = std::move(skeleton), .rate_hz = rate_hz, .frame_count = frames};
  const auto joints = motion.skeleton->joints().size();
  motion.rotations.assign(frames * joints, Eigen::Quaterniond::Identity());
  motion.root_position_cm.assign(frames, Eigen::Vector3d::Zero());
  for (int axis = 0; axis < 3; ++axis) {
    const SmoothWalk walk(random, 100, 1);
    for (int t = 0; t < frames; ++t) motion.root_position_cm[t][axis] = walk(t / rate_hz);
  }
  for (std::size_t joint = 0; joint < joints; ++joint) {
    const Joint& bone = motion.skeleton->joints()[joint];
    std::vector<Eigen::Vector3d> angles(frames, Eigen::Vector3d::Zero());
    for (const Dof dof : bone.dofs) {
      if (dof < Dof::kRx || dof > Dof::kRz) continue;
      const SmoothWalk walk(random, amplitude_rad, 1.5);
      for (int t = 0; t < frames; ++t) angles[t][static_cast<int>(dof) - 3] = walk(t / rate_hz);
    }
    const auto& axis = motion.skeleton->axis(static_cast<int>(joint));
    for (int t = 0; t < frames; ++t) {
      motion.rotations[t * joints + joint] =
          axis * EulerToQuaternion(angles[t], bone.euler_order) * axis.conjugate();
    }
  }
  return motion;
}

// The largest distance in cm between the same joints of two recordings.
inline double LargestDistance(const JointTrajectories& a, const JointTrajectories& b) {
  if (a.positions_cm.size() != b.positions_cm.size()) return INFINITY;
  double largest = 0;
  for (std::size_t i = 0; i < a.positions_cm.size(); ++i) {
    largest = std::max(largest, (a.positions_cm[i] - b.positions_cm[i]).norm());
  }
  return largest;
}

}  // namespace kinebase::test
