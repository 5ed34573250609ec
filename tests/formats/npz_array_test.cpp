// Arrays of NumPy. The good files in fuzz/corpus/npz were written by NumPy; what they hold is what
// was given to it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/formats/npz.h"
#include "support/files.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::filesystem::path Sample(std::string_view name) {
  return std::filesystem::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "npz" / name;
}

NpzArray Read(std::string_view name) {
  return ParseNpy(test::ReadText(Sample(name)), "a", Sample(name));
}

template <typename T>
const std::vector<T>& Items(const NpzArray& array) {
  return std::get<std::vector<T>>(array.items);
}

// An array of version 1 with this header.
std::string Npy(std::string header, std::string_view items) {
  header += '\n';
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  return bytes + header + std::string(items);
}

Error ErrorOfNpy(const std::string& bytes) {
  return test::ErrorOf([&] { (void)ParseNpy(bytes, "a", "x.npy"); });
}

TEST(NpyReader, ReadsBigEndianNumbers) {
  const NpzArray array = Read("good_numpy_big_endian.npy");
  EXPECT_THAT(array.shape, ElementsAre(2, 3));
  const auto& items = Items<double>(array);
  ASSERT_EQ(items.size(), 6);
  EXPECT_EQ(items[0], 1.5);
  EXPECT_EQ(items[1], -2);
  EXPECT_TRUE(std::isnan(items[2]));
  EXPECT_EQ(items[4], 1e300);
  EXPECT_TRUE(std::signbit(items[5]));
}

TEST(NpyReader, BringsFortranOrderIntoCOrder) {
  const NpzArray array = Read("good_numpy_fortran.npy");
  EXPECT_THAT(array.shape, ElementsAre(2, 3, 4));
  std::vector<std::int16_t> expected;
  for (std::int16_t i = 0; i < 24; ++i) expected.push_back(i);
  EXPECT_EQ(Items<std::int16_t>(array), expected);
}

TEST(NpyReader, ReadsTextOfEitherKindAndByteOrder) {
  EXPECT_THAT(Items<std::string>(Read("good_numpy_text.npy")),
              ElementsAre("LFHD", "", "Zürich", "𝄞"));
  const NpzArray table = Read("good_numpy_text_big_endian.npy");
  EXPECT_THAT(table.shape, ElementsAre(2, 2));
  EXPECT_THAT(Items<std::string>(table), ElementsAre("a", "bc", "déf", ""));
  EXPECT_THAT(Items<std::string>(Read("good_numpy_bytes.npy")), ElementsAre("ab", "c"));
}

TEST(NpyReader, TakesPythonsEscapesAsTheBytesThatTheyStandFor) {
  EXPECT_THAT(Items<std::string>(Read("good_numpy_escaped_bytes.npy")), ElementsAre("caf\xE9"));
}

TEST(NpyReader, ReadsLaterVersionsOfTheHeader) {
  EXPECT_THAT(Items<std::uint32_t>(Read("good_numpy_version_2.npy")), ElementsAre(1, 2));
  const NpzArray single = Read("good_numpy_version_3.npy");
  EXPECT_THAT(single.shape, IsEmpty());
  EXPECT_THAT(Items<std::int64_t>(single), ElementsAre(7));
}

TEST(NpyReader, ReadsTruthValuesAndNothing) {
  EXPECT_THAT(Items<bool>(Read("good_numpy_truth.npy")), ElementsAre(true, false, true));
  const NpzArray nothing = Read("good_numpy_nothing.npy");
  EXPECT_THAT(nothing.shape, ElementsAre(0, 5));
  EXPECT_THAT(Items<float>(nothing), IsEmpty());
}

TEST(NpyReader, TakesTheHeadersKeysInAnyOrderAndQuotes) {
  const NpzArray array =
      ParseNpy(Npy(R"({"shape":(2L,),"fortran_order":True,"descr":"|u1"})", "\x05\x06"), "a", "");
  EXPECT_THAT(Items<std::uint8_t>(array), ElementsAre(5, 6));
}

TEST(NpyReader, SaysWhatIsWrongAndWhere) {
  const struct {
    std::string header;
    std::string_view message;
    std::int64_t byte;
  } cases[] = {
      {"{'descr': '<f8', 'fortran_order': False, 'shape': (3,)}",
       "shape (3) of items of 8 bytes needs more than the 16 bytes", 66},
      {"{'descr': '<f8', 'fortran_order': 0, 'shape': (2,)}", "expected True or False", 44},
      {"{'descr': '<f8', 'shape': (2,)}", "lacks 'fortran_order'", 41},
      {"{'descr': '<f8', 'fortran_order': False, 'shape': (2.5,)}", "expected ')'", 62},
      {"{'descr: 1}", "a quote in the header does not end", 11},
  };
  for (const auto& [header, message, byte] : cases) {
    const Error error = ErrorOfNpy(Npy(header, std::string(16, '\0')));
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    EXPECT_THAT(error.message(), HasSubstr(message));
    EXPECT_THAT(error.message(), HasSubstr("array 'a'"));
    EXPECT_EQ(error.place().byte, byte) << error.what();
  }
}

TEST(NpyReader, SaysThatObjectsAndStructuresAreNotInterpreted) {
  for (const char* type : {"'|O'", "'<c16'", "'<f2'", "'|V8'", "[('x', '<f8')]"}) {
    const std::string header =
        std::string("{'descr': ") + type + ", 'fortran_order': False, 'shape': (1,)}";
    EXPECT_EQ(ErrorOfNpy(Npy(header, std::string(16, '\0'))).code(), ErrorCode::kMismatch) << type;
  }
}

TEST(NpyWriter, WritesWhatNumpyWrites) {
  const NpzArray array{"a", {1, 2}, std::vector<float>{1, -2}};
  std::string expected("\x93NUMPY\x01\x00\x76\x00", 10);
  expected += "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }";
  expected.resize(127, ' ');
  expected += '\n';
  expected += std::string("\x00\x00\x80\x3F\x00\x00\x00\xC0", 8);
  EXPECT_EQ(FormatNpy(array), expected);
}

TEST(NpyWriter, RefusesItemsThatDoNotFillTheShape) {
  const NpzArray array{"a", {2, 2}, std::vector<double>{1, 2, 3}};
  EXPECT_EQ(test::ErrorOf([&] { (void)FormatNpy(array); }).code(), ErrorCode::kInvalidArgument);
}

template <typename T>
std::vector<T> AnyItems(std::size_t count) {
  return *rc::gen::container<std::vector<T>>(count, rc::gen::arbitrary<T>());
}

std::string AnyText() {
  // Bytes of every kind, but zeros at the end, which NumPy takes for padding.
  std::string text = *rc::gen::arbitrary<std::string>();
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

NpzItems ItemsOfAnyType(std::size_t count) {
  switch (*rc::gen::inRange(0, 12)) {
    case 0:
      return AnyItems<double>(count);
    case 1:
      return AnyItems<float>(count);
    case 2:
      return AnyItems<std::int8_t>(count);
    case 3:
      return AnyItems<std::int16_t>(count);
    case 4:
      return AnyItems<std::int32_t>(count);
    case 5:
      return AnyItems<std::int64_t>(count);
    case 6:
      return AnyItems<std::uint8_t>(count);
    case 7:
      return AnyItems<std::uint16_t>(count);
    case 8:
      return AnyItems<std::uint32_t>(count);
    case 9:
      return AnyItems<std::uint64_t>(count);
    case 10:
      return AnyItems<bool>(count);
    default: {
      std::vector<std::string> texts;
      for (std::size_t i = 0; i < count; ++i) texts.push_back(AnyText());
      return texts;
    }
  }
}

NpzArray AnyArray(std::string name) {
  NpzArray array{.name = std::move(name)};
  std::size_t count = 1;
  for (int rank = *rc::gen::inRange(0, 4); rank > 0; --rank) {
    array.shape.push_back(*rc::gen::inRange<std::size_t>(0, 5));
    count *= array.shape.back();
  }
  array.items = ItemsOfAnyType(count);
  return array;
}

RC_GTEST_PROP(Npy, ComesBackAsItWasWritten, ()) {
  const NpzArray array = AnyArray("a");
  RC_ASSERT(ParseNpy(FormatNpy(array), "a", "") == array);
}

RC_GTEST_PROP(Npz, ComesBackAsItWasWritten, ()) {
  NpzArchive archive;
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) {
    archive.arrays.push_back(AnyArray("array" + std::to_string(i)));
  }
  if (*rc::gen::arbitrary<bool>()) {
    archive.members.push_back({"other.bin", *rc::gen::arbitrary<std::string>()});
  }
  RC_ASSERT(ParseNpz(FormatNpz(archive), "") == archive);
}

}  // namespace
}  // namespace kinebase
