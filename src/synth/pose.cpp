#include "synth/pose.h"

namespace kinebase::internal {
namespace {

bool IsBody(int channel) { return channel < kBodyCount; }

Limb LimbOf(int channel) { return static_cast<Limb>((channel - kBodyCount) % kLimbCount); }

}  // namespace

bool IsPlace(int channel) {
  if (IsBody(channel)) return channel <= ChannelOf(Body::kForward);
  const Limb limb = LimbOf(channel);
  return limb == Limb::kFootSide || limb == Limb::kFootForward || limb == Limb::kFootLift;
}

bool IsBlend(int channel) { return !IsBody(channel) && LimbOf(channel) == Limb::kFree; }

int MirroredChannel(int channel) {
  if (IsBody(channel)) return channel;
  const bool is_left = channel < kBodyCount + kLimbCount;
  return is_left ? channel + kLimbCount : channel - kLimbCount;
}

double MirroredSign(int channel) {
  if (!IsBody(channel)) return 1;
  switch (static_cast<Body>(channel)) {
    case Body::kSide:
    case Body::kTilt:
    case Body::kTurn:
    case Body::kSideBend:
    case Body::kTwist:
    case Body::kHeadTilt:
    case Body::kHeadTurn:
      return -1;
    default:
      return 1;
  }
}

}  // namespace kinebase::internal
