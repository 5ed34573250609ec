#include "cli/synth_hours.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fmt/format.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase::cli {
namespace {

constexpr double kRateHz = 30;  // That of the features: what is searched needs no more.
constexpr std::int64_t kFramesATake = 9000;  // Five minutes.
constexpr int kTakesAnActor = 12;            // An hour by everyone.
constexpr int kMotionVersion = 1;  // To be raised when the same seed comes to give other motion.

Recording MakeTake(int actor_number, int number, double duration_s, std::uint64_t seed) {
  const SyntheticActor actor = MakeSyntheticActor(actor_number, seed);
  Recording recording;
  recording.format = "synthetic";
  recording.name = {.actor = actor.name,
                    .class_name = {},
                    .take = fmt::format("{:02}", number + 1),
                    .rate_hz = 0};
  recording.motion =
      MakeLongSyntheticTake(
          actor, {.duration_s = duration_s, .rate_hz = kRateHz, .number = number, .seed = seed})
          .motion;
  return recording;
}

}  // namespace

std::vector<ImportSource> SyntheticSources(const std::filesystem::path& library, double hours,
                                           std::uint64_t seed) {
  const auto frames = std::max<std::int64_t>(1, std::llround(hours * 3600 * kRateHz));
  const int takes = static_cast<int>((frames + kFramesATake - 1) / kFramesATake);
  const std::filesystem::path folder =
      std::filesystem::weakly_canonical(library) / "synthetic" / fmt::format("seed-{}", seed);
  std::vector<ImportSource> sources;
  sources.reserve(static_cast<std::size_t>(takes));
  for (int i = 0; i < takes; ++i) {
    const int actor = i / kTakesAnActor;
    const int number = i % kTakesAnActor;
    const std::int64_t left = frames - i * kFramesATake;
    const double duration_s = static_cast<double>(std::min(left, kFramesATake)) / kRateHz;
    ImportSource source;
    source.file =
        folder / fmt::format("SYN_{}_{:02}", MakeSyntheticActor(actor, seed).name, number + 1);
    source.origin = fmt::format("synthetic motion {}: seed {}, actor {}, take {}, {} s",
                                kMotionVersion, seed, actor, number, duration_s);
    source.make = [=] { return MakeTake(actor, number, duration_s, seed); };
    sources.push_back(std::move(source));
  }
  return sources;
}

}  // namespace kinebase::cli
