// Writes made-up motion as a folder of files.
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/formats/amc.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/synth/synthetic_motion.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 7> kEntries = {
    "asf", "cut_amc", "takes", "clips.csv", "takes.truth.csv", "takes.cuts.txt", "README.txt"};

// Shorter numbers: 1e-8 of a degree moves a hand by 1e-8 cm at most.
double Rounded(double value) { return std::round(value * 1e8) / 1e8; }

std::string SeedNote(std::string_view what, std::uint64_t seed) {
  return fmt::format("synthetic {} made by kinebase synth, seed {}", what, seed);
}

std::string AsfText(const Skeleton& skeleton, std::uint64_t seed) {
  AsfSkeleton asf = ToAsf(skeleton);
  asf.comments = {"# " + SeedNote("skeleton", seed)};
  for (AsfBone& bone : asf.bones) {
    bone.length = Rounded(bone.length);
    for (double& value : bone.direction) value = Rounded(value);
    for (double& value : bone.axis) value = Rounded(value);
    for (AsfLimits& limits : bone.limits) {
      limits = {Rounded(limits.low), Rounded(limits.high)};
    }
  }
  return FormatAsf(asf);
}

std::string AmcText(const Motion& motion, std::uint64_t seed) {
  Diagnostics diagnostics;  // All rotations are made from DOFs, so none is lost.
  AmcMotion amc = ToAmc(motion, diagnostics);
  amc.header.insert(amc.header.begin(), "# " + SeedNote("motion", seed));
  for (double& value : amc.values) value = Rounded(value);
  return FormatAmc(amc);
}

std::string TakeStem(const SyntheticActor& actor, int take) {
  constexpr int kTakesAScene = 99;
  return fmt::format("SYN_{}_01-{:02}_{:02}_120", actor.name, take / kTakesAScene + 1,
                     take % kTakesAScene + 1);
}

std::string ClipStem(const SyntheticActor& actor, const std::string& class_name, int number) {
  return fmt::format("SYN_{}_{}_{:03}_120", actor.name, class_name, number);
}

// One file of motion that is to be made, and what the lists need to know of it afterwards.
struct Item {
  std::size_t actor;
  std::size_t class_index;  // Clips only.
  int number;               // Repetition or take, from 0.
  bool is_take;
  int frames = 0;
  std::vector<SyntheticSegment> segments;
};

class LibraryWriter {
 public:
  LibraryWriter(fs::path folder, const SynthOptions& options)
      : folder_(std::move(folder)), options_(options), classes_(options.classes) {
    CheckOptions();
    if (classes_.empty()) classes_ = SyntheticClasses();
    for (int i = 0; i < options.actors; ++i) {
      actors_.push_back(MakeSyntheticActor(i, options.seed));
    }
    PlanItems();
  }

  SynthReport Write() {
    CheckFolder();
    WriteText("README.txt", Readme());
    for (const SyntheticActor& actor : actors_) {
      WriteText(fs::path("asf") / ("SYN_" + actor.name + ".asf"),
                AsfText(*MakeSyntheticSkeleton(actor), options_.seed));
    }
    ParallelFor(items_.size(), options_.threads, [&](std::size_t i) { WriteItem(items_[i]); });
    WriteText("clips.csv", ClipList());
    WriteText("takes.truth.csv", TruthList());
    WriteText("takes.cuts.txt", CutFile());
    return Report();
  }

 private:
  void CheckOptions() const {
    const auto at_least = [](const char* name, int value, int least) {
      if (value >= least) return;
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("{} is {}, expected at least {}", name, value, least));
    };
    at_least("the number of actors", options_.actors, 1);
    at_least("the number of repetitions", options_.repetitions, 0);
    at_least("the number of takes", options_.takes, 0);
    at_least("the number of clips a take", options_.clips_per_take, 1);
    const std::vector<std::string> known = SyntheticClasses();
    for (const std::string& name : options_.classes) {
      if (std::ranges::find(known, name) != known.end()) continue;
      throw Error(ErrorCode::kNotFound, fmt::format("no synthetic motion class '{}'; there are {}",
                                                    name, fmt::join(known, ", ")));
    }
  }

  void CheckFolder() const {
    if (options_.overwrite == Overwrite::kYes) return;
    for (const char* entry : kEntries) {
      std::error_code ignored;
      if (!fs::exists(fs::symlink_status(folder_ / entry, ignored))) continue;
      throw Error(ErrorCode::kAlreadyExists,
                  "is there already; choose another folder, or ask for overwriting",
                  {folder_ / entry});
    }
  }

  void PlanItems() {
    for (std::size_t actor = 0; actor < actors_.size(); ++actor) {
      for (std::size_t c = 0; c < classes_.size(); ++c) {
        for (int i = 0; i < options_.repetitions; ++i) items_.push_back({actor, c, i, false});
      }
    }
    for (std::size_t actor = 0; actor < actors_.size(); ++actor) {
      for (int i = 0; i < options_.takes; ++i) items_.push_back({actor, 0, i, true});
    }
  }

  void WriteItem(Item& item) {
    const SyntheticActor& actor = actors_[item.actor];
    if (item.is_take) {
      SyntheticTake take =
          MakeSyntheticTake(actor, options_.clips_per_take, item.number, options_.seed, classes_);
      item.frames = take.motion.frame_count;
      item.segments = std::move(take.segments);
      WriteText(fs::path("takes") / (StemOf(item) + ".amc"), AmcText(take.motion, options_.seed));
    } else {
      const std::string& class_name = classes_[item.class_index];
      const Motion clip = MakeSyntheticClip(class_name, actor, item.number, options_.seed);
      item.frames = clip.frame_count;
      WriteText(fs::path("cut_amc") / class_name / (StemOf(item) + ".amc"),
                AmcText(clip, options_.seed));
    }
    ReportProgress();
  }

  [[nodiscard]] std::string StemOf(const Item& item) const {
    const SyntheticActor& actor = actors_[item.actor];
    if (item.is_take) return TakeStem(actor, item.number);
    return ClipStem(actor, classes_[item.class_index],
                    static_cast<int>(item.actor) * options_.repetitions + item.number + 1);
  }

  void WriteText(const fs::path& relative, std::string_view text) const {
    WriteFile(folder_ / relative, text, options_.overwrite);
  }

  void ReportProgress() {
    if (!options_.progress) return;
    const std::lock_guard lock(progress_mutex_);
    if (!options_.progress("making motion", ++done_, items_.size())) {
      throw Error(ErrorCode::kCancelled, "cancelled while making synthetic motion", {folder_});
    }
  }

  [[nodiscard]] std::string ClipList() const {
    std::string text =
        "file,class,actor,source_take,take_first_frame,take_last_frame,frames,split\n";
    for (const Item& item : items_) {
      if (item.is_take) continue;
      const std::string stem = StemOf(item);
      text += fmt::format("{}.amc,{},{},{},1,{},{},synthetic\n", stem, classes_[item.class_index],
                          actors_[item.actor].name, stem, item.frames, item.frames);
    }
    return text;
  }

  [[nodiscard]] std::string TruthList() const {
    std::string text = "file,class,first_frame,last_frame,split\n";
    for (const Item& item : items_) {
      for (const SyntheticSegment& segment : item.segments) {
        text += fmt::format("{}.amc,{},{},{},synthetic\n", StemOf(item), segment.class_name,
                            segment.first_frame, segment.last_frame);
      }
    }
    return text;
  }

  [[nodiscard]] std::string CutFile() const {
    std::string text = fmt::format("% {}\n% take, first frame, last frame, clip\n",
                                   SeedNote("motion", options_.seed));
    std::vector<int> numbers(classes_.size(), options_.actors * options_.repetitions);
    for (const Item& item : items_) {
      for (const SyntheticSegment& segment : item.segments) {
        const auto c = static_cast<std::size_t>(std::ranges::find(classes_, segment.class_name) -
                                                classes_.begin());
        text += fmt::format("\"takes\\{}.amc\"\t{}\t{}\t{}\n", StemOf(item), segment.first_frame,
                            segment.last_frame,
                            ClipStem(actors_[item.actor], segment.class_name, ++numbers[c]));
      }
    }
    return text;
  }

  [[nodiscard]] std::string Readme() const {
    std::string text = fmt::format(
        "Synthetic motion: nobody was recorded for this\n\n"
        "Made by kinebase synth with seed {}. The figures follow keyed postures and rules; real\n"
        "people move less regularly, so what a method scores here says little about recordings.\n\n"
        "asf/             skeletons, one a made-up actor\n"
        "cut_amc/         clips, one repetition each, a folder for each motion class\n"
        "takes/           long takes of several classes; frames at 120 Hz, counted from 1\n"
        "clips.csv        the clips\n"
        "takes.truth.csv  which frames of a long take show which class\n"
        "takes.cuts.txt   the same as an HDM05 cut file\n\nActors\n",
        options_.seed);
    for (const SyntheticActor& actor : actors_) {
      text += fmt::format("  {}  {:.1f} cm, {}-handed, tempo {:.2f}, amplitude {:.2f}\n",
                          actor.name, actor.stature_cm, actor.left_handed ? "left" : "right",
                          actor.tempo, actor.amplitude);
    }
    text += "\nMotion classes\n";
    for (const std::string& name : classes_) text += "  " + name + "\n";
    return text;
  }

  [[nodiscard]] SynthReport Report() const {
    SynthReport report{.actors = static_cast<int>(actors_.size())};
    for (const Item& item : items_) {
      ++(item.is_take ? report.takes : report.clips);
      report.frames += item.frames;
    }
    return report;
  }

  fs::path folder_;
  const SynthOptions& options_;
  std::vector<std::string> classes_;
  std::vector<SyntheticActor> actors_;
  std::vector<Item> items_;
  std::mutex progress_mutex_;
  std::size_t done_ = 0;
};

}  // namespace

SynthReport WriteSyntheticLibrary(const fs::path& folder, const SynthOptions& options) {
  return LibraryWriter(folder, options).Write();
}

}  // namespace kinebase
