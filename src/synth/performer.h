// One performer: rest posture, manner of each repetition, smooth noise.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "kinebase/synth/synthetic_motion.h"
#include "synth/figure.h"
#include "synth/motion_classes.h"

namespace kinebase::internal {

// Smooth random deviations of the posture: for each channel a few sine waves of 0.2 to 1.8 Hz.
class Tremor {
 public:
  Tremor(Random random, double noise_deg);
  void AddTo(Pose& pose, double time_s) const;

 private:
  struct Wave {
    int channel;
    double height;
    double radians_per_s;
    double phase;
  };
  std::vector<Wave> waves_;
};

class Performer {
 public:
  Performer(const SyntheticActor& actor, std::uint64_t seed);

  // `random` decides what differs from one repetition to the next.
  [[nodiscard]] Manner MannerOf(std::string_view class_name, Random random) const;
  [[nodiscard]] const Figure& figure() const { return figure_; }
  [[nodiscard]] const SyntheticActor& actor() const { return actor_; }

  // A stream for one purpose of this performer.
  [[nodiscard]] Random Stream(std::string_view purpose, std::uint64_t number) const;

 private:
  [[nodiscard]] Pose MakeRest() const;

  SyntheticActor actor_;
  std::uint64_t seed_;
  Figure figure_;
  Pose rest_;
};

}  // namespace kinebase::internal
