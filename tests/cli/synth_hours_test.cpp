// synth --hours: a library of made-up motion without files in between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "kinebase/library/take_library.h"
#include "kinebase/synth/synthetic_motion.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;

ProgramResult Make(const fs::path& library, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments = {"synth", library, "--hours", "0.2", "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return RunKinebase(arguments);
}

std::map<std::string, std::string> Contents(const fs::path& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder)) {
    contents[entry.path().filename()] = ReadText(entry.path());
  }
  return contents;
}

TEST(SynthHours, MakesSoMuchMotionAndNoMore) {
  const TemporaryFolder folder;
  const fs::path library = folder.path() / "library";
  const ProgramResult result = Make(library);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = result.Json();
  EXPECT_EQ(json["added"], 3);
  EXPECT_EQ(json["frames"], 21600);  // 720 s at 30 Hz: two takes of five minutes and one of two.
  const TakeLibrary stored(library);
  ASSERT_EQ(stored.takes().size(), 3U);
  std::vector<std::int64_t> frames;
  frames.reserve(stored.takes().size());
  for (const StoredTake& take : stored.takes()) {
    frames.push_back(take.frame_count);
    EXPECT_EQ(take.rate_hz, 30);
    EXPECT_EQ(take.name.actor, "sa");
  }
  EXPECT_THAT(frames, testing::ElementsAre(9000, 9000, 3600));
  EXPECT_EQ(RunKinebase({"library", "verify", library}).exit_code, 0);
}

TEST(SynthHours, AreTheSameBytesWhateverTheNumberOfThreads) {
  const TemporaryFolder folder;
  const fs::path one = folder.path() / "one";
  const fs::path three = folder.path() / "three";
  const fs::path other = folder.path() / "other";
  Make(one, {"--threads", "1", "--poses"});
  Make(three, {"--threads", "3", "--poses"});
  Make(other, {"--seed", "2", "--poses"});
  EXPECT_EQ(Contents(one / "segments"), Contents(three / "segments"));
  EXPECT_NE(Contents(one / "segments"), Contents(other / "segments"));
}

TEST(SynthHours, GoOnFromWhatIsThere) {
  const TemporaryFolder folder;
  const fs::path library = folder.path() / "library";
  Make(library);
  const auto again = Make(library).Json();
  EXPECT_EQ(again["unchanged"], 3);
  EXPECT_EQ(again["frames"], 0);
  const auto more = RunKinebase({"synth", library, "--hours", "0.3", "--json"}).Json();
  EXPECT_EQ(more["unchanged"], 2);  // The third was shorter.
  EXPECT_EQ(more["updated"], 1);
  EXPECT_EQ(more["added"], 1);
}

// The truth is known; the template comes from clips of other people at another rate.
TEST(SynthHours, HoldTheMotionsThatASearchThenFinds) {
  const SyntheticLibrary recordings;
  const fs::path library = recordings.scratch() / "hours";
  Make(library);
  const auto hits = RunKinebase({"search", recordings.Learn("squat1Reps"), "--library", library,
                                 "--tau", "0.12", "--json"})
                        .Json()["hits"];
  const SyntheticTake take = MakeLongSyntheticTake(MakeSyntheticActor(0, 1), {.rate_hz = 30});
  int squats = 0;
  int found = 0;
  for (const SyntheticSegment& segment : take.segments) {
    if (segment.class_name != "squat1Reps") continue;
    ++squats;
    for (const auto& hit : hits) {
      const bool is_there = hit["file"].get<std::string>().ends_with("SYN_sa_01") &&
                            hit["first_frame"] < segment.last_frame &&
                            hit["last_frame"] > segment.first_frame;
      if (!is_there) continue;
      ++found;
      break;
    }
  }
  EXPECT_GT(squats, 3);
  EXPECT_EQ(found, squats);
}

TEST(SynthHours, AreNotMadeWithOptionsForFiles) {
  const TemporaryFolder folder;
  const std::string library = folder.path() / "library";
  ExpectOneError(RunKinebase({"synth", library, "--hours", "1", "--actors", "3"}), 2, {"--hours"});
  ExpectOneError(RunKinebase({"synth", library, "--poses"}), 2, {"--hours"});
  ExpectOneError(RunKinebase({"synth", library, "--hours", "0"}), 2, {"--hours", "0"});
  WriteText(folder.path() / "other" / "file.txt", "mine");
  ExpectOneError(RunKinebase({"synth", folder.path() / "other", "--hours", "0.01"}), 1, {"other"});
}

}  // namespace
}  // namespace kinebase::test
