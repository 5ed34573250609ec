// Reading and writing whole files.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/core/file_stream.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/output_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> NamesIn(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

TEST(MappedFile, HoldsTheBytesOfTheFile) {
  const test::TemporaryFolder folder;
  const std::string bytes("a\0b\r\n\xFF", 6);
  test::WriteText(folder.path() / "f", bytes);
  MappedFile file(folder.path() / "f");
  EXPECT_EQ(file.text(), bytes);
  const MappedFile moved = std::move(file);
  EXPECT_EQ(moved.text(), bytes);
}

// Memory of this process that holds parts of files.
std::int64_t FileMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("RssFile:")) return std::atoll(line.c_str() + 8) * 1024;
  }
  return 0;
}

TEST(MappedFile, GivesBackTheMemoryOfAPartThatCanStillBeRead) {
  const test::TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; bytes.size() < 32'000'000; ++i) bytes += std::to_string(i);
  test::WriteText(folder.path() / "f", bytes);
  const MappedFile file(folder.path() / "f");
  ASSERT_EQ(file.text(), bytes);
  const std::int64_t before = FileMemory();
  file.Release(file.text().substr(1, 20'000'000));
  EXPECT_LT(FileMemory(), before - 16'000'000);
  file.Release(file.text().substr(30'000'000));
  file.Release(file.text().substr(5, 0));
  EXPECT_EQ(file.text(), bytes);
}

TEST(MappedFile, OpensAnEmptyFile) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "empty", "");
  EXPECT_EQ(MappedFile(folder.path() / "empty").text(), "");
}

TEST(MappedFile, SaysThatAFileIsMissing) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "file", "x");
  for (const fs::path& path : {folder.path() / "missing", folder.path() / "file" / "below"}) {
    const Error error = test::ErrorOf([&] { MappedFile file(path); });
    EXPECT_EQ(error.code(), ErrorCode::kNotFound);
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
  }
}

TEST(MappedFile, RefusesWhatIsNoFile) {
  const test::TemporaryFolder folder;
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const fs::path& path : {folder.path(), pipe, fs::path("/dev/null")}) {
    EXPECT_EQ(test::ErrorOf([&] { MappedFile file(path); }).code(), ErrorCode::kIoFailure) << path;
  }
}

TEST(WriteFile, WritesWhatItIsGivenAndMakesFolders) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "a" / "b" / "f";
  const std::string bytes("a\0\r\n", 4);
  WriteFile(path, bytes, Overwrite::kNo);
  EXPECT_EQ(test::ReadText(path), bytes);
  EXPECT_THAT(NamesIn(path.parent_path()), ElementsAre("f"));
}

TEST(WriteFile, RefusesToOverwriteUnlessAsked) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "f";
  WriteFile(path, "old", Overwrite::kNo);
  const Error error = test::ErrorOf([&] { WriteFile(path, "new", Overwrite::kNo); });
  EXPECT_EQ(error.code(), ErrorCode::kAlreadyExists);
  EXPECT_THAT(error.what(), HasSubstr("--force"));
  EXPECT_EQ(test::ReadText(path), "old");
  WriteFile(path, "new", Overwrite::kYes);
  EXPECT_EQ(test::ReadText(path), "new");
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("f"));
}

TEST(WriteFile, WritesThroughALinkAndKeepsIt) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "target", "old");
  fs::create_symlink("target", folder.path() / "link");
  WriteFile(folder.path() / "link", "new", Overwrite::kYes);
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(test::ReadText(folder.path() / "target"), "new");
}

TEST(WriteFile, LeavesDevicesAlone) {
  for (const Overwrite overwrite : {Overwrite::kNo, Overwrite::kYes}) {
    EXPECT_EQ(test::ErrorOf([&] { WriteFile("/dev/null", "x", overwrite); }).code(),
              ErrorCode::kIoFailure);
  }
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(WriteFile, NamesAFolderThatStandsInTheWay) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "d");
  test::WriteText(folder.path() / "file", "x");
  for (const Overwrite overwrite : {Overwrite::kNo, Overwrite::kYes}) {
    EXPECT_EQ(test::ErrorOf([&] { WriteFile(folder.path() / "d", "x", overwrite); }).code(),
              ErrorCode::kIoFailure);
    EXPECT_EQ(
        test::ErrorOf([&] { WriteFile(folder.path() / "file" / "f", "x", overwrite); }).code(),
        ErrorCode::kIoFailure);
  }
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("d", "file"));
}

TEST(WriteFile, TakesTheLongestNameThatTheSystemAllows) {
  const test::TemporaryFolder folder;
  const std::string name(255, 'n');
  WriteFile(folder.path() / name, "x", Overwrite::kNo);
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre(name));
  EXPECT_EQ(
      test::ErrorOf([&] { WriteFile(folder.path() / (name + 'n'), "x", Overwrite::kNo); }).code(),
      ErrorCode::kIoFailure);
}

// In a process of its own: a limit on file sizes stands for a full disk.
void WriteWithFullDisk(const fs::path& folder) {
  const rlimit limit{.rlim_cur = 1000, .rlim_max = 1000};
  ::signal(SIGXFSZ, SIG_IGN);
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(2);
  try {
    WriteFile(folder / "f", std::string(5000, 'x'), Overwrite::kYes);
    ::_exit(3);
  } catch (const Error& error) {
    ::_exit(error.code() == ErrorCode::kIoFailure ? 0 : 4);
  }
}

TEST(WriteFileDeathTest, LeavesEverythingAsItWasOnAFullDisk) {
  GTEST_FLAG_SET(death_test_style, "fast");
  const test::TemporaryFolder folder;
  WriteFile(folder.path() / "f", "old", Overwrite::kNo);
  EXPECT_EXIT(WriteWithFullDisk(folder.path()), testing::ExitedWithCode(0), "");
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("f"));
  EXPECT_EQ(test::ReadText(folder.path() / "f"), "old");
}

// The first would fit and the second does not: files that belong together come together.
void WriteTwoWithFullDisk(const fs::path& folder) {
  const rlimit limit{.rlim_cur = 1000, .rlim_max = 1000};
  ::signal(SIGXFSZ, SIG_IGN);
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(2);
  const std::string large(5000, 'x');
  const FileContents files[] = {{folder / "small", "new"}, {folder / "large", large}};
  try {
    WriteFiles(files, Overwrite::kYes);
    ::_exit(3);
  } catch (const Error& error) {
    ::_exit(error.code() == ErrorCode::kIoFailure ? 0 : 4);
  }
}

TEST(WriteFilesDeathTest, LeavesEverythingAsItWasOnAFullDisk) {
  GTEST_FLAG_SET(death_test_style, "fast");
  const test::TemporaryFolder folder;
  WriteFile(folder.path() / "small", "old", Overwrite::kNo);
  EXPECT_EXIT(WriteTwoWithFullDisk(folder.path()), testing::ExitedWithCode(0), "");
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("small"));
  EXPECT_EQ(test::ReadText(folder.path() / "small"), "old");
}

TEST(WriteFiles, WritesAllOrNone) {
  const test::TemporaryFolder folder;
  const FileContents files[] = {{folder.path() / "a", "1"}, {folder.path() / "b", "2"}};
  WriteFile(folder.path() / "b", "old", Overwrite::kNo);
  EXPECT_EQ(test::ErrorOf([&] { WriteFiles(files, Overwrite::kNo); }).code(),
            ErrorCode::kAlreadyExists);
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("b"));
  WriteFiles(files, Overwrite::kYes);
  EXPECT_EQ(test::ReadText(folder.path() / "a"), "1");
  EXPECT_EQ(test::ReadText(folder.path() / "b"), "2");
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("a", "b"));
}

// Both names are one file: the second finds it taken, and the first is gone again.
TEST(WriteFiles, TakeBackWhatHasItsNameAlready) {
  const test::TemporaryFolder folder;
  const FileContents files[] = {{folder.path() / "a", "1"}, {folder.path() / "a", "2"}};
  EXPECT_EQ(test::ErrorOf([&] { WriteFiles(files, Overwrite::kNo); }).code(),
            ErrorCode::kAlreadyExists);
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre());
}

TEST(WriteFile, LetsOneOfManyWritersWinWhole) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "f";
  std::atomic<int> winners{0};
  std::vector<std::jthread> writers;
  writers.reserve(8);
  for (int i = 0; i < 8; ++i) {
    writers.emplace_back([&, i] {
      try {
        WriteFile(path, std::string(100'000, static_cast<char>('a' + i)), Overwrite::kNo);
        ++winners;
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kAlreadyExists);
      }
    });
  }
  writers.clear();
  EXPECT_EQ(winners.load(), 1);
  const std::string text = test::ReadText(path);
  EXPECT_EQ(text, std::string(100'000, text.front()));
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("f"));
}

TEST(WriteFile, IsNeverSeenHalfWritten) {
  const test::TemporaryFolder folder;
  const fs::path path = folder.path() / "f";
  WriteFile(path, std::string(200'000, 'a'), Overwrite::kNo);
  std::atomic<bool> stop{false};
  std::jthread writer([&] {
    for (int i = 0; i < 20; ++i) {
      WriteFile(path, std::string(200'000, static_cast<char>('a' + i)), Overwrite::kYes);
    }
    stop = true;
  });
  while (!stop) {
    const MappedFile file(path);
    ASSERT_EQ(file.text().size(), 200'000);
    ASSERT_EQ(file.text().find_first_not_of(file.text().front()), std::string_view::npos);
  }
}

TEST(FileStream, HasItsNameOnceItIsWhole) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "new" / "f";
  {
    FileStream stream(file, Overwrite::kNo);
    stream.Append("one,");
    stream.Append("");
    stream.Append("two");
    EXPECT_FALSE(fs::exists(file));
    stream.Publish();
  }
  EXPECT_EQ(test::ReadText(file), "one,two");
  EXPECT_THAT(NamesIn(file.parent_path()), ElementsAre("f"));
}

TEST(FileStream, LeavesNothingWhereItIsGivenUp) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "f";
  test::WriteText(file, "old");
  EXPECT_EQ(test::ErrorOf([&] { FileStream(file, Overwrite::kNo).Append("new"); }).code(),
            ErrorCode::kAlreadyExists);
  FileStream(file, Overwrite::kYes).Append("new");
  EXPECT_EQ(test::ReadText(file), "old");
  EXPECT_THAT(NamesIn(folder.path()), ElementsAre("f"));
}

TEST(FileStream, RefusesANameThatSomebodyElseHasTakenMeanwhile) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "f";
  FileStream stream(file, Overwrite::kNo);
  stream.Append("new");
  test::WriteText(file, "theirs");
  EXPECT_EQ(test::ErrorOf([&] { stream.Publish(); }).code(), ErrorCode::kAlreadyExists);
  EXPECT_EQ(test::ReadText(file), "theirs");
}

TEST(CheckWritable, AsksBeforeLongWorkBegins) {
  const test::TemporaryFolder folder;
  test::WriteText(folder.path() / "f", "x");
  EXPECT_NO_THROW(CheckWritable(folder.path() / "new", Overwrite::kNo));
  EXPECT_NO_THROW(CheckWritable(folder.path() / "f", Overwrite::kYes));
  EXPECT_EQ(test::ErrorOf([&] { CheckWritable(folder.path() / "f", Overwrite::kNo); }).code(),
            ErrorCode::kAlreadyExists);
  EXPECT_EQ(test::ErrorOf([&] { CheckWritable(folder.path(), Overwrite::kYes); }).code(),
            ErrorCode::kIoFailure);
}

}  // namespace
}  // namespace kinebase
