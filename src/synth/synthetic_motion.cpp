#include "kinebase/synth/synthetic_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "synth/performer.h"

namespace kinebase {
namespace {

using internal::FloorFrame;
using internal::Manner;
using internal::MotionClass;
using internal::Performer;
using internal::Pose;
using internal::Random;
using internal::Timeline;
using internal::Tremor;

constexpr double kRateHz = 120;  // Of what is written as files.

const MotionClass& FindClass(std::string_view name) {
  const auto classes = internal::MotionClasses();
  const auto found = std::ranges::find(classes, name, &MotionClass::name);
  if (found == classes.end()) {
    throw Error(ErrorCode::kNotFound, fmt::format("no synthetic motion class '{}'; there are {}",
                                                  name, fmt::join(SyntheticClasses(), ", ")));
  }
  return *found;
}

// Where a timeline leaves its performer.
FloorFrame FrameAfter(const FloorFrame& frame, const Timeline& timeline, double leg_length_cm) {
  const double heading = frame.heading_deg * std::numbers::pi / 180;
  const double way_cm = timeline.end_forward * leg_length_cm;
  return {.x_cm = frame.x_cm + way_cm * std::sin(heading),
          .z_cm = frame.z_cm + way_cm * std::cos(heading),
          .heading_deg = frame.heading_deg + timeline.end_turn_deg};
}

constexpr double kEnvelopeReach_s = 11 / kRateHz;

// The largest value within ±`reach` frames, then a weighted mean over as many: a smooth curve that
// is nowhere below `needed`.
std::vector<double> SmoothEnvelope(const std::vector<double>& needed, int reach) {
  const int count = static_cast<int>(needed.size());
  const auto inside = [&](int i) { return static_cast<std::size_t>(std::clamp(i, 0, count - 1)); };
  std::vector<double> highest(needed.size());
  for (int i = 0; i < count; ++i) {
    double& value = highest[inside(i)];
    value = needed[inside(i)];
    for (int k = -reach; k <= reach; ++k) value = std::max(value, needed[inside(i + k)]);
  }
  std::vector<double> smooth(needed.size());
  for (int i = 0; i < count; ++i) {
    double sum = 0;
    double weights = 0;
    for (int k = -reach; k <= reach; ++k) {
      const double u = static_cast<double>(k) / (reach + 1);
      const double weight = (1 - u * u) * (1 - u * u);
      sum += weight * highest[inside(i + k)];
      weights += weight;
    }
    smooth[inside(i)] = sum / weights;
  }
  return smooth;
}

class Recorder {
 public:
  Recorder(const Performer& performer, Tremor tremor, double rate_hz)
      : figure_(performer.figure()), tremor_(std::move(tremor)), rate_hz_(rate_hz) {}

  // Frames of a timeline from `first_s` to `last_s` of its own time.
  void Record(const Timeline& timeline, double first_s, double last_s, const FloorFrame& frame) {
    const int frames = static_cast<int>(std::floor((last_s - first_s) * rate_hz_)) + 1;
    for (int i = 0; i < frames; ++i) {
      Pose pose = timeline.At(first_s + i / rate_hz_);
      tremor_.AddTo(pose, frame_count() / rate_hz_);
      poses_.push_back(pose);
      frames_.push_back(frame);
    }
  }

  [[nodiscard]] int frame_count() const { return static_cast<int>(poses_.size()); }

  void KeepFirst(int frames) {
    poses_.resize(static_cast<std::size_t>(frames));
    frames_.resize(static_cast<std::size_t>(frames));
  }

  [[nodiscard]] Motion Develop() const {
    Motion motion{
        .skeleton = figure_.skeleton(), .rate_hz = rate_hz_, .frame_count = frame_count()};
    std::vector<double> drops;
    drops.reserve(poses_.size());
    for (const Pose& pose : poses_) drops.push_back(figure_.PelvisDrop(pose));
    const auto reach = static_cast<int>(std::lround(kEnvelopeReach_s * rate_hz_));
    drops = SmoothEnvelope(drops, reach);
    const auto joints = static_cast<std::size_t>(motion.joint_count());
    motion.root_position_cm.resize(poses_.size());
    motion.rotations.resize(poses_.size() * joints);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      figure_.SetPose(poses_[i], frames_[i], drops[i], motion.root_position_cm[i],
                      motion.rotations.data() + i * joints);
    }
    return motion;
  }

 private:
  const internal::Figure& figure_;
  Tremor tremor_;
  double rate_hz_;
  std::vector<Pose> poses_;
  std::vector<FloorFrame> frames_;
};

// Puts timelines one after the other into a long take.
class TakeBuilder {
 public:
  TakeBuilder(const SyntheticActor& actor, int number, std::uint64_t seed, double rate_hz = kRateHz)
      : rate_hz_(rate_hz),
        performer_(actor, seed),
        random_(performer_.Stream("take", static_cast<std::uint64_t>(number))),
        recorder_(performer_, Tremor(Random({random_.Next()}), actor.noise_deg), rate_hz) {
    frame_.heading_deg = random_.Uniform(-180, 180);
    Append(internal::BuildTPose(NextManner("tPose"), false));
    Pause();
  }

  void AppendClass(const MotionClass& motion_class) {
    const Timeline timeline = motion_class.build(NextManner(motion_class.name));
    const int begin = recorder_.frame_count();
    Append(timeline);
    const auto frame_at = [&](double time_s) {
      return std::min(begin + static_cast<int>(std::lround(time_s * rate_hz_)),
                      recorder_.frame_count() - 1) +
             1;
    };
    segments_.push_back({std::string(motion_class.name), frame_at(timeline.core_first_s),
                         frame_at(timeline.core_last_s)});
    Pause();
    if (random_.Uniform(0, 1) < 0.5) Turn();
  }

  SyntheticTake Finish() {
    Append(internal::BuildTPose(NextManner("tPose"), true));
    return {.motion = recorder_.Develop(), .segments = std::move(segments_)};
  }

  // Without the closing T-pose, and without what comes after these frames.
  SyntheticTake BreakOff(int frames) {
    recorder_.KeepFirst(frames);
    std::erase_if(segments_, [frames](const auto& each) { return each.last_frame > frames; });
    return {.motion = recorder_.Develop(), .segments = std::move(segments_)};
  }

  [[nodiscard]] int frame_count() const { return recorder_.frame_count(); }

  void Shuffle(std::vector<const MotionClass*>& classes) {
    for (std::size_t i = classes.size(); i > 1; --i) {
      std::swap(classes[i - 1], classes[random_.Below(i)]);
    }
  }

 private:
  Manner NextManner(std::string_view name) {
    return performer_.MannerOf(name, Random({random_.Next()}));
  }

  void Append(const Timeline& timeline) {
    // The last instant is the first of what follows.
    recorder_.Record(timeline, 0, timeline.duration_s() - 1 / rate_hz_, frame_);
    frame_ = FrameAfter(frame_, timeline, performer_.figure().leg_length_cm());
  }

  void Pause() { Append(internal::BuildStand(NextManner("stand"), random_.Uniform(0.35, 1.2))); }

  void Turn() {
    const double angle_deg = random_.Uniform(25, 65) * (random_.Uniform(0, 1) < 0.5 ? -1 : 1);
    Append(internal::BuildTurnOnTheSpot(NextManner("turn"), angle_deg));
    Pause();
  }

  double rate_hz_;
  Performer performer_;
  Random random_;
  Recorder recorder_;
  FloorFrame frame_;
  std::vector<SyntheticSegment> segments_;
};

// Classes in random order without end, each once before one comes again.
void AppendNext(TakeBuilder& builder, std::vector<const MotionClass*>& classes, int count) {
  const std::size_t place = static_cast<std::size_t>(count) % classes.size();
  if (place == 0) builder.Shuffle(classes);
  builder.AppendClass(*classes[place]);
}

}  // namespace

std::vector<std::string> SyntheticClasses() {
  std::vector<std::string> names;
  for (const MotionClass& motion_class : internal::MotionClasses()) {
    names.emplace_back(motion_class.name);
  }
  return names;
}

Motion MakeSyntheticClip(const std::string& class_name, const SyntheticActor& actor, int repetition,
                         std::uint64_t seed) {
  const MotionClass& motion_class = FindClass(class_name);
  const Performer performer(actor, seed);
  Random random = performer.Stream("clip " + class_name, static_cast<std::uint64_t>(repetition));
  const Manner manner = performer.MannerOf(class_name, Random({random.Next()}));
  const Timeline timeline = motion_class.build(manner);
  Recorder recorder(performer, Tremor(Random({random.Next()}), actor.noise_deg), kRateHz);
  const FloorFrame frame{.x_cm = random.Uniform(-100, 100),
                         .z_cm = random.Uniform(-100, 100),
                         .heading_deg = random.Uniform(-180, 180)};
  // Nobody cuts at the very frame.
  const double first_s = std::max(timeline.core_first_s - random.Uniform(0, 0.1), 0.0);
  const double last_s =
      std::min(timeline.core_last_s + random.Uniform(0, 0.1), timeline.duration_s());
  recorder.Record(timeline, first_s, last_s, frame);
  return recorder.Develop();
}

SyntheticTake MakeSyntheticTake(const SyntheticActor& actor, int clips, int number,
                                std::uint64_t seed, const std::vector<std::string>& classes) {
  std::vector<const MotionClass*> choice;
  for (const std::string& name : classes.empty() ? SyntheticClasses() : classes) {
    choice.push_back(&FindClass(name));
  }
  TakeBuilder builder(actor, number, seed);
  for (int i = 0; i < clips; ++i) AppendNext(builder, choice, i);
  return builder.Finish();
}

SyntheticTake MakeLongSyntheticTake(const SyntheticActor& actor, const LongTakeOptions& options) {
  if (!(options.rate_hz >= kSmallestRateHz && options.rate_hz <= kLargestRateHz)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a rate of {} Hz is not between {} and {} Hz", options.rate_hz,
                            kSmallestRateHz, kLargestRateHz));
  }
  const double frames = std::round(options.duration_s * options.rate_hz);
  if (!(frames >= 1 && frames <= std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a take of {} s has no number of frames at {} Hz", options.duration_s,
                            options.rate_hz));
  }
  std::vector<const MotionClass*> classes;
  classes.reserve(internal::MotionClasses().size());
  for (const MotionClass& each : internal::MotionClasses()) classes.push_back(&each);
  TakeBuilder builder(actor, options.number, options.seed, options.rate_hz);
  for (int i = 0; builder.frame_count() < frames; ++i) AppendNext(builder, classes, i);
  return builder.BreakOff(static_cast<int>(frames));
}

}  // namespace kinebase
