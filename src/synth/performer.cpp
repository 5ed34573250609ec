#include "synth/performer.h"

#include <cmath>
#include <numbers>

namespace kinebase::internal {
namespace {

constexpr int kWavesAChannel = 4;

// How much a channel takes part in the noise; the feet stay where they stand.
double NoiseShare(int channel) {
  if (channel < kBodyCount) {
    switch (static_cast<Body>(channel)) {
      case Body::kSide:
      case Body::kForward:
        return 0.002;  // Leg lengths a degree of noise.
      case Body::kHeight:
        return 0;
      case Body::kLean:
      case Body::kTilt:
        return 0.5;
      default:
        return 1;
    }
  }
  switch (static_cast<Limb>((channel - kBodyCount) % kLimbCount)) {
    case Limb::kShrug:
    case Limb::kReach:
      return 0.6;
    case Limb::kElevation:
    case Limb::kElbow:
      return 1.5;
    case Limb::kArmTwist:
    case Limb::kForearm:
      return 2;
    case Limb::kPlane:
    case Limb::kWrist:
    case Limb::kGrip:
    case Limb::kHipFlexion:
    case Limb::kHipAbduction:
    case Limb::kKnee:
      return 1;
    default:
      return 0;
  }
}

}  // namespace

Tremor::Tremor(Random random, double noise_deg) {
  for (int channel = 0; channel < kChannelCount; ++channel) {
    const double height = noise_deg * NoiseShare(channel) * std::sqrt(2.0 / kWavesAChannel);
    for (int i = 0; i < kWavesAChannel; ++i) {
      const double frequency_hz = random.Uniform(0.2, 1.8);
      const double phase = random.Uniform(0, 2 * std::numbers::pi);
      if (height == 0) continue;
      waves_.push_back({channel, height, 2 * std::numbers::pi * frequency_hz, phase});
    }
  }
}

void Tremor::AddTo(Pose& pose, double time_s) const {
  for (const Wave& wave : waves_) {
    pose.values[wave.channel] += wave.height * std::sin(wave.radians_per_s * time_s + wave.phase);
  }
}

Performer::Performer(const SyntheticActor& actor, std::uint64_t seed)
    : actor_(actor), seed_(seed), figure_(MakeSyntheticSkeleton(actor)), rest_(MakeRest()) {}

Random Performer::Stream(std::string_view purpose, std::uint64_t number) const {
  return Random({seed_, HashText(actor_.name), HashText(purpose), number});
}

// Everyone stands a little differently; the preferred foot is a little ahead.
Pose Performer::MakeRest() const {
  Random random = Stream("rest", 0);
  Pose rest;
  rest[Body::kHeight] = 0.994;
  rest[Body::kForward] = random.Around(0.045, 0.008);
  rest[Body::kLean] = random.Around(1, 1.5);
  rest[Body::kBend] = random.Around(4, 2);
  rest[Body::kNod] = random.Around(2, 2.5);
  const double half_width = figure_.hip_half_width() * random.Around(1.25, 0.1);
  const double toes_out = random.Around(9, 3);
  const double elevation = random.Around(9, 1.5);
  const double plane = random.Around(28, 6);
  const double twist = random.Around(22, 6);
  const double elbow = random.Around(18, 4);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    rest.at(Limb::kElevation, side) = elevation + random.Around(0, 0.7);
    rest.at(Limb::kPlane, side) = plane;
    rest.at(Limb::kArmTwist, side) = twist;
    rest.at(Limb::kElbow, side) = elbow + random.Around(0, 1.5);
    rest.at(Limb::kWrist, side) = 8;
    rest.at(Limb::kGrip, side) = 18;
    rest.at(Limb::kFootSide, side) = half_width;
    rest.at(Limb::kFootTurn, side) = toes_out;
    rest.at(Limb::kKnee, side) = 10;
  }
  const Side preferred = actor_.left_handed ? Side::kLeft : Side::kRight;
  const double sign = actor_.left_handed ? 1 : -1;
  rest.at(Limb::kFootForward, preferred) = 0.03;
  rest[Body::kSide] = -sign * 0.012;  // The weight is more on the other leg.
  rest[Body::kHeadTilt] = sign * 1.5;
  return rest;
}

Manner Performer::MannerOf(std::string_view class_name, Random random) const {
  Random own = Stream(class_name, 0);
  Manner manner{.rest = rest_,
                .leg_length_cm = figure_.leg_length_cm(),
                .pace = own.Around(1, 0.03) * random.Around(1, 0.035) / actor_.tempo,
                .amplitude = actor_.amplitude * random.Around(1, 0.015),
                .angle_amplitudes = {},
                .rhythm_shift_s = random.Uniform(0, 0.045),
                .rhythm_phase = random.Uniform(0, 2 * std::numbers::pi)};
  for (double& amplitude : manner.angle_amplitudes) {
    amplitude = actor_.amplitude * own.Around(1, 0.025) * random.Around(1, 0.015);
  }
  return manner;
}

}  // namespace kinebase::internal
