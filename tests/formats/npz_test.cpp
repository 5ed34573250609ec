// Archives of arrays. The good files in fuzz/corpus/npz were written by NumPy.

#include "kinebase/formats/npz.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::filesystem::path Sample(std::string_view name) {
  return std::filesystem::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "npz" / name;
}

std::vector<std::string> NamesOf(const NpzArchive& archive) {
  std::vector<std::string> names;
  for (const NpzArray& array : archive.arrays) names.push_back(array.name);
  return names;
}

template <typename T>
const std::vector<T>& Items(const NpzArchive& archive, std::string_view name) {
  return std::get<std::vector<T>>(archive.Find(name)->items);
}

TEST(NpzReader, ReadsStoredAndDeflatedArchivesTheSame) {
  const NpzArchive stored = ReadNpz(Sample("good_numpy_stored.npz"));
  EXPECT_EQ(ReadNpz(Sample("good_numpy_deflated.npz")), stored);
  EXPECT_THAT(NamesOf(stored), ElementsAre("f8", "f4", "i1", "u8", "names", "one"));
  EXPECT_THAT(stored.Find("f8")->shape, ElementsAre(2, 3));
  EXPECT_THAT(Items<double>(stored, "f8"), ElementsAre(0, .2, .4, .6000000000000001, .8, 1));
  EXPECT_THAT(Items<float>(stored, "f4"), ElementsAre(1.5F));
  EXPECT_THAT(Items<std::int8_t>(stored, "i1"), ElementsAre(-1));
  EXPECT_THAT(Items<std::uint64_t>(stored, "u8"), ElementsAre(18446744073709551615U));
  EXPECT_THAT(Items<std::string>(stored, "names"), ElementsAre("root", "lhip"));
  EXPECT_EQ(stored.Find("two"), nullptr);
  EXPECT_THAT(stored.diagnostics, IsEmpty());
}

TEST(NpzReader, KeepsWhatItDoesNotInterpret) {
  const NpzArchive archive = ReadNpz(Sample("good_kept_members.npz"));
  EXPECT_THAT(NamesOf(archive), ElementsAre("x"));
  ASSERT_EQ(archive.members.size(), 4);
  EXPECT_EQ(archive.members[0].name, "objects.npy");
  EXPECT_EQ(archive.members[3], (NpzMember{"readme.txt", "kept"}));
  EXPECT_EQ(archive.diagnostics.size(), 3);  // Objects, complex and half-precision numbers.
  EXPECT_EQ(ParseNpz(FormatNpz(archive), "again.npz"), archive);
}

TEST(NpzReader, SaysWhichMemberIsWrong) {
  const struct {
    std::string_view file;
    std::string_view message;
  } cases[] = {
      {"bad_empty.npz", "expected a ZIP archive of arrays (NPZ)"},
      {"bad_text.npz", "expected a ZIP archive of arrays (NPZ), found 'frame,time_s"},
      {"bad_cut.npz", "is no whole ZIP archive"},
      {"bad_duplicate.npz", "holds 'a.npy' twice"},
      {"bad_bzip2.npz", "'a.npy' is encrypted or packed in an unusual way"},
      {"bad_encrypted.npz", "'a.npy' is encrypted or packed in an unusual way"},
      {"bad_checksum.npz", "'a.npy': CRC error"},
      {"bad_lying_size.npz", "'a.npy'"},
  };
  for (const auto& [file, message] : cases) {
    const Error error = test::ErrorOf([&] { (void)ReadNpz(Sample(file)); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << file;
    EXPECT_THAT(error.message(), HasSubstr(message)) << file;
    EXPECT_EQ(error.place().file, Sample(file));
  }
}

TEST(NpzReader, StopsUnpackingWhereAnArchiveWasMadeToFillAMemory) {
  const NpzArchive zeros{.arrays = {{"zeros", {1 << 20}, std::vector<double>(1 << 20, 0)}}};
  const std::string bytes = FormatNpz(zeros);
  ASSERT_LT(bytes.size() * 100, 8U << 20);
  EXPECT_EQ(ParseNpz(bytes, "zeros.npz"), zeros);
  const Error error = test::ErrorOf(
      [&] { (void)ParseNpz(bytes, "zeros.npz", {.unpacked_limit = std::size_t{1} << 20}); });
  EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
  EXPECT_THAT(error.message(), HasSubstr("write it with numpy.savez"));
}

TEST(NpzWriter, WritesTheSameBytesEveryTime) {
  const NpzArchive archive{.arrays = {{"a", {2}, std::vector<double>{1, 2}}}};
  EXPECT_EQ(FormatNpz(archive), FormatNpz(archive));
}

TEST(NpzWriter, RefusesTwoArraysOfOneName) {
  const NpzArray array{"a", {1}, std::vector<double>{1}};
  const NpzArchive archive{.arrays = {array, array}};
  EXPECT_EQ(test::ErrorOf([&] { (void)FormatNpz(archive); }).code(), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace kinebase
