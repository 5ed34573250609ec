// Motion classes as keyed postures. Times in seconds of an average performer; angles in degrees,
// places in leg lengths (pose.h). Not mentioned means as before, between keys on a smooth curve.
#include "synth/motion_classes.h"

namespace kinebase::internal {
namespace {

using enum Body;
using enum Limb;

Setting M(Body channel, double value) { return {ChannelOf(channel), -1, value}; }
Setting L(Limb channel, double value) { return {ChannelOf(channel, Side::kLeft), -1, value}; }
Setting R(Limb channel, double value) { return {ChannelOf(channel, Side::kRight), -1, value}; }
Setting B(Limb channel, double value) {
  return {ChannelOf(channel, Side::kLeft), ChannelOf(channel, Side::kRight), value};
}
const double kRest = RestValue();

}  // namespace

const MotionTable& SquatTable() {
  static const MotionTable table = {
      .core_first_s = 0.1,
      .core_last_s = 2.5,
      .duration_s = 2.6,
      .keys = {
          {0.15,
           {M(kHeight, kRest), M(kForward, kRest), M(kLean, kRest), M(kBend, kRest), M(kNod, kRest),
            B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
          {0.60, {B(kElevation, 74), B(kPlane, 78), B(kArmTwist, 5), B(kElbow, 10)}},
          {1.15,
           {M(kHeight, 0.44), M(kForward, -0.13), M(kLean, 32), M(kBend, 14), M(kNod, -22),
            B(kElevation, 132), B(kPlane, 80), B(kElbow, 6)}},
          {1.35,
           {M(kHeight, 0.44), M(kForward, -0.13), M(kLean, 32), M(kBend, 14), M(kNod, -22),
            B(kElevation, 132), B(kPlane, 80), B(kElbow, 6)}},
          {2.40,
           {M(kHeight, kRest), M(kForward, kRest), M(kLean, kRest), M(kBend, kRest), M(kNod, kRest),
            B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
      }};
  return table;
}

const MotionTable& ElbowToKneeTable() {
  static const MotionTable table =
      {.core_first_s = 1.0,
       .core_last_s = 4.2,
       .duration_s = 5.2,
       .keys =
           {
               // Hands behind the head.
               {0.10,
                {B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
               {0.50, {B(kElevation, 88), B(kPlane, 45), B(kArmTwist, -45), B(kElbow, 118)}},
               {0.95,
                {B(kElevation, 138), B(kPlane, 13), B(kArmTwist, -95), B(kElbow, 146),
                 B(kWrist, 10), M(kNod, 5)}},
               {1.05,
                {M(kSide, kRest), R(kFree, 0), R(kHipFlexion, -8), R(kHipAbduction, 0),
                 R(kKnee, 20), R(kAnkle, 5), M(kBend, kRest), M(kTwist, 0), M(kTurn, 0),
                 M(kSideBend, 0), M(kLean, kRest), B(kElevation, 138), B(kPlane, 13),
                 B(kArmTwist, -95)}},
               {1.30, {M(kSide, 0.10), R(kFree, 0), R(kFootLift, 0)}},
               {1.45,
                {R(kFree, 1), R(kFootLift, 0.10), R(kHipFlexion, 35), R(kKnee, 60), R(kAnkle, 0)}},
               // Left elbow to right knee.
               {1.85,
                {M(kSide, 0.10), R(kFree, 1), R(kHipFlexion, 106), R(kHipAbduction, -7),
                 R(kHipRotation, 5), R(kKnee, 110), R(kAnkle, 20), M(kBend, 62), M(kTwist, -50),
                 M(kTurn, -12), M(kSideBend, -3), M(kLean, 0), M(kNod, 12), L(kElevation, 78),
                 L(kPlane, 70), L(kArmTwist, -3)}},
               {2.25,
                {R(kFree, 1), R(kFootLift, 0.10), R(kHipFlexion, 35), R(kKnee, 60), R(kAnkle, 0)}},
               {2.40, {M(kSide, 0.08), R(kFree, 0), R(kFootLift, 0)}},
               {2.55,
                {M(kSide, 0),        R(kFree, 0),         R(kHipFlexion, -8), R(kHipAbduction, 0),
                 R(kKnee, 20),       R(kAnkle, 5),        M(kBend, kRest),    M(kTwist, 0),
                 M(kTurn, 0),        M(kSideBend, 0),     M(kLean, kRest),    M(kNod, 5),
                 L(kElevation, 138), L(kPlane, 13),       L(kArmTwist, -95),  L(kFree, 0),
                 L(kHipFlexion, -8), L(kHipAbduction, 0), L(kKnee, 20),       L(kAnkle, 5),
                 R(kElevation, 138), R(kPlane, 13),       R(kArmTwist, -95)}},
               {2.80, {M(kSide, -0.10), L(kFree, 0), L(kFootLift, 0)}},
               {2.95,
                {L(kFree, 1), L(kFootLift, 0.10), L(kHipFlexion, 35), L(kKnee, 60), L(kAnkle, 0)}},
               // Right elbow to left knee.
               {3.35,
                {M(kSide, -0.10), L(kFree, 1), L(kHipFlexion, 106), L(kHipAbduction, -7),
                 L(kHipRotation, 5), L(kKnee, 110), L(kAnkle, 20), M(kBend, 62), M(kTwist, 50),
                 M(kTurn, 12), M(kSideBend, 3), M(kLean, 0), M(kNod, 12), R(kElevation, 78),
                 R(kPlane, 70), R(kArmTwist, -3)}},
               {3.75,
                {L(kFree, 1), L(kFootLift, 0.10), L(kHipFlexion, 35), L(kKnee, 60), L(kAnkle, 0)}},
               {3.90, {M(kSide, -0.08), L(kFree, 0), L(kFootLift, 0)}},
               {4.10,
                {M(kSide, kRest), L(kFree, 0), L(kHipFlexion, -8), L(kHipAbduction, 0),
                 L(kKnee, 20), L(kAnkle, 5), M(kBend, kRest), M(kTwist, 0), M(kTurn, 0),
                 M(kSideBend, 0), M(kLean, kRest), M(kNod, 5), R(kElevation, 138), R(kPlane, 13),
                 R(kArmTwist, -95)}},
               // Hands down.
               {4.25,
                {B(kElevation, 138), B(kPlane, 13), B(kArmTwist, -95), B(kElbow, 146),
                 B(kWrist, 10)}},
               {4.65, {B(kElevation, 88), B(kPlane, 45), B(kArmTwist, -45), B(kElbow, 118)}},
               {5.10,
                {B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
           },
       .amplitude_share = 0.3};
  return table;
}

const MotionTable& KickFrontTable() {
  static const MotionTable table = {
      .core_first_s = 0.1,
      .core_last_s = 1.9,
      .duration_s = 2.0,
      .keys = {
          {0.10, {M(kSide, kRest)}},
          {0.38, {R(kHipFlexion, 0), R(kKnee, 42), R(kAnkle, -6)}},
          {0.40,
           {M(kSide, 0.10), R(kFree, 0), R(kFootLift, 0), M(kLean, kRest), L(kElevation, 30),
            L(kPlane, 70), R(kElevation, -10), R(kPlane, 110), B(kElbow, 60), B(kArmTwist, 5)}},
          // Swing back a little, then the knee comes up and the shank follows.
          {0.55,
           {R(kFree, 1), R(kFootLift, 0.10), R(kHipFlexion, -16), R(kKnee, 56), R(kAnkle, 6),
            M(kLean, 6)}},
          {0.78, {R(kHipFlexion, 62), R(kKnee, 82), R(kAnkle, 22), M(kLean, -4)}},
          {0.95,
           {R(kHipFlexion, 84), R(kKnee, 12), R(kAnkle, 25), M(kLean, -14), M(kBend, 10),
            M(kForward, 0.06), M(kTwist, 15), M(kTurn, 10), L(kElevation, 20), L(kPlane, 20),
            R(kElevation, 40), R(kPlane, 50), B(kElbow, 75), M(kHeight, 0.985)}},
          {1.02, {R(kHipFlexion, 84), R(kKnee, 12)}},
          {1.22, {R(kHipFlexion, 55), R(kKnee, 75), R(kAnkle, 20)}},
          {1.45,
           {M(kSide, 0.10), R(kFree, 1), R(kFootLift, 0.10), R(kHipFlexion, 10), R(kKnee, 44),
            R(kAnkle, 0), M(kLean, 2), M(kForward, kRest), M(kTwist, 0), M(kTurn, 0)}},
          {1.62,
           {M(kSide, 0.08), R(kFree, 0), R(kFootLift, 0), R(kHipFlexion, 6), R(kKnee, 42),
            R(kAnkle, -6), M(kHeight, kRest)}},
          {1.90,
           {M(kSide, kRest), M(kLean, kRest), M(kBend, kRest), B(kElevation, kRest),
            B(kPlane, kRest), B(kElbow, kRest), B(kArmTwist, kRest)}},
      }};
  return table;
}

const MotionTable& RotateArmTable() {
  // Down, back, up, over to the front and down: the elevation goes through a whole turn.
  static const MotionTable table = {
      .core_first_s = 0.05,
      .core_last_s = 1.75,
      .duration_s = 1.85,
      .keys =
          {
              {0.10, {R(kElevation, kRest), R(kPlane, kRest), R(kElbow, kRest), M(kTwist, 0)}},
              {0.40,
               {R(kElevation, -35), R(kPlane, 112), R(kArmTwist, 10), R(kElbow, 6), M(kTwist, -6)}},
              {0.70,
               {R(kElevation, -105), R(kPlane, 128), R(kArmTwist, 25), M(kTwist, -14),
                M(kBend, -4)}},
              {0.95, {R(kElevation, -178), R(kPlane, 106), R(kElbow, 4), M(kTwist, -2)}},
              {1.20,
               {R(kElevation, -255), R(kPlane, 84), R(kArmTwist, 5), M(kTwist, 6), M(kBend, 4)}},
              {1.50, {R(kElevation, -325), R(kPlane, 75), M(kTwist, 2)}},
          },
      .amplitude_share = 0};
  return table;
}

const MotionTable& ThrowOverarmTable() {
  static const MotionTable table = {
      .core_first_s = 0.1,
      .core_last_s = 1.6,
      .duration_s = 2.3,
      .keys = {
          {0.10,
           {M(kForward, kRest), M(kSide, kRest), M(kTwist, 0), M(kTurn, 0), M(kLean, kRest),
            B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
          // Draw back over the right foot; the left arm points where the ball is to go.
          {0.30,
           {M(kSide, -0.07), L(kFootLift, 0), R(kElevation, 55), R(kPlane, 15), R(kElbow, 95),
            R(kArmTwist, -20)}},
          {0.34, {L(kFootForward, kRest)}},
          {0.45, {L(kFootLift, 0.09)}},
          {0.65, {L(kFootForward, 0.42)}},
          {0.60,
           {M(kForward, 0.02), M(kTwist, -38), M(kTurn, -25), M(kLean, -4), M(kBend, -10),
            R(kElevation, 98), R(kPlane, -12), R(kArmTwist, -80), R(kElbow, 95), R(kGrip, 55),
            L(kElevation, 82), L(kPlane, 62), L(kElbow, 18), R(kFootPitch, 0), M(kHeadTurn, 45)}},
          {0.70, {L(kFootLift, 0)}},
          {0.80,
           {M(kForward, 0.20), M(kSide, -0.01), M(kTwist, -18), M(kTurn, -6), R(kElevation, 108),
            R(kPlane, 6), R(kArmTwist, -88), R(kElbow, 100), M(kHeadTurn, 20)}},
          // Release in front of the head.
          {0.93,
           {M(kForward, 0.27), M(kTwist, 18), M(kTurn, 10), M(kLean, 6), M(kBend, 12),
            R(kElevation, 128), R(kPlane, 62), R(kArmTwist, -30), R(kElbow, 28), R(kGrip, 10),
            L(kElevation, 35), L(kPlane, 40), L(kElbow, 70), R(kFootPitch, 22), M(kHeadTurn, -15)}},
          {1.12,
           {M(kForward, 0.32), M(kTwist, 34), M(kTurn, 16), M(kLean, 14), M(kBend, 30),
            R(kElevation, 48), R(kPlane, 108), R(kArmTwist, 15), R(kElbow, 25), L(kElevation, 12),
            L(kPlane, -20), R(kFootPitch, 32), M(kHeadTurn, -25)}},
          {1.25,
           {M(kForward, 0.32), M(kTwist, 34), M(kTurn, 16), R(kElevation, 42), R(kFootPitch, 32),
            L(kFootForward, 0.42)}},
          // Step back.
          {1.60,
           {M(kForward, 0.14), M(kTwist, 0), M(kTurn, 0), M(kLean, kRest), M(kBend, kRest),
            R(kElevation, kRest), R(kPlane, kRest), R(kArmTwist, kRest), R(kFootPitch, 0),
            M(kSide, -0.05), L(kFootLift, 0), M(kHeadTurn, 0)}},
          {1.64, {L(kFootForward, 0.42)}},
          {1.80, {L(kFootLift, 0.07)}},
          {1.96, {L(kFootForward, kRest)}},
          {2.00, {M(kForward, kRest), L(kFootLift, 0), M(kSide, -0.05), B(kElbow, kRest)}},
      }};
  return table;
}

const MotionTable& GrabHighTable() {
  static const MotionTable table = {
      .core_first_s = 0.1,
      .core_last_s = 2.2,
      .duration_s = 2.4,
      .keys = {
          {0.15,
           {R(kElevation, kRest), R(kPlane, kRest), R(kArmTwist, kRest), R(kElbow, kRest),
            M(kNod, kRest), M(kHeight, kRest), B(kFootPitch, 0)}},
          {0.50,
           {R(kElevation, 70), R(kPlane, 72), R(kElbow, 62), R(kArmTwist, 0), M(kNod, -14),
            B(kFootPitch, 4)}},
          // On the toes, right side stretched.
          {0.95,
           {R(kElevation, 166), R(kPlane, 80), R(kElbow, 8), R(kGrip, 5), R(kShrug, 8),
            M(kSideBend, 10), M(kNod, -26), M(kHeight, 1.065), M(kForward, 0.075),
            B(kFootPitch, 20), M(kTwist, 6), R(kWrist, -15)}},
          {1.12,
           {R(kElevation, 166), R(kPlane, 80), R(kElbow, 8), R(kGrip, 5), R(kShrug, 8),
            M(kSideBend, 10), M(kNod, -26), M(kHeight, 1.065), B(kFootPitch, 20), M(kTwist, 6),
            R(kWrist, -15)}},
          {1.25, {R(kGrip, 70), R(kElevation, 158), R(kElbow, 14)}},
          // Takes it down in front of the body.
          {1.62,
           {R(kElevation, 42), R(kPlane, 75), R(kElbow, 98), R(kArmTwist, 15), R(kShrug, 0),
            M(kSideBend, 0), M(kNod, 14), M(kHeight, kRest), M(kForward, kRest), B(kFootPitch, 0),
            M(kTwist, 0), R(kWrist, 0), R(kGrip, 70)}},
          {1.80, {R(kElevation, 38), R(kElbow, 98), R(kGrip, 70)}},
          {2.30,
           {R(kElevation, kRest), R(kPlane, kRest), R(kElbow, kRest), R(kArmTwist, kRest),
            M(kNod, kRest)}},
      }};
  return table;
}

const MotionTable& ClapAboveHeadTable() {
  static const MotionTable table = {
      .core_first_s = 0.05,
      .core_last_s = 1.5,
      .duration_s = 1.6,
      .keys =
          {
              {0.10,
               {B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest)}},
              {0.42, {B(kElevation, 90), B(kPlane, 8), B(kArmTwist, -40), B(kElbow, 12)}},
              {0.75,
               {B(kElevation, 168), B(kPlane, 32), B(kArmTwist, -20), B(kElbow, 54), M(kNod, -8),
                B(kGrip, 0)}},
              {1.08, {B(kElevation, 90), B(kPlane, 8), B(kArmTwist, -40), B(kElbow, 12)}},
              {1.45,
               {B(kElevation, kRest), B(kPlane, kRest), B(kArmTwist, kRest), B(kElbow, kRest),
                M(kNod, kRest)}},
          },
      .amplitude_share = 0.15};
  return table;
}

const MotionTable& DepositFloorTable() {
  static const MotionTable table = {
      .core_first_s = 0.1,
      .core_last_s = 2.7,
      .duration_s = 2.8,
      .keys = {
          {0.15,
           {M(kHeight, kRest), M(kLean, kRest), M(kBend, kRest), M(kForward, kRest), M(kNod, kRest),
            R(kElevation, kRest), R(kPlane, kRest), R(kElbow, kRest), R(kGrip, kRest)}},
          {0.45, {R(kElevation, 35), R(kPlane, 75), R(kElbow, 75), R(kGrip, 60)}},
          {1.25,
           {M(kHeight, 0.70), M(kLean, 48), M(kBend, 32), M(kForward, -0.12), M(kNod, 5),
            M(kTwist, 8), M(kSideBend, -4), R(kElevation, 92), R(kPlane, 82), R(kElbow, 8),
            L(kElevation, 35), L(kPlane, 60), L(kElbow, 50), R(kGrip, 60)}},
          {1.45,
           {M(kHeight, 0.70), M(kLean, 48), M(kBend, 32), M(kForward, -0.12), M(kNod, 5),
            M(kTwist, 8), M(kSideBend, -4), R(kElevation, 92), R(kPlane, 82), R(kElbow, 8),
            L(kElevation, 35), R(kGrip, 10)}},
          {2.45,
           {M(kHeight, kRest), M(kLean, kRest), M(kBend, kRest), M(kForward, kRest), M(kNod, kRest),
            M(kTwist, 0), M(kSideBend, 0), L(kElevation, kRest), L(kPlane, kRest),
            L(kElbow, kRest)}},
          {2.65, {R(kElevation, kRest), R(kPlane, kRest), R(kElbow, kRest)}},
      }};
  return table;
}

const MotionTable& PunchFrontTable() {
  static const MotionTable table = {
      .core_first_s = 0.35,
      .core_last_s = 1.25,
      .duration_s = 1.8,
      .keys = {
          // Guard: fists before the chin, left foot ahead.
          {0.10, {M(kSide, kRest), L(kFootLift, 0)}},
          {0.13, {L(kFootForward, kRest)}},
          {0.22, {L(kFootLift, 0.06), M(kSide, -0.04)}},
          {0.33, {L(kFootForward, 0.26)}},
          {0.36,
           {L(kFootLift, 0), M(kForward, 0.12), M(kHeight, 0.94), M(kSide, 0), B(kElevation, 42),
            B(kPlane, 70), B(kArmTwist, 15), B(kElbow, 128), B(kGrip, 80), M(kTwist, -14),
            M(kTurn, -12), R(kFootPitch, 0)}},
          {0.55,
           {R(kElevation, 34), R(kPlane, 60), R(kElbow, 132), M(kTwist, -24), M(kTurn, -16),
            M(kForward, 0.12), M(kHeadTurn, 28)}},
          {0.75,
           {R(kElevation, 102), R(kPlane, 56), R(kElbow, 8), R(kArmTwist, 45), R(kReach, 14),
            M(kTwist, 26), M(kTurn, 16), M(kForward, 0.17), M(kLean, 8), R(kFootPitch, 18),
            M(kHeadTurn, -30), L(kElevation, 42), L(kElbow, 130)}},
          {0.82, {R(kElevation, 102), R(kElbow, 8), R(kReach, 14), M(kTwist, 26)}},
          {1.10,
           {R(kElevation, 42), R(kPlane, 70), R(kElbow, 128), R(kArmTwist, 15), R(kReach, 0),
            M(kTwist, -14), M(kTurn, -12), M(kForward, 0.12), M(kLean, kRest), R(kFootPitch, 0),
            M(kHeadTurn, 16)}},
          {1.25,
           {B(kElevation, 42), B(kPlane, 70), B(kArmTwist, 15), B(kElbow, 128), L(kFootLift, 0),
            M(kHeight, 0.94), M(kTwist, -14), M(kTurn, -12), M(kSide, 0)}},
          {1.28, {L(kFootForward, 0.26)}},
          {1.45, {L(kFootLift, 0.05), M(kSide, -0.04)}},
          {1.59, {L(kFootForward, kRest)}},
          {1.62, {L(kFootLift, 0)}},
      }};
  return table;
}

}  // namespace kinebase::internal
