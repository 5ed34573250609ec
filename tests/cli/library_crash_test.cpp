// A library after whatever can go wrong while it is written: it opens, holds everything that was
// reported as added, is intact, and the next import completes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/expectations.h"
#include "cli/run_program.h"
#include "cli/synthetic_library.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsSubsetOf;
using ::testing::SizeIs;

// What `import --json` reported line by line; a line that was cut off was not said.
std::vector<std::string> Reported(const std::string& out) {
  std::vector<std::string> files;
  std::istringstream lines(out);
  for (std::string line; std::getline(lines, line);) {
    const auto json = nlohmann::ordered_json::parse(line, nullptr, false);
    if (json.is_object() && json.contains("state")) files.push_back(json["file"]);
  }
  return files;
}

class CrashingImport : public ::testing::Test {
 protected:
  // Three batches: two takes that are there already, others that are new, one that has changed.
  CrashingImport() {
    EXPECT_EQ(RunKinebase(Arguments(fs::path(recordings_.Squat()).parent_path())).exit_code, 0);
    fs::copy(library(), before_, fs::copy_options::recursive);
    WriteText(recordings_.Squat(), ReadText(recordings_.Clip("squat1Reps", "sa", 2)));
  }

  [[nodiscard]] fs::path library() const { return recordings_.scratch() / "lib"; }

  [[nodiscard]] std::vector<std::string> Arguments(const fs::path& what) const {
    return {"import",  what,      "--library", library(),   "--json",
            "--quiet", "--batch", "5",         "--threads", "1"};
  }
  [[nodiscard]] std::vector<std::string> ArgumentsOfAll() const {
    return Arguments(recordings_.folder());
  }

  void Restore() const {
    fs::remove_all(library());
    fs::copy(before_, library(), fs::copy_options::recursive);
  }

  // The number of calls of an import that nothing happens to.
  [[nodiscard]] int CountCalls() const {
    const fs::path total = recordings_.scratch() / "total";
    EXPECT_EQ(RunKinebase(ArgumentsOfAll(), {.environment = {{"LD_PRELOAD", KINEBASE_FAULTS},
                                                             {"ASAN_OPTIONS", kAsanOptions},
                                                             {"KINEBASE_FAULT_TOTAL", total}}})
                  .exit_code,
              0);
    return std::stoi(ReadText(total));
  }

  [[nodiscard]] ProgramResult ImportWithFault(const std::string& kind, int at) const {
    return RunKinebase(ArgumentsOfAll(),
                       {.environment = {{"LD_PRELOAD", KINEBASE_FAULTS},
                                        {"ASAN_OPTIONS", kAsanOptions},
                                        {"KINEBASE_FAULT", kind},
                                        {"KINEBASE_FAULT_AT", std::to_string(at)}}});
  }

  void ExpectSound(const std::vector<std::string>& reported) const {
    const ProgramResult verified = RunKinebase({"library", "verify", library(), "--json"});
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    std::vector<std::string> there;
    const auto list = RunKinebase({"library", "list", library(), "--json"}).Json();
    for (const auto& take : list["takes"]) there.push_back(take["file"]);
    EXPECT_THAT(reported, IsSubsetOf(there));
    EXPECT_GE(there.size(), 2U);  // What was there before.
  }

  void ExpectCompletes() const {
    const ProgramResult result = RunKinebase(ArgumentsOfAll());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(Reported(result.out), SizeIs(kTakes));
    const auto verified = RunKinebase({"library", "verify", library(), "--json"}).Json();
    EXPECT_EQ(verified["takes"], kTakes);
    EXPECT_EQ(verified["leftovers"], 0);
  }

  static constexpr int kTakes = 12;
  // The address sanitizer wants to be the first library.
  static constexpr const char* kAsanOptions = "verify_asan_link_order=0:detect_leaks=0";

  SyntheticLibrary recordings_;

 private:
  fs::path before_ = recordings_.scratch() / "before";
};

// Points from the first call to the last, evenly and with some chance in it.
std::vector<int> SeededPoints(int count, int calls) {
  std::mt19937 random(2006);
  std::set<int> points;
  for (int i = 0; i < count; ++i) {
    const int begin = 1 + i * calls / count;
    const int end = std::max(begin + 1, 1 + (i + 1) * calls / count);
    points.insert(begin + static_cast<int>(random() % static_cast<unsigned>(end - begin)));
  }
  return {points.begin(), points.end()};
}

TEST_F(CrashingImport, KilledAtFiftySeededPointsLosesNothingThatItReported) {
  const int calls = CountCalls();
  ASSERT_GE(calls, 50);
  int cut_short = 0;
  for (const int at : SeededPoints(50, calls)) {
    SCOPED_TRACE(at);
    Restore();
    const ProgramResult result = ImportWithFault("kill", at);
    EXPECT_EQ(result.exit_code, 128 + SIGKILL);
    const auto reported = Reported(result.out);
    cut_short += !reported.empty() && std::ssize(reported) < kTakes ? 1 : 0;
    ExpectSound(reported);
    ExpectCompletes();
  }
  EXPECT_GE(cut_short, 10);  // The points lie before, between and after the batches.
}

TEST_F(CrashingImport, KilledInTheMiddleOfAWriteLosesNothing) {
  for (const int at : SeededPoints(20, CountCalls())) {
    SCOPED_TRACE(at);
    Restore();
    ExpectSound(Reported(ImportWithFault("torn", at).out));
    ExpectCompletes();
  }
}

TEST_F(CrashingImport, OnADiskThatGetsFullSaysSoAndLosesNothing) {
  for (const int at : SeededPoints(20, CountCalls())) {
    SCOPED_TRACE(at);
    Restore();
    const ProgramResult result = ImportWithFault("full", at);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.ErrorLines(), SizeIs(1));
    EXPECT_THAT(result.err, HasSubstr("error: "));
    ExpectSound(Reported(result.out));
    ExpectCompletes();
  }
}

TEST_F(CrashingImport, WithACallThatFailsOnceLosesNothing) {
  for (const int at : SeededPoints(20, CountCalls())) {
    SCOPED_TRACE(at);
    Restore();
    const ProgramResult result = ImportWithFault("once", at);
    EXPECT_THAT(result.exit_code, ::testing::AnyOf(0, 1)) << result.err;
    ExpectSound(Reported(result.out));
    ExpectCompletes();
  }
}

// The system's own limit: files may not grow beyond so many blocks of 512 bytes.
TEST_F(CrashingImport, WithinALimitOfFileSizesSaysSoAndLosesNothing) {
  int refused = 0;
  for (const int blocks : {0, 1, 2, 8, 16, 40, 72, 80, 88}) {
    SCOPED_TRACE(blocks);
    for (const char* signal : {"trap '' XFSZ; ", ""}) {  // Without it the limit kills.
      Restore();
      std::vector<std::string> command = {
          "sh", "-c", signal + ("ulimit -f " + std::to_string(blocks) + "; exec \"$@\""), "sh",
          KINEBASE_PROGRAM};
      for (const std::string& argument : ArgumentsOfAll()) command.push_back(argument);
      const ProgramResult result = RunCommand(command);
      refused += result.exit_code == 1 ? 1 : 0;
      ExpectSound(Reported(result.out));
      ExpectCompletes();
    }
  }
  EXPECT_GE(refused, 3);
}

// A name is in the folder above: what is made deep down lasts if all that hold new names do.
TEST_F(CrashingImport, FlushesTheNamesOfAllFoldersThatItMakes) {
  const fs::path flushed = recordings_.scratch() / "flushed";
  const fs::path made = recordings_.scratch() / "n" / "a" / "b" / "lib";
  EXPECT_EQ(RunKinebase({"import", recordings_.Squat(), "--library", made},
                        {.environment = {{"LD_PRELOAD", KINEBASE_FAULTS},
                                         {"ASAN_OPTIONS", kAsanOptions},
                                         {"KINEBASE_FAULT_FLUSHED", flushed}}})
                .exit_code,
            0);
  std::set<std::string> names;
  std::istringstream lines(ReadText(flushed));
  for (std::string line; std::getline(lines, line);) names.insert(line);
  for (fs::path folder = fs::canonical(made) / "segments";
       folder != fs::canonical(recordings_.scratch()).parent_path();
       folder = folder.parent_path()) {
    EXPECT_TRUE(names.contains(folder.string())) << folder;
  }
}

TEST_F(CrashingImport, OfALibraryThatIsBeingMadeCanBeginAgain) {
  fs::remove_all(library());
  const int calls = CountCalls();
  for (const int at : SeededPoints(25, std::min(calls, 60))) {
    SCOPED_TRACE(at);
    fs::remove_all(library());
    const auto reported = Reported(ImportWithFault("kill", at).out);
    const ProgramResult verified = RunKinebase({"library", "verify", library()});
    if (verified.exit_code != 0) {  // Not yet made, and nothing was said to be in it.
      EXPECT_THAT(verified.err,
                  ::testing::AnyOf(HasSubstr("is no library"), HasSubstr("does not exist")));
      EXPECT_THAT(reported, ::testing::IsEmpty());
    }
    ExpectCompletes();
  }
}

// Changes of a library that is there, each of which is made whole or not at all.
class CrashingChange : public CrashingImport {
 protected:
  // Two segments, one of them with a take that was removed; the other takes have labels.
  CrashingChange() {
    EXPECT_EQ(RunKinebase(ArgumentsOfAll()).exit_code, 0);
    EXPECT_EQ(Change({"label", "--add", "gym", "--actors", "sa"}).exit_code, 0);
    EXPECT_EQ(Change({"remove", "--actors", "sb", "--classes", "squat1Reps"}).exit_code, 0);
    Prepare(library());
  }

  // What each change begins with.
  void Prepare(const fs::path& folder) {
    fs::remove_all(prepared_);
    fs::copy(folder, prepared_, fs::copy_options::recursive);
    RestorePrepared();
    before_ = Takes();
  }

  void RestorePrepared() const {
    fs::remove_all(library());
    fs::copy(prepared_, library(), fs::copy_options::recursive);
  }

  // kinebase library ACTION LIBRARY …, with a fault if one is named.
  [[nodiscard]] ProgramResult Change(std::vector<std::string> arguments,
                                     const std::map<std::string, std::string>& fault = {}) const {
    arguments.insert(arguments.begin() + 1, library());
    arguments.insert(arguments.begin(), "library");
    std::map<std::string, std::string> environment = fault;
    if (!fault.empty()) {
      environment["LD_PRELOAD"] = KINEBASE_FAULTS;
      environment["ASAN_OPTIONS"] = kAsanOptions;
    }
    return RunKinebase(arguments, {.environment = environment});
  }

  // What is listed of the takes, but for where their features are.
  [[nodiscard]] nlohmann::ordered_json Takes() const {
    return RunKinebase({"library", "list", library(), "--json"}).Json()["takes"];
  }

  // Whatever goes wrong where: the library is sound, and as it was or as it is to become.
  void ExpectWholeOrNotAtAll(const std::vector<std::string>& arguments) const {
    const fs::path total = recordings_.scratch() / "total";
    ASSERT_EQ(Change(arguments, {{"KINEBASE_FAULT_TOTAL", total}}).exit_code, 0);
    const int calls = std::stoi(ReadText(total));
    ASSERT_GE(calls, 10);
    const auto after = Takes();
    int undone = 0;
    for (const char* kind : {"kill", "torn", "full", "once"}) {
      for (const int at : SeededPoints(8, calls)) {
        SCOPED_TRACE(std::string(kind) + ' ' + std::to_string(at));
        RestorePrepared();
        const ProgramResult result = Change(
            arguments, {{"KINEBASE_FAULT", kind}, {"KINEBASE_FAULT_AT", std::to_string(at)}});
        if (std::string(kind) == "full" && result.exit_code != 0) {
          EXPECT_EQ(result.exit_code, 1);
          EXPECT_THAT(result.ErrorLines(), SizeIs(1));
        }
        const ProgramResult verified = RunKinebase({"library", "verify", library()});
        EXPECT_EQ(verified.exit_code, 0) << verified.err;
        const auto takes = Takes();
        if (result.exit_code == 0) {
          EXPECT_EQ(takes, after);
        } else {
          EXPECT_TRUE(takes == before_ || takes == after);
        }
        undone += takes == before_ ? 1 : 0;
        EXPECT_EQ(Change(arguments).exit_code, takes == after && IsOnlyOnce(arguments) ? 1 : 0);
        EXPECT_EQ(Takes(), after);
        ExpectCleanAfterCompacting();
      }
    }
    EXPECT_GE(undone, after == before_ ? 24 : 4);
  }

  // Takes that are gone cannot be removed again.
  [[nodiscard]] static bool IsOnlyOnce(const std::vector<std::string>& arguments) {
    return arguments.front() == "remove";
  }

  void ExpectCleanAfterCompacting() const {
    EXPECT_EQ(Change({"compact", "--quiet"}).exit_code, 0);
    const auto verified = RunKinebase({"library", "verify", library(), "--json"});
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_EQ(verified.Json()["leftovers"], 0);
  }

  nlohmann::ordered_json before_;

 private:
  fs::path prepared_ = recordings_.scratch() / "prepared";
};

TEST_F(CrashingChange, OfLabelsIsMadeWholeOrNotAtAll) {
  ExpectWholeOrNotAtAll({"label", "--add", "warm-up", "--remove", "gym", "--actors", "sa"});
}

TEST_F(CrashingChange, OfALibraryOfVersion1IsMadeWholeOrNotAtAll) {
  Prepare(fs::path(KINEBASE_SOURCE_DIR) / "tests" / "library" / "samples" / "library_v1");
  ExpectWholeOrNotAtAll({"label", "--add", "gym", "--actors", "sa"});
}

TEST_F(CrashingChange, ByRemovingIsMadeWholeOrNotAtAll) {
  ExpectWholeOrNotAtAll({"remove", "--classes", "kickRFront1Reps"});
}

TEST_F(CrashingChange, ByCompactingLosesNothing) { ExpectWholeOrNotAtAll({"compact"}); }

}  // namespace
}  // namespace kinebase::test
