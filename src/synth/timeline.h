// Postures over time: keys for each channel and a smooth curve through them.
#pragma once

#include <array>
#include <vector>

#include "synth/pose.h"

namespace kinebase::internal {

// A curve through keys: a monotone cubic, so that it never leaves the range of two neighbours (a
// planted foot stays where it is), with rest at both ends and constant outside.
//
// Source: Fritsch, Butland, "A Method for Constructing Local Monotone Piecewise Cubic
// Interpolants", SIAM J. Sci. Stat. Comput. 5 (1984).
class Track {
 public:
  // Keys may come in any order; a second one for the same moment replaces the first.
  void Set(double time_s, double value);
  void Finish();  // After the last Set, before the first At.

  [[nodiscard]] double At(double time_s) const;
  [[nodiscard]] bool empty() const { return keys_.empty(); }
  [[nodiscard]] double last_value() const { return keys_.back().value; }
  [[nodiscard]] double last_time_s() const { return keys_.back().time_s; }

 private:
  struct Key {
    double time_s;
    double value;
    double slope;
  };
  std::vector<Key> keys_;
};

// One piece of motion that begins and ends in the performer's standing posture.
class Timeline {
 public:
  explicit Timeline(const Pose& rest);

  // What counts as the motion class: without getting into it and out of it.
  double core_first_s = 0;
  double core_last_s = 0;
  // Where the performer's floor frame is at the end, seen from where it was.
  double end_forward = 0;   // Leg lengths.
  double end_turn_deg = 0;  // Applied after end_forward.

  void Set(double time_s, Body channel, double value);
  void Set(double time_s, Limb channel, Side side, double value);
  void Set(double time_s, int channel, double value);
  void SetBoth(double time_s, Limb channel, double value);

  // Lets all channels that were set begin in the rest posture, and end in it at `duration_s`.
  void Finish(double duration_s);
  // The same without an end (or beginning) in the rest posture where the last (first) key is.
  void FinishOpen(double duration_s, bool open_begin, bool open_end);

  [[nodiscard]] Pose At(double time_s) const;
  [[nodiscard]] double duration_s() const { return duration_s_; }
  [[nodiscard]] const Pose& rest() const { return rest_; }

 private:
  Pose rest_;
  double duration_s_ = 0;
  std::array<Track, kChannelCount> tracks_;
};

}  // namespace kinebase::internal
