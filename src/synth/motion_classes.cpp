#include "synth/motion_classes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kinebase::internal {
namespace {

constexpr double kRhythmPeriod_s = 1.3;

template <const MotionTable& (*Table)(), bool Mirrored = false>
Timeline Build(const Manner& manner) {
  return BuildFromTable(Table(), manner, Mirrored);
}

constexpr std::array<MotionClass, 14> kClasses = {{
    {"walk4StepsRstart", BuildWalk},
    {"jog4StepsRstart", BuildJog},
    {"squat1Reps", Build<SquatTable>},
    {"jumpingJack1Reps", BuildJumpingJack},
    {"elbowToKnee1RepsLelbowStart", Build<ElbowToKneeTable>},
    {"kickRFront1Reps", Build<KickFrontTable>},
    {"kickLFront1Reps", Build<KickFrontTable, true>},
    {"rotateArmsRForward1Reps", Build<RotateArmTable>},
    {"throwOverarmR", Build<ThrowOverarmTable>},
    {"grabHighR", Build<GrabHighTable>},
    {"hopBothLegs1hops", BuildHop},
    {"clapAboveHead1Reps", Build<ClapAboveHeadTable>},
    {"depositFloorR", Build<DepositFloorTable>},
    {"punchRFront1Reps", Build<PunchFrontTable>},
}};

}  // namespace

double RestValue() { return std::numeric_limits<double>::quiet_NaN(); }

double Manner::Time(double usual_s) const {
  const double phase = 2 * std::numbers::pi * usual_s / kRhythmPeriod_s + rhythm_phase;
  const double shift = rhythm_shift_s * (std::sin(phase) - std::sin(rhythm_phase));
  return pace * (usual_s + shift);
}

double Manner::Value(int channel, double usual) const {
  const double at_rest = rest.values[channel];
  if (std::isnan(usual)) return at_rest;
  if (IsBlend(channel)) return usual;
  if (IsPlace(channel)) return at_rest + amplitude * (usual - at_rest);
  const double value = at_rest + angle_amplitudes[channel] * (usual - at_rest);
  // A joint that reaches far already does not go past where it ends.
  return std::abs(usual) <= 175 ? std::clamp(value, -175.0, 175.0) : value;
}

Timeline BuildFromTable(const MotionTable& table, const Manner& manner, bool mirrored) {
  Timeline timeline(manner.rest);
  Manner own = manner;
  for (double& amplitude : own.angle_amplitudes) {
    amplitude = 1 + table.amplitude_share * (amplitude - 1);
  }
  const auto set = [&](double time_s, int channel, double value) {
    if (mirrored) {
      value *= MirroredSign(channel);
      channel = MirroredChannel(channel);
    }
    timeline.Set(time_s, channel, own.Value(channel, value));
  };
  for (const Key& key : table.keys) {
    const double time_s = own.Time(key.time_s);
    for (const Setting& setting : key.settings) {
      set(time_s, setting.channel, setting.value);
      if (setting.twin >= 0) set(time_s, setting.twin, setting.value);
    }
  }
  timeline.core_first_s = own.Time(table.core_first_s);
  timeline.core_last_s = own.Time(table.core_last_s);
  timeline.Finish(own.Time(table.duration_s));
  return timeline;
}

std::span<const MotionClass> MotionClasses() { return kClasses; }

}  // namespace kinebase::internal
