// Values of features for a block of samples at once. Internal.
//
// Joint by joint and axis by axis, the samples of a block stand side by side: what a term needs
// stays in the first-level cache, and one instruction works on several samples.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "kinebase/features/feature_set.h"
#include "kinebase/motion/motion.h"

namespace kinebase::internal {

inline constexpr int kBlockSize = 128;

// [sample]; at most kBlockSize, and no memory of its own.
using BlockValues = Eigen::Array<double, Eigen::Dynamic, 1, Eigen::ColMajor, kBlockSize, 1>;

class FeatureBlock {
 public:
  // joints    At the set's rate; valid as long as the object lives.
  // features  Those that will be asked for.
  FeatureBlock(const JointTrajectories& joints, std::span<const Feature> features);

  // From here on it stands for the samples from `first`, up to kBlockSize of them.
  void MoveTo(int first);
  [[nodiscard]] int size() const { return size_; }

  // The value behind a feature before any threshold.
  [[nodiscard]] BlockValues Evaluate(const Feature& feature);

 private:
  using Place = Eigen::Map<const BlockValues>;
  struct Vectors {
    BlockValues x, y, z;
  };

  [[nodiscard]] const double* Axis(int joint, int axis, int sample) const;
  [[nodiscard]] Place At(int joint, int axis) const { return {Axis(joint, axis, first_), size_}; }
  [[nodiscard]] Vectors Between(StandardJoint from, StandardJoint to) const;
  [[nodiscard]] static BlockValues Dot(const Vectors& a, const Vectors& b);
  [[nodiscard]] static Vectors Unit(const Vectors& v);
  [[nodiscard]] static BlockValues AngleDegrees(const Vectors& a, const Vectors& b);

  [[nodiscard]] BlockValues Evaluate(const FeatureTerm& term);
  [[nodiscard]] BlockValues Raw(const FeatureTerm& term);
  [[nodiscard]] Vectors Direction(const FeatureTerm& term) const;
  [[nodiscard]] Vectors PlaneNormal(const FeatureTerm& term) const;
  [[nodiscard]] BlockValues Approach(const FeatureTerm& term);
  [[nodiscard]] BlockValues LowestY(std::span<const StandardJoint> ignored) const;
  [[nodiscard]] BlockValues HighestY() const;
  [[nodiscard]] BlockValues GroundExtent(std::span<const StandardJoint> joints) const;

  // Smoothed, of a joint, or of the way to it from another one; cm/s.
  [[nodiscard]] Vectors Velocity(std::optional<StandardJoint> from, StandardJoint to,
                                 double window_ms);
  [[nodiscard]] BlockValues SmoothedSteps(const double* from, const double* to, int width);

  const JointTrajectories& joints_;
  int margin_ = 0;  // Samples on either side that velocities reach for.
  int first_ = 0;
  int size_ = 0;
  int held_first_ = 0;  // The block with its margins, as far as the recording goes.
  int held_size_ = 0;
  std::vector<double> places_;  // [joint][axis][held sample]
  std::vector<double> steps_;
};

}  // namespace kinebase::internal
