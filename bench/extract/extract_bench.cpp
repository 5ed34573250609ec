// From the places of the standard joints to feature words, one thread: five minutes of made-up
// motion at 120 Hz. The contender is what one would write first, each value of each feature from
// its definition (features/feature_set.h), frame by frame; both give the same words.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "kinebase/features/feature_extraction.h"
#include "kinebase/features/smoothing.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase {
namespace {

using Eigen::Vector3d;

const JointTrajectories& Joints() {
  static const JointTrajectories joints =
      StandardJoints(MakeLongSyntheticTake(MakeSyntheticActor(0, 1), {}).motion);
  return joints;
}

// One term at one frame. Made-up motion lacks no joint, so nothing is NaN here.
class PlainTerm {
 public:
  PlainTerm(const JointTrajectories& joints, const FeatureTerm& term)
      : joints_(joints), term_(term), width_(BoxWidth(term.window_ms, joints.rate_hz)) {}

  [[nodiscard]] double At(int frame) const {
    const double value = Raw(frame);
    return (term_.absolute ? std::abs(value) : value) * term_.factor;
  }

 private:
  [[nodiscard]] const Vector3d& Place(int frame, std::size_t joint) const {
    return joints_.at(frame, term_.joints[joint]);
  }
  [[nodiscard]] Vector3d Between(int frame, std::size_t from, std::size_t to) const {
    return Place(frame, to) - Place(frame, from);
  }
  static Vector3d Unit(const Vector3d& v) { return v / v.norm(); }
  static double Degrees(const Vector3d& a, const Vector3d& b) {
    const double cosine = a.dot(b) / (a.norm() * b.norm());
    return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
  }
  [[nodiscard]] Vector3d Normal(int t) const {
    return Unit(Between(t, 2, 0).cross(Between(t, 2, 1)));
  }
  [[nodiscard]] Vector3d Direction(int t) const { return Unit(Between(t, 0, 1)); }

  [[nodiscard]] double Raw(int t) const {
    switch (term_.type) {
      case TermType::kPlane:
        return Normal(t).dot(Between(t, 2, 3));
      case TermType::kNormalPlane:
        return Direction(t).dot(Between(t, 2, 3));
      case TermType::kAngle:
        return Degrees(Between(t, 1, 0), Between(t, 3, 2));
      case TermType::kAngleWithUp:
        return Degrees(Between(t, 0, 1), Vector3d::UnitY());
      case TermType::kNormalMove:
        return Direction(t).dot(Velocity(t));
      case TermType::kPlaneMove:
        return Normal(t).dot(Velocity(t));
      case TermType::kFast:
        return Velocity(t).norm();
      case TermType::kApproach: {
        const Vector3d towards = Unit(Between(t, 3, 2));
        const double sideways = std::abs(towards.dot(Unit(Between(t, 1, 0))));
        return Velocity(t).dot(towards) * sideways;
      }
      case TermType::kHeight:
        return Place(t, 0).y() - Lowest(t);
      case TermType::kHeightExtent:
        return Highest(t) - Lowest(t);
      case TermType::kGroundExtent:
        return GroundExtent(t);
    }
    return 0;
  }

  // From a frame to the next, of one place or from one to another.
  [[nodiscard]] Vector3d Step(int frame) const {
    const int from = std::max(0, std::min(frame, joints_.frame_count() - 2));
    const int to = std::min(from + 1, joints_.frame_count() - 1);
    if (term_.type == TermType::kFast) return Place(to, 0) - Place(from, 0);
    return Between(to, 2, 3) - Between(from, 2, 3);
  }

  // The mean over a box, the signal reflected at its ends.
  [[nodiscard]] Vector3d Velocity(int t) const {
    if (width_ <= 1) return Step(t) * joints_.rate_hz;
    const int frames = joints_.frame_count();
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < width_; ++k) {
      int at = t + k - ((width_ + 1) / 2 - 1);
      if (at < 0) at = -1 - at;
      if (at >= frames) at = 2 * frames - 1 - at;
      sum += Step(at);
    }
    return sum / width_ * joints_.rate_hz;
  }

  [[nodiscard]] double Lowest(int t) const {
    double low = std::numeric_limits<double>::infinity();
    for (int j = 0; j < kStandardJointCount; ++j) {
      const auto joint = static_cast<StandardJoint>(j);
      if (std::ranges::count(term_.ignored_joints, joint) > 0) continue;
      low = std::min(low, joints_.at(t, joint).y());
    }
    return low;
  }
  [[nodiscard]] double Highest(int t) const {
    double high = -std::numeric_limits<double>::infinity();
    for (int j = 0; j < kStandardJointCount; ++j) high = std::max(high, joints_.at(t, j).y());
    return high;
  }

  [[nodiscard]] double GroundExtent(int t) const {
    std::vector<StandardJoint> chosen = term_.joints;
    for (int j = 0; term_.joints.empty() && j < kStandardJointCount; ++j) {
      chosen.push_back(static_cast<StandardJoint>(j));
    }
    double largest = 0;
    for (const StandardJoint a : chosen) {
      for (const StandardJoint b : chosen) {
        const Vector3d between = joints_.at(t, a) - joints_.at(t, b);
        largest = std::max(largest, between.x() * between.x() + between.z() * between.z());
      }
    }
    return std::sqrt(largest);
  }

  const JointTrajectories& joints_;
  const FeatureTerm& term_;
  int width_;
};

bool Passes(double value, ThresholdTest test, const Threshold& threshold, double unit) {
  switch (test) {
    case ThresholdTest::kAbove:
      return value > threshold.low * unit;
    case ThresholdTest::kAtLeast:
      return value >= threshold.low * unit;
    case ThresholdTest::kBelow:
      return value < threshold.low * unit;
    case ThresholdTest::kAtMost:
      return value <= threshold.low * unit;
    case ThresholdTest::kInside:
      return value >= threshold.low * unit && value <= threshold.high * unit;
  }
  return false;
}

double UnitOf(const JointTrajectories& joints, const FeatureSet& set, const Feature& feature) {
  if (feature.length < 0) return 1;
  double sum = 0;
  for (const auto& [a, b] : set.lengths[static_cast<std::size_t>(feature.length)].segments) {
    sum += (joints.at(0, a) - joints.at(0, b)).norm();
  }
  return sum;
}

std::vector<std::uint64_t> PlainFeatures(const JointTrajectories& joints, const FeatureSet& set,
                                         double rate_hz) {
  const int step = static_cast<int>(set.rate_hz / rate_hz);
  std::vector<std::uint64_t> columns(
      static_cast<std::size_t>((joints.frame_count() + step - 1) / step), 0);
  for (std::size_t row = 0; row < set.features.size(); ++row) {
    const Feature& feature = set.features[row];
    std::vector<PlainTerm> terms;
    terms.reserve(feature.terms.size());
    for (const FeatureTerm& term : feature.terms) terms.emplace_back(joints, term);
    const double unit = UnitOf(joints, set, feature);
    bool state = false;
    for (int t = 0; t < joints.frame_count(); ++t) {
      double value = terms.front().At(t);
      for (std::size_t i = 1; i < terms.size(); ++i) {
        const double other = terms[i].At(t);
        value =
            feature.combination == TermCombination::kSum ? value + other : std::min(value, other);
      }
      state = Passes(value, feature.test, state ? feature.weak : feature.strong, unit);
      if (state && t % step == 0) {
        columns[static_cast<std::size_t>(t / step)] |= std::uint64_t{1} << row;
      }
    }
  }
  return columns;
}

constexpr double kColumnRate = 30;

void CheckThatBothAgree(const FeatureSet& set) {
  if (ExtractFeatures(Joints(), set, kColumnRate).columns ==
      PlainFeatures(Joints(), set, kColumnRate)) {
    return;
  }
  std::fprintf(stderr, "the plain features of the set '%s' are others\n", set.name.c_str());
  std::exit(1);
}

void CountFrames(benchmark::State& state) {
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(Joints().frame_count()),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace
}  // namespace kinebase

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  static std::vector<kinebase::FeatureSet> sets;
  sets.reserve(kinebase::BuiltInFeatureSets().size());
  for (const std::string& name : kinebase::BuiltInFeatureSets()) {
    sets.push_back(kinebase::LoadFeatureSet(name));
  }
  for (const kinebase::FeatureSet& set : sets) {
    kinebase::CheckThatBothAgree(set);
    const auto add = [&](const std::string& contender, auto run) {
      benchmark::RegisterBenchmark(
          (set.name + '/' + contender).c_str(),
          [&set, run](benchmark::State& state) {
            for (auto _ : state) {
              benchmark::DoNotOptimize(run(kinebase::Joints(), set, kinebase::kColumnRate));
            }
            kinebase::CountFrames(state);
          })
          ->Unit(benchmark::kMillisecond);
    };
    add("kinebase", kinebase::ExtractFeatures);
    add("plain", kinebase::PlainFeatures);
  }
  benchmark::RunSpecifiedBenchmarks();
}
