// The motion classes: what is moved when. Data where possible (motion_tables.cpp); steps and jumps
// follow rules of their own (locomotion.cpp).
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "synth/pose.h"
#include "synth/random.h"
#include "synth/timeline.h"

namespace kinebase::internal {

// How one performer does one repetition of a class.
struct Manner {
  Pose rest;  // The performer's standing posture.
  double leg_length_cm;
  double pace;                                         // Durations as multiples of the usual ones.
  double amplitude;                                    // Of places: step length, depth of a squat.
  std::array<double, kChannelCount> angle_amplitudes;  // A channel's deviation from rest.
  double rhythm_shift_s;  // What the performer's sense of time adds, as a slow wave of this height
  double rhythm_phase;    // and this phase.

  // The moment and the value of a key as this performer has it.
  [[nodiscard]] double Time(double usual_s) const;
  [[nodiscard]] double Value(int channel, double usual) const;
};

// Stands for the channel's value in the rest posture.
[[nodiscard]] double RestValue();

// A channel (or the same one of both sides) and the value it is to have.
struct Setting {
  int channel;
  int twin;  // -1: none.
  double value;
};

struct Key {
  double time_s;
  std::vector<Setting> settings;
};

// A class as a table of keys. Between the first and the last the posture comes from, and goes back
// to, standing.
struct MotionTable {
  double core_first_s;
  double core_last_s;
  double duration_s;
  std::vector<Key> keys;
  double amplitude_share = 1;  // 0: every performer does it with the same angles.
};

[[nodiscard]] Timeline BuildFromTable(const MotionTable& table, const Manner& manner,
                                      bool mirrored = false);

struct MotionClass {
  std::string_view name;
  Timeline (*build)(const Manner& manner);
};

[[nodiscard]] std::span<const MotionClass> MotionClasses();

// motion_tables.cpp
[[nodiscard]] const MotionTable& SquatTable();
[[nodiscard]] const MotionTable& ElbowToKneeTable();
[[nodiscard]] const MotionTable& KickFrontTable();
[[nodiscard]] const MotionTable& RotateArmTable();
[[nodiscard]] const MotionTable& ThrowOverarmTable();
[[nodiscard]] const MotionTable& GrabHighTable();
[[nodiscard]] const MotionTable& ClapAboveHeadTable();
[[nodiscard]] const MotionTable& DepositFloorTable();
[[nodiscard]] const MotionTable& PunchFrontTable();

// locomotion.cpp
[[nodiscard]] Timeline BuildWalk(const Manner& manner);
[[nodiscard]] Timeline BuildJog(const Manner& manner);
[[nodiscard]] Timeline BuildHop(const Manner& manner);
[[nodiscard]] Timeline BuildJumpingJack(const Manner& manner);
[[nodiscard]] Timeline BuildTurnOnTheSpot(const Manner& manner, double angle_deg);
[[nodiscard]] Timeline BuildStand(const Manner& manner, double duration_s);
// The arms out to the sides, lowered to rest at the end, or raised out of rest.
[[nodiscard]] Timeline BuildTPose(const Manner& manner, bool at_end);

}  // namespace kinebase::internal
