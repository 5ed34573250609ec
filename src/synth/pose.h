// A posture in terms of anatomy: what the tables of motion classes speak of.
//
// Angles are in degrees. Places are in leg lengths (thigh plus shank) in the performer's own floor
// frame: x to the left, y up, z ahead, the origin between the feet of the one who stands there.
#pragma once

#include <array>

namespace kinebase::internal {

// Pelvis, trunk and head. Turns, tilts and twists are positive to the left.
enum class Body {
  kSide,      // The middle of the hips, to the left.
  kHeight,    // The middle of the hips above an ankle of a foot that stands flat.
  kForward,   // The middle of the hips, ahead.
  kLean,      // Pelvis forwards.
  kTilt,      // Pelvis sideways.
  kTurn,      // Pelvis about the vertical.
  kBend,      // Trunk forwards relative to the pelvis.
  kSideBend,  // Trunk sideways.
  kTwist,     // Trunk about its own axis.
  kNod,       // Head forwards.
  kHeadTilt,
  kHeadTurn,
};
inline constexpr int kBodyCount = 12;

// One arm and one leg.
//
// The upper arm is swung by kElevation out of hanging (0), over horizontal (90) to upright (180),
// in the vertical plane that kPlane gives: 0 = sideways, 90 = ahead. With kArmTwist 0 a hanging
// arm's elbow bends forwards; positive twists inwards.
//
// A leg that stands or swings is given by its foot. A leg with kFree = 1 is given by its angles
// instead; in between the two postures are blended.
enum class Limb {
  kShrug,
  kReach,  // Shoulder forwards.
  kElevation,
  kPlane,
  kArmTwist,
  kElbow,
  kForearm,  // Forearm about its own axis.
  kWrist,
  kGrip,
  kFootSide,     // Ankle, outwards.
  kFootForward,  // Ankle, ahead.
  kFootTurn,     // Toes outwards.
  kFootLift,     // Ball of the foot above the floor.
  kFootPitch,    // Positive: heel up, about the ball; negative: toes up, about the heel.
  kFree,
  kHipFlexion,
  kHipAbduction,
  kHipRotation,  // Outwards.
  kKnee,
  kAnkle,  // Positive: toes down.
};
inline constexpr int kLimbCount = 20;

enum class Side { kLeft, kRight };

inline constexpr int kChannelCount = kBodyCount + 2 * kLimbCount;

[[nodiscard]] constexpr Side Opposite(Side side) {
  return side == Side::kLeft ? Side::kRight : Side::kLeft;
}
[[nodiscard]] constexpr int ChannelOf(Body channel) { return static_cast<int>(channel); }
[[nodiscard]] constexpr int ChannelOf(Limb channel, Side side) {
  return kBodyCount + static_cast<int>(side) * kLimbCount + static_cast<int>(channel);
}

struct Pose {
  std::array<double, kChannelCount> values{};

  [[nodiscard]] double operator[](Body channel) const { return values[ChannelOf(channel)]; }
  [[nodiscard]] double& operator[](Body channel) { return values[ChannelOf(channel)]; }
  [[nodiscard]] double at(Limb channel, Side side) const {
    return values[ChannelOf(channel, side)];
  }
  [[nodiscard]] double& at(Limb channel, Side side) { return values[ChannelOf(channel, side)]; }
};

// The rest are angles, but for kFree.
[[nodiscard]] bool IsPlace(int channel);
[[nodiscard]] bool IsBlend(int channel);

// The channel and sign that a channel has in the mirrored posture.
[[nodiscard]] int MirroredChannel(int channel);
[[nodiscard]] double MirroredSign(int channel);

}  // namespace kinebase::internal
