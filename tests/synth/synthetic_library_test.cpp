#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "kinebase/core/error.h"
#include "kinebase/motion/motion_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "synth/poses.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;

SynthOptions SmallOptions() {
  return {.actors = 2,
          .repetitions = 2,
          .takes = 1,
          .clips_per_take = 3,
          .seed = 5,
          .classes = {"squat1Reps", "kickRFront1Reps", "walk4StepsRstart"}};
}

std::map<std::string, std::string> Contents(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      contents[fs::relative(entry.path(), folder).generic_string()] = ReadText(entry.path());
    }
  }
  return contents;
}

void ExpectSameJoints(const Motion& expected, const Motion& actual) {
  const JointTrajectories a = ForwardKinematics(expected);
  const JointTrajectories b = ForwardKinematics(actual);
  ASSERT_EQ(a.positions_cm.size(), b.positions_cm.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.positions_cm.size(); ++i) {
    worst = std::max(worst, (a.positions_cm[i] - b.positions_cm[i]).norm());
  }
  EXPECT_LT(worst, 1e-6);
}

TEST(SyntheticLibrary, ReadsBackWithTheSameJoints) {
  const TemporaryFolder folder;
  SynthOptions options = SmallOptions();
  options.classes.clear();
  options.repetitions = 1;
  (void)WriteSyntheticLibrary(folder.path(), options);
  for (int number = 0; number < options.actors; ++number) {
    const SyntheticActor actor = MakeSyntheticActor(number, options.seed);
    for (const std::string& name : SyntheticClasses()) {
      const fs::path file =
          folder.path() / "cut_amc" / name /
          ("SYN_" + actor.name + "_" + name + "_00" + std::to_string(number + 1) + "_120.amc");
      const Recording loaded = LoadRecording(file);
      EXPECT_EQ(loaded.name.actor, actor.name);
      EXPECT_EQ(loaded.name.class_name, name);
      EXPECT_EQ(loaded.motion.rate_hz, 120);
      for (const Diagnostic& diagnostic : loaded.diagnostics) {
        EXPECT_EQ(diagnostic.severity, Severity::kInfo) << diagnostic.message;
      }
      ExpectSameJoints(MakeSyntheticClip(name, actor, 0, options.seed), loaded.motion);
    }
    const auto take = MakeSyntheticTake(actor, options.clips_per_take, 0, options.seed);
    ExpectSameJoints(take.motion, LoadRecording(folder.path() / "takes" /
                                                ("SYN_" + actor.name + "_01-01_01_120.amc"))
                                      .motion);
  }
}

TEST(SyntheticLibrary, IsTheSameToTheByteForAnyNumberOfThreads) {
  const TemporaryFolder one;
  const TemporaryFolder many;
  const TemporaryFolder other;
  SynthOptions options = SmallOptions();
  options.threads = 1;
  (void)WriteSyntheticLibrary(one.path(), options);
  options.threads = 4;
  (void)WriteSyntheticLibrary(many.path(), options);
  EXPECT_EQ(Contents(one.path()), Contents(many.path()));
  ++options.seed;
  (void)WriteSyntheticLibrary(other.path(), options);
  EXPECT_NE(Contents(one.path()), Contents(other.path()));
}

TEST(SyntheticLibrary, ListsExactlyTheClipsThatItWrote) {
  const TemporaryFolder folder;
  const SynthReport report = WriteSyntheticLibrary(folder.path(), SmallOptions());
  EXPECT_EQ(report.actors, 2);
  EXPECT_EQ(report.clips, 12);
  EXPECT_EQ(report.takes, 2);
  const CsvTable clips = ReadCsv(folder.path() / "clips.csv");
  std::set<std::string> listed;
  std::int64_t frames = 0;
  for (const auto& row : clips.rows) {
    listed.insert(row[clips.Column("file")]);
    const fs::path file =
        folder.path() / "cut_amc" / row[clips.Column("class")] / row[clips.Column("file")];
    const int count = LoadRecording(file).motion.frame_count;
    EXPECT_EQ(row[clips.Column("frames")], std::to_string(count));
    EXPECT_EQ(row[clips.Column("take_first_frame")], "1");
    EXPECT_EQ(row[clips.Column("take_last_frame")], std::to_string(count));
    frames += count;
  }
  std::set<std::string> written;
  for (const fs::path& file : FilesBelow(folder.path() / "cut_amc", ".amc")) {
    written.insert(file.filename().string());
  }
  EXPECT_EQ(listed, written);
  for (const fs::path& file : FilesBelow(folder.path() / "takes", ".amc")) {
    frames += LoadRecording(file).motion.frame_count;
  }
  EXPECT_EQ(report.frames, frames);
}

TEST(SyntheticLibrary, GivesTheSameTruthInTheTableAndInTheCutFile) {
  const TemporaryFolder folder;
  (void)WriteSyntheticLibrary(folder.path(), SmallOptions());
  const CsvTable truth = ReadCsv(folder.path() / "takes.truth.csv");
  std::istringstream cuts(ReadText(folder.path() / "takes.cuts.txt"));
  std::size_t row = 0;
  std::set<std::string> names;
  for (std::string line; std::getline(cuts, line);) {
    if (line.starts_with('%')) continue;
    ASSERT_LT(row, truth.rows.size());
    const auto cell = [&](const char* column) { return truth.rows[row][truth.Column(column)]; };
    std::istringstream words(line);
    std::string source, first, last, name;
    words >> source >> first >> last >> name;
    EXPECT_EQ(source, "\"takes\\" + cell("file") + "\"");
    EXPECT_EQ(first, cell("first_frame"));
    EXPECT_EQ(last, cell("last_frame"));
    EXPECT_EQ(ParseTakeName(name + ".amc").class_name, cell("class"));
    EXPECT_FALSE(fs::exists(folder.path() / "cut_amc" / cell("class") / (name + ".amc")));
    EXPECT_TRUE(names.insert(name).second) << name;
    ++row;
  }
  EXPECT_EQ(row, truth.rows.size());
  EXPECT_EQ(row, 6U);
}

TEST(SyntheticLibrary, SaysInEveryFileThatItIsSynthetic) {
  const TemporaryFolder folder;
  (void)WriteSyntheticLibrary(folder.path(), SmallOptions());
  for (const auto& [name, text] : Contents(folder.path())) {
    std::istringstream lines(text);
    if (name.ends_with(".csv")) {
      std::string line;
      std::getline(lines, line);
      while (std::getline(lines, line)) EXPECT_TRUE(line.ends_with(",synthetic")) << name;
    } else {
      std::string head = text.substr(0, 400);
      std::ranges::transform(head, head.begin(), [](char c) { return c == 'S' ? 's' : c; });
      EXPECT_NE(head.find("synthetic"), std::string::npos) << name;
    }
    if (name.ends_with(".amc")) {
      EXPECT_TRUE(text.starts_with("# synthetic motion made by kinebase synth, seed 5\n")) << name;
    }
  }
}

TEST(SyntheticLibrary, RefusesAFolderInUseBeforeItWritesAnything) {
  for (const char* entry : {"asf", "cut_amc", "takes", "clips.csv", "takes.truth.csv",
                            "takes.cuts.txt", "README.txt"}) {
    const TemporaryFolder folder;
    const fs::path mine = folder.path() / entry / (fs::path(entry).has_extension() ? "" : "a.txt");
    WriteText(fs::path(entry).has_extension() ? folder.path() / entry : mine, "mine");
    const auto before = Contents(folder.path());
    const Error error =
        ErrorOf([&] { (void)WriteSyntheticLibrary(folder.path(), SmallOptions()); });
    EXPECT_EQ(error.code(), ErrorCode::kAlreadyExists);
    EXPECT_EQ(Contents(folder.path()), before) << entry;
  }
}

TEST(SyntheticLibrary, OverwritesWhenAskedTo) {
  const TemporaryFolder folder;
  SynthOptions options = SmallOptions();
  (void)WriteSyntheticLibrary(folder.path(), options);
  const auto before = Contents(folder.path());
  options.seed = 6;
  options.overwrite = Overwrite::kYes;
  (void)WriteSyntheticLibrary(folder.path(), options);
  const auto after = Contents(folder.path());
  ASSERT_EQ(before.size(), after.size());
  for (const auto& [name, text] : after) EXPECT_NE(text, before.at(name)) << name;
}

TEST(SyntheticLibrary, StopsWhenTheCallbackSaysSo) {
  const TemporaryFolder folder;
  SynthOptions options = SmallOptions();
  options.progress = [](std::string_view, std::size_t done, std::size_t total) {
    EXPECT_EQ(total, 14U);
    return done < 3;
  };
  EXPECT_EQ(ErrorOf([&] { (void)WriteSyntheticLibrary(folder.path(), options); }).code(),
            ErrorCode::kCancelled);
  EXPECT_FALSE(fs::exists(folder.path() / "clips.csv"));
}

TEST(SyntheticLibrary, RefusesOptionsThatMakeNoSense) {
  const TemporaryFolder folder;
  SynthOptions no_actors = SmallOptions();
  no_actors.actors = 0;
  SynthOptions unknown = SmallOptions();
  unknown.classes = {"fly"};
  EXPECT_EQ(ErrorOf([&] { (void)WriteSyntheticLibrary(folder.path(), no_actors); }).code(),
            ErrorCode::kInvalidArgument);
  EXPECT_EQ(ErrorOf([&] { (void)WriteSyntheticLibrary(folder.path(), unknown); }).code(),
            ErrorCode::kNotFound);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace kinebase::test
