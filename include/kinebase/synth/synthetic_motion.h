// Made-up motion with exact truth: for demos, tests and measurements of scale.
//
// Everything it writes says that it is synthetic. Same options, same bytes, whatever the number of
// threads. docs/synth.md tells how people and motion classes are made and how to add one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/core/progress.h"
#include "kinebase/motion/motion.h"

namespace kinebase {

// The motion classes that can be made: "walk4StepsRstart", "squat1Reps", …
[[nodiscard]] std::vector<std::string> SyntheticClasses();

// A made-up person: size, proportions, tempo, amplitude, preferred side and noise follow from the
// seed and the actor's number.
struct SyntheticActor {
  std::string name;  // "sa", "sb", …
  double stature_cm = 0;
  double tempo = 1;      // Times faster than usual.
  double amplitude = 1;  // Times larger than usual.
  double noise_deg = 0;  // Standard deviation of smooth joint angle noise.
  bool left_handed = false;
};

// number  From 0: "sa", …, "sz", "saa", …
// Errors  InvalidArgument if the number is negative.
[[nodiscard]] SyntheticActor MakeSyntheticActor(int number, std::uint64_t seed);

// A skeleton with HDM05's bones, DOFs and axes. Depends on the actor's name and stature alone.
// Errors  InvalidArgument if the actor has no stature.
[[nodiscard]] std::shared_ptr<const Skeleton> MakeSyntheticSkeleton(const SyntheticActor& actor);

// One repetition at 120 Hz, somewhere on the floor and facing anywhere. Repetitions of one class
// differ in tempo, amplitude, start and noise. Feet that stand do not slide, nothing goes below the
// floor (y = 0).
// Errors  NotFound: unknown class, naming those that there are.
[[nodiscard]] Motion MakeSyntheticClip(const std::string& class_name, const SyntheticActor& actor,
                                       int repetition, std::uint64_t seed);

// A stretch of a long take and what it shows.
struct SyntheticSegment {
  std::string class_name;
  int first_frame = 0;  // 1-based.
  int last_frame = 0;   // Inclusive.
};

struct SyntheticTake {
  Motion motion;
  // In order, without overlap. What lies between them is standing, turning, getting ready.
  std::vector<SyntheticSegment> segments;
};

// A take of `clips` clips with smooth transitions, standing and turns on the spot in between; a
// short T-pose at either end. Classes come in random order, each once before one comes again.
// classes  To choose from; empty: all.
// Errors   NotFound: unknown class, naming those that there are.
[[nodiscard]] SyntheticTake MakeSyntheticTake(const SyntheticActor& actor, int clips, int number,
                                              std::uint64_t seed,
                                              const std::vector<std::string>& classes = {});

struct LongTakeOptions {
  double duration_s = 300;
  double rate_hz = 120;
  int number = 0;
  std::uint64_t seed = 1;
};

// A take of exactly this length, and of all classes, as MakeSyntheticTake makes them: it begins
// with a T-pose and breaks off when the time is over.
//
// segments  Those that are in it whole.
// Errors    InvalidArgument for a rate that no motion has, and for a duration without a frame or
//           with more than fit into an int.
// Cost      O(frames): some 5 µs and 2 kB each.
[[nodiscard]] SyntheticTake MakeLongSyntheticTake(const SyntheticActor& actor,
                                                  const LongTakeOptions& options);

struct SynthOptions {
  int actors = 4;
  int repetitions = 3;  // Clips a class and actor.
  int takes = 1;        // Long takes an actor.
  int clips_per_take = 12;
  std::uint64_t seed = 1;
  std::vector<std::string> classes;  // Empty: all.
  Overwrite overwrite = Overwrite::kNo;
  int threads = 0;
  ProgressCallback progress;
};

struct SynthReport {
  int actors = 0;
  int clips = 0;
  int takes = 0;
  std::int64_t frames = 0;
};

// Writes a small library laid out like HDM05's:
//   asf/SYN_{actor}.asf                                 skeletons
//   cut_amc/{class}/SYN_{actor}_{class}_{nnn}_120.amc   clips
//   takes/SYN_{actor}_{part}-{scene}_{take}_120.amc     long takes
//   clips.csv   file,class,actor,source_take,take_first_frame,take_last_frame,frames,split
//   takes.truth.csv   file,class,first_frame,last_frame,split: what happens where in the long takes
//   takes.cuts.txt    an HDM05 cut file for the same stretches
//   README.txt  that says what this is
// The column `split` says "synthetic" everywhere, and a clip is its own source take. Numbers nnn
// run through a class over all actors; the cut file's go on after the clips'.
//
// Errors  AlreadyExists, before anything is written, if the folder holds any of these and
//         overwriting was not asked for; overwriting leaves files alone that are not written again.
//         InvalidArgument, NotFound for options that make no sense; IoFailure; Cancelled.
// Threads The files do not depend on how many there are.
SynthReport WriteSyntheticLibrary(const std::filesystem::path& folder, const SynthOptions& options);

}  // namespace kinebase
