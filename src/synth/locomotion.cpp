// Motions that follow a rule: steps and jumps.
#include <array>
#include <cmath>
#include <numbers>

#include "synth/motion_classes.h"

namespace kinebase::internal {
namespace {

using enum Body;
using enum Limb;

constexpr double kGravity_cm_s2 = 981;
constexpr int kCoreSteps = 4;

// What tells walking from jogging. Times are fractions of the time from one step to the next,
// lengths are in leg lengths, angles in degrees.
struct Gait {
  double step_s;
  double step_length;
  double contact;       // How long a foot stays down.
  double strike_ahead;  // Foot before the hips as it lands.
  double heel_off;      // After landing.
  double strike_pitch;
  double push_off_pitch;
  double swing_pitch;  // Soon after leaving the floor.
  double swing_lift;
  double swing_lift_at;  // Fraction of the swing.
  double sway;           // Pelvis towards the standing foot.
  double lean;
  double pelvis_turn;
  double arm_forward, arm_back, elbow_forward, elbow_back;
  std::array<double, 4> height;  // At landing, a third of a step later, two thirds, and just
                                 // before the next.
};

constexpr Gait kWalk = {.step_s = 0.55,
                        .step_length = 0.74,
                        .contact = 1.2,
                        .strike_ahead = 0.37,
                        .heel_off = 0.70,
                        .strike_pitch = -18,
                        .push_off_pitch = 36,
                        .swing_pitch = 44,
                        .swing_lift = 0.055,
                        .swing_lift_at = 0.40,
                        .sway = 0.025,
                        .lean = 1,
                        .pelvis_turn = 5,
                        .arm_forward = 24,
                        .arm_back = -20,
                        .elbow_forward = 32,
                        .elbow_back = 14,
                        .height = {0.99, 0.995, 0.995, 0.99}};
constexpr Gait kJog = {.step_s = 0.36,
                       .step_length = 0.98,
                       .contact = 0.72,
                       .strike_ahead = 0.27,
                       .heel_off = 0.34,
                       .strike_pitch = -6,
                       .push_off_pitch = 40,
                       .swing_pitch = 78,
                       .swing_lift = 0.30,
                       .swing_lift_at = 0.38,
                       .sway = 0.012,
                       .lean = 9,
                       .pelvis_turn = 7,
                       .arm_forward = 34,
                       .arm_back = -42,
                       .elbow_forward = 98,
                       .elbow_back = 82,
                       .height = {0.965, 0.925, 0.975, 1.005}};

// Steps alternate; step 0 is the left foot's, out of standing. Then four steps are the class, and
// a last one closes the feet.
class GaitBuilder {
 public:
  GaitBuilder(const Gait& gait, const Manner& manner)
      : gait_(gait),
        manner_(manner),
        step_s_(gait.step_s * manner.pace),
        step_length_(gait.step_length * manner.amplitude),
        first_strike_s_(1.1 * step_s_ + 0.1),
        timeline_(manner.rest) {}

  Timeline Build() {
    for (int step = 0; step <= kClosing; ++step) {
      SetFoot(step);
      SetTrunk(step);
    }
    const double end_s = StrikeTime(kClosing) + 0.45 * manner_.pace;
    timeline_.Set(end_s - 0.1, kForward, FootPlace(kClosing) + manner_.rest[kForward]);
    timeline_.core_first_s = StrikeTime(0) + 0.05 * step_s_;
    timeline_.core_last_s = StrikeTime(kCoreSteps) + 0.05 * step_s_;
    timeline_.end_forward = FootPlace(kClosing);
    FinishForward(end_s);
    return timeline_;
  }

 private:
  static constexpr int kClosing = kCoreSteps + 1;

  static Side FootOf(int step) { return step % 2 == 0 ? Side::kLeft : Side::kRight; }
  [[nodiscard]] double StrikeTime(int step) const { return first_strike_s_ + step * step_s_; }
  [[nodiscard]] double FootPlace(int step) const {
    if (step < 0) return 0;
    const int whole = step == kClosing ? kCoreSteps : step;
    return (whole + 0.55) * step_length_;
  }

  void SetFoot(int step) {
    const Side side = FootOf(step);
    const double rest = manner_.rest.at(kFootForward, side);
    const double strike_s = StrikeTime(step);
    const bool was_standing = step < 2;
    const double before_s = was_standing ? 0.05 : StrikeTime(step - 2);
    double off_s = before_s + gait_.contact * step_s_;
    if (step == 0) off_s = strike_s - 0.8 * step_s_;
    if (step == 1) off_s = StrikeTime(0) + (gait_.contact - 1) * step_s_;
    const double swing_s = strike_s - off_s;
    // The foot is off the floor before it moves ahead, and there before it is down.
    timeline_.Set(off_s + 0.06 * swing_s, kFootForward, side, rest + FootPlace(step - 2));
    timeline_.Set(strike_s - 0.05 * swing_s, kFootForward, side, rest + FootPlace(step));

    const double share = step == 0 || step == kClosing ? 0.55 : 1;  // Of a whole step.
    timeline_.Set(off_s - (gait_.contact - gait_.heel_off) * step_s_, kFootPitch, side, 0);
    timeline_.Set(off_s, kFootPitch, side, share * gait_.push_off_pitch);
    timeline_.Set(off_s + 0.2 * swing_s, kFootPitch, side, share * gait_.swing_pitch);
    timeline_.Set(off_s + 0.62 * swing_s, kFootPitch, side, share * 8);
    const double landing = step == kClosing ? 0 : gait_.strike_pitch;
    timeline_.Set(strike_s - 0.1 * swing_s, kFootPitch, side, landing);
    timeline_.Set(strike_s, kFootPitch, side, landing);
    timeline_.Set(strike_s + 0.16 * step_s_, kFootPitch, side, 0);

    timeline_.Set(off_s, kFootLift, side, 0);
    timeline_.Set(off_s + gait_.swing_lift_at * swing_s, kFootLift, side, share * gait_.swing_lift);
    timeline_.Set(off_s + 0.75 * swing_s, kFootLift, side, 0.2 * share * gait_.swing_lift + 0.01);
    timeline_.Set(strike_s, kFootLift, side, 0);
  }

  void SetTrunk(int step) {
    const Side side = FootOf(step);
    const double sign = side == Side::kLeft ? 1 : -1;
    const double strike_s = StrikeTime(step);
    const double to_left = gait_.sway * sign;
    timeline_.Set(strike_s + 0.45 * step_s_, kSide, step == kClosing ? 0 : to_left);
    if (step == 0) timeline_.Set(strike_s - 0.55 * step_s_, kSide, -to_left - 0.02 * sign);
    if (step < kClosing) {
      const double at_strike =
          step == 0 ? 0.5 * FootPlace(0)
                    : FootPlace(step) - gait_.strike_ahead * step_length_ / gait_.step_length;
      timeline_.Set(strike_s, kForward, at_strike);
      SetHeight(strike_s);
      SetArms(side, strike_s);
      timeline_.Set(strike_s, kTurn, -sign * gait_.pelvis_turn);
      timeline_.Set(strike_s, kTwist, sign * 2 * gait_.pelvis_turn);
      timeline_.Set(strike_s, kLean, gait_.lean + manner_.rest[kLean]);
    }
  }

  void SetHeight(double strike_s) {
    constexpr std::array<double, 4> kMoments = {0, 0.33, 0.66, 0.88};
    for (std::size_t i = 0; i < 4; ++i) {
      timeline_.Set(strike_s + kMoments[i] * step_s_, kHeight, gait_.height[i]);
    }
  }

  // As a foot lands, the arm of the other side is in front.
  void SetArms(Side landing, double strike_s) {
    const auto set = [&](Limb channel, Side side, double value) {
      timeline_.Set(strike_s, channel, side, manner_.Value(ChannelOf(channel, side), value));
    };
    set(kElevation, Opposite(landing), gait_.arm_forward);
    set(kPlane, Opposite(landing), 70);
    set(kArmTwist, Opposite(landing), 12);
    set(kArmTwist, landing, 12);
    set(kElbow, Opposite(landing), gait_.elbow_forward);
    set(kElevation, landing, gait_.arm_back);
    set(kPlane, landing, 118);
    set(kElbow, landing, gait_.elbow_back);
  }

  // All but the way ahead ends as it began.
  void FinishForward(double end_s) {
    const double goal = timeline_.end_forward;
    timeline_.Set(end_s, kForward, goal + manner_.rest[kForward]);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      timeline_.Set(end_s, kFootForward, side, goal + manner_.rest.at(kFootForward, side));
    }
    timeline_.Finish(end_s);
  }

  const Gait& gait_;
  const Manner& manner_;
  double step_s_;
  double step_length_;
  double first_strike_s_;
  Timeline timeline_;
};

// From `off_s` on both feet and the pelvis fly for `flight_s`, up and down under gravity.
void SetFlight(Timeline& timeline, const Manner& manner, double off_s, double flight_s,
               double height_off, double height_down) {
  constexpr int kPieces = 8;
  for (int i = 0; i <= kPieces; ++i) {
    const double u = static_cast<double>(i) / kPieces;
    const double t = u * flight_s;
    const double rise = 0.5 * kGravity_cm_s2 * t * (flight_s - t) / manner.leg_length_cm;
    timeline.Set(off_s + t, kHeight, height_off + u * (height_down - height_off) + rise);
    timeline.SetBoth(off_s + t, kFootLift, rise);
  }
}

double Value(const Manner& manner, Limb channel, double usual) {
  return manner.Value(ChannelOf(channel, Side::kLeft), usual);
}

}  // namespace

Timeline BuildWalk(const Manner& manner) { return GaitBuilder(kWalk, manner).Build(); }

Timeline BuildJog(const Manner& manner) { return GaitBuilder(kJog, manner).Build(); }

Timeline BuildHop(const Manner& manner) {
  Timeline timeline(manner.rest);
  const double pace = manner.pace;
  const double flight_s = 0.34 * std::sqrt(manner.amplitude);
  const double distance = 0.42 * manner.amplitude;
  const double crouch_s = 0.48 * pace;
  const double off_s = crouch_s + 0.24 * pace;
  const double down_s = off_s + flight_s;
  const double low_s = down_s + 0.16 * pace;
  const double end_s = low_s + 0.55 * pace;
  const double home = manner.rest[kForward];

  timeline.Set(0.08, kHeight, manner.rest[kHeight]);
  timeline.Set(crouch_s, kHeight, 0.80 - 0.15 * (manner.amplitude - 1));
  SetFlight(timeline, manner, off_s, flight_s, 1.10, 1.03);
  timeline.Set(low_s, kHeight, 0.80);
  timeline.Set(0.08, kForward, home);
  timeline.Set(crouch_s, kForward, home + 0.03);
  timeline.Set(off_s, kForward, home + 0.14);
  timeline.Set(down_s, kForward, home + distance - 0.04);
  timeline.Set(low_s, kForward, home + distance - 0.01);
  for (const Side side : {Side::kLeft, Side::kRight}) {
    const double rest = manner.rest.at(kFootForward, side);
    timeline.Set(off_s, kFootForward, side, rest);
    timeline.Set(down_s, kFootForward, side, rest + distance);
    timeline.Set(end_s, kFootForward, side, rest + distance);
  }
  timeline.SetBoth(crouch_s, kFootPitch, 0);
  timeline.SetBoth(off_s, kFootPitch, 36);
  timeline.SetBoth(off_s + 0.4 * flight_s, kFootPitch, 38);
  timeline.SetBoth(down_s, kFootPitch, 16);
  timeline.SetBoth(down_s + 0.09, kFootPitch, 0);
  // Arms swing back in the crouch and forward in the jump.
  timeline.SetBoth(0.08, kElevation, manner.rest.at(kElevation, Side::kLeft));
  timeline.SetBoth(crouch_s, kElevation, Value(manner, kElevation, -32));
  timeline.SetBoth(crouch_s, kPlane, Value(manner, kPlane, 118));
  timeline.SetBoth(crouch_s, kElbow, 22);
  timeline.SetBoth(crouch_s, kArmTwist, 5);
  timeline.SetBoth(low_s, kArmTwist, 5);
  timeline.SetBoth(off_s + 0.25 * flight_s, kElevation, Value(manner, kElevation, 58));
  timeline.SetBoth(off_s, kPlane, Value(manner, kPlane, 78));
  timeline.SetBoth(off_s, kElbow, Value(manner, kElbow, 42));
  timeline.SetBoth(low_s, kElevation, Value(manner, kElevation, 28));
  timeline.Set(crouch_s, kLean, 26);
  timeline.Set(off_s, kLean, 8);
  timeline.Set(down_s, kLean, 8);
  timeline.Set(low_s, kLean, 22);
  timeline.Set(crouch_s, kBend, 14);
  timeline.Set(off_s, kBend, 2);
  timeline.Set(low_s, kBend, 12);
  timeline.core_first_s = 0.1;
  timeline.core_last_s = low_s + 0.4 * pace;
  timeline.end_forward = distance;
  timeline.Set(end_s, kForward, home + distance);
  timeline.Finish(end_s);
  return timeline;
}

Timeline BuildJumpingJack(const Manner& manner) {
  Timeline timeline(manner.rest);
  const double pace = manner.pace;
  const double flight_s = 0.22;
  const double crouch_s = 0.26 * pace;
  const double wide = 0.36 * manner.amplitude;
  const std::array<double, 2> off_s = {crouch_s + 0.14 * pace,
                                       crouch_s + 0.14 * pace + flight_s + 0.34 * pace};
  timeline.Set(0.06, kHeight, manner.rest[kHeight]);
  timeline.Set(crouch_s, kHeight, 0.92);
  for (std::size_t jump = 0; jump < 2; ++jump) {
    const bool opens = jump == 0;
    const double down_s = off_s[jump] + flight_s;
    SetFlight(timeline, manner, off_s[jump], flight_s, opens ? 1.07 : 0.99, opens ? 0.97 : 1.05);
    timeline.Set(down_s + 0.15 * pace, kHeight, opens ? 0.88 : 0.91);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const double rest = manner.rest.at(kFootSide, side);
      timeline.Set(off_s[jump], kFootSide, side, opens ? rest : wide);
      timeline.Set(down_s, kFootSide, side, opens ? wide : rest);
    }
    timeline.SetBoth(off_s[jump] - 0.1 * pace, kFootPitch, 0);
    timeline.SetBoth(off_s[jump], kFootPitch, 30);
    timeline.SetBoth(off_s[jump] + 0.5 * flight_s, kFootPitch, 30);
    timeline.SetBoth(down_s, kFootPitch, 16);
    timeline.SetBoth(down_s + 0.08, kFootPitch, 0);
  }
  const double open_s = off_s[0] + flight_s + 0.06 * pace;
  const double end_s = off_s[1] + flight_s + 0.5 * pace;
  timeline.SetBoth(crouch_s, kElevation, manner.rest.at(kElevation, Side::kLeft));
  timeline.SetBoth(crouch_s, kPlane, manner.rest.at(kPlane, Side::kLeft));
  for (const double moment_s : {open_s, open_s + 0.12 * pace}) {
    timeline.SetBoth(moment_s, kElevation, Value(manner, kElevation, 163));
    timeline.SetBoth(moment_s, kPlane, 14);
    timeline.SetBoth(moment_s, kArmTwist, -50);
    timeline.SetBoth(moment_s, kElbow, Value(manner, kElbow, 28));
  }
  for (const Limb channel : {kElevation, kPlane, kArmTwist, kElbow}) {
    timeline.SetBoth(off_s[1] + flight_s + 0.12 * pace, channel,
                     manner.rest.at(channel, Side::kLeft));
  }
  timeline.core_first_s = 0.05;
  timeline.core_last_s = end_s - 0.1 * pace;
  timeline.Finish(end_s);
  return timeline;
}

Timeline BuildTurnOnTheSpot(const Manner& manner, double angle_deg) {
  Timeline timeline(manner.rest);
  const double angle = angle_deg * std::numbers::pi / 180;
  const double end_s = 1.5 * manner.pace;
  const Side first = angle_deg > 0 ? Side::kLeft : Side::kRight;
  const auto rotated = [&](double x, double z) {
    return std::array{x * std::cos(angle) + z * std::sin(angle),
                      z * std::cos(angle) - x * std::sin(angle)};
  };
  for (const Side side : {first, Opposite(first)}) {
    const double sign = side == Side::kLeft ? 1 : -1;
    const double off_s = (side == first ? 0.15 : 0.75) * manner.pace;
    const double down_s = off_s + 0.5 * manner.pace;
    const auto goal =
        rotated(sign * manner.rest.at(kFootSide, side), manner.rest.at(kFootForward, side));
    for (const Limb channel : {kFootSide, kFootForward, kFootTurn}) {
      timeline.Set(off_s + 0.05 * manner.pace, channel, side, manner.rest.at(channel, side));
    }
    for (const double moment_s : {down_s - 0.05 * manner.pace, end_s}) {
      timeline.Set(moment_s, kFootSide, side, sign * goal[0]);
      timeline.Set(moment_s, kFootForward, side, goal[1]);
      timeline.Set(moment_s, kFootTurn, side, manner.rest.at(kFootTurn, side) + sign * angle_deg);
    }
    timeline.Set(off_s, kFootLift, side, 0);
    timeline.Set(off_s + 0.25 * manner.pace, kFootLift, side, 0.07);
    timeline.Set(down_s, kFootLift, side, 0);
  }
  const auto goal = rotated(manner.rest[kSide], manner.rest[kForward]);
  timeline.Set(end_s, kSide, goal[0]);
  timeline.Set(end_s, kForward, goal[1]);
  timeline.Set(0.15 * manner.pace, kTurn, manner.rest[kTurn]);
  timeline.Set(end_s, kTurn, manner.rest[kTurn] + angle_deg);
  timeline.end_turn_deg = angle_deg;
  timeline.Finish(end_s);
  return timeline;
}

Timeline BuildStand(const Manner& manner, double duration_s) {
  Timeline timeline(manner.rest);
  timeline.Finish(duration_s);
  return timeline;
}

Timeline BuildTPose(const Manner& manner, bool at_end) {
  Timeline timeline(manner.rest);
  const double hold_s = 0.6;
  const double end_s = hold_s + 0.9 * manner.pace;
  const auto set = [&](double from_start_s, Limb channel, double value) {
    timeline.SetBoth(at_end ? end_s - from_start_s : from_start_s, channel, value);
  };
  for (const double moment_s : {0.0, hold_s}) {
    set(moment_s, kElevation, 90);
    set(moment_s, kPlane, 0);
    set(moment_s, kArmTwist, -30);  // HDM05's neutral pose: palms down, thumbs ahead.
    set(moment_s, kElbow, 3);
    set(moment_s, kGrip, 2);
  }
  timeline.FinishOpen(end_s, !at_end, at_end);
  return timeline;
}

}  // namespace kinebase::internal
