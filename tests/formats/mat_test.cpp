// MAT-files. The good_scipy files in fuzz/corpus/mat were written by SciPy, the others by hand.

#include "kinebase/formats/mat.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <matio.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::filesystem::path Sample(std::string_view name) {
  return std::filesystem::path(KINEBASE_SOURCE_DIR) / "fuzz" / "corpus" / "mat" / name;
}

std::vector<std::string> NamesOf(const MatFile& mat) {
  std::vector<std::string> names;
  for (const MatVariable& variable : mat.variables) names.push_back(variable.name);
  return names;
}

TEST(MatReader, ReadsCompressedAndPlainFilesTheSame) {
  const MatFile mat = ReadMat(Sample("good_scipy.mat"));
  EXPECT_EQ(ReadMat(Sample("good_scipy_plain.mat")), mat);
  EXPECT_EQ(mat.header, "MATLAB 5.0 MAT-file, made up");
  EXPECT_THAT(NamesOf(mat), ElementsAre("skel", "numbers", "single", "i8", "u32", "cube"));
  EXPECT_THAT(mat.diagnostics, IsEmpty());
}

TEST(MatReader, ReadsEveryClass) {
  const MatFile mat = ReadMat(Sample("good_scipy.mat"));
  const MatArray& numbers = *mat.Find("numbers");  // By columns.
  EXPECT_EQ(numbers.type, MatClass::kDouble);
  EXPECT_THAT(numbers.dims, ElementsAre(2, 3));
  EXPECT_THAT(numbers.numbers, ElementsAre(0, 3, 1, 4, 2, 5));
  EXPECT_EQ(mat.Find("single")->type, MatClass::kSingle);
  EXPECT_EQ(mat.Find("single")->numbers[0], 1.5);
  EXPECT_TRUE(std::isnan(mat.Find("single")->numbers[1]));
  EXPECT_EQ(mat.Find("i8")->type, MatClass::kInt8);
  EXPECT_THAT(mat.Find("i8")->numbers, ElementsAre(-1));
  EXPECT_THAT(mat.Find("u32")->numbers, ElementsAre(4294967295.));
  EXPECT_THAT(mat.Find("cube")->dims, ElementsAre(2, 2, 2));

  const MatArray& skel = *mat.Find("skel");
  EXPECT_EQ(skel.type, MatClass::kStruct);
  EXPECT_EQ(skel.size(), 2);
  EXPECT_EQ(skel.Field("name", 0)->Text(), "lhip");
  EXPECT_EQ(skel.Field("name", 1)->Text(), "Zürich");
  EXPECT_EQ(skel.Field("name", 2), nullptr);
  EXPECT_EQ(skel.Field("other"), nullptr);
  const MatArray& cells = *skel.Field("value", 1);
  EXPECT_EQ(cells.type, MatClass::kCell);
  EXPECT_THAT(cells.dims, ElementsAre(2, 2));
  EXPECT_THAT(cells.elements[0].numbers, ElementsAre(1, 2, 3));
  EXPECT_EQ(cells.elements[1].size(), 0);  // Down the first column.
  EXPECT_EQ(cells.elements[2].Text(), "text");
  EXPECT_TRUE(cells.elements[3].is_logical);
  EXPECT_THAT(cells.elements[3].numbers, ElementsAre(1, 0));
}

TEST(MatReader, ReadsBigEndianFiles) {
  const MatFile mat = ReadMat(Sample("good_big_endian.mat"));
  EXPECT_THAT(mat.Find("x")->numbers, ElementsAre(1, -2, 300));
  EXPECT_EQ(mat.Find("t")->Text(), "é!");
  EXPECT_THAT(mat.Find("c")->elements.at(0).numbers, ElementsAre(2.5));
}

TEST(MatReader, ReadsDataInTagsAndEmptyElements) {
  EXPECT_THAT(ReadMat(Sample("good_small_elements.mat")).Find("xy")->numbers, ElementsAre(7, 9));
  const MatFile empty = ReadMat(Sample("good_empty_elements.mat"));
  EXPECT_THAT(empty.Find("c")->elements, ElementsAre(MatArray(), MatArray()));
  EXPECT_THAT(ReadMat(Sample("good_no_variables.mat")).variables, IsEmpty());
}

TEST(MatReader, KeepsWhatItDoesNotInterpret) {
  const MatFile mat = ReadMat(Sample("good_kept_kinds.mat"));
  EXPECT_THAT(NamesOf(mat), ElementsAre("sparse", "complex", "i64", "x"));
  for (const char* name : {"sparse", "complex", "i64"}) {
    EXPECT_EQ(mat.Find(name)->type, MatClass::kOther) << name;
  }
  EXPECT_EQ(ParseMat(FormatMat(mat), "again.mat"), mat);
}

TEST(MatReader, SaysWhatIsWrongAndWhere) {
  const struct {
    std::string_view file;
    std::string_view message;
    std::int64_t byte;
  } cases[] = {
      {"bad_empty.mat", "expected a MAT-file with a header of 128 bytes, found 0 bytes", 0},
      {"bad_text.mat", "expected a MAT-file, found 'x = [1 2 3];", 126},
      {"bad_version_4.mat", "version 4", -1},
      {"bad_version_7_3.mat", "'-v7'", -1},
      {"bad_hdf5.mat", "is an HDF5 file", -1},
      {"bad_cut.mat", "an element of 72 bytes, but 64 are left", 128},
      {"bad_cut_tag.mat", "is cut off", 208},
      {"bad_element_size.mat", "an element of 4294967295 bytes", 128},
      {"bad_inner_size.mat", "an element of 160 bytes, but 16 are left", 184},
      {"bad_dimensions_not_filled.mat", "16 bytes of numbers do not fill 1 × 3", 184},
      {"bad_huge_dimensions.mat", "dimensions 2147483647 × 2147483647 × 4 of no array", 152},
      {"bad_negative_dimensions.mat", "a dimension of -1", 152},
      {"bad_one_dimension.mat", "4 bytes of dimensions", 152},
      {"bad_huge_cell.mat", "2147483647 elements, but only 0 bytes are left", 184},
      {"bad_field_length.mat", "field names of 0 bytes", 184},
      {"bad_characters.mat", "2 characters do not fill 3 × 3", 184},
      {"bad_number_of_class.mat", "300 in an array of class uint8", 184},
      {"bad_cell_of_numbers.mat", "expected an array, found an element of type 9", 184},
      {"bad_type.mat", "expected a variable, found an element of type 99", 128},
      {"bad_zlib.mat", "damaged or cut off", 128},
      {"bad_nesting.mat", "more than 64 levels", -2},
  };
  for (const auto& [file, message, byte] : cases) {
    const Error error = test::ErrorOf([&] { (void)ReadMat(Sample(file)); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile) << file;
    EXPECT_THAT(error.message(), HasSubstr(message)) << file;
    if (byte != -2) {
      EXPECT_EQ(error.place().byte, byte) << file;
    }
  }
}

TEST(MatReader, CountsBytesOfCompressedVariablesInWhatTheyUnpackTo) {
  MatFile mat;
  mat.variables.push_back({"good", false, MatScalar(1)});
  mat.variables.push_back({"wrong", false, MatScalar(1)});
  mat.variables[1].value.dims = {1, 3};
  const std::string bytes = FormatMat(mat);
  mat.variables.pop_back();
  const auto second = static_cast<std::int64_t>(FormatMat(mat).size());
  const Error error = test::ErrorOf([&] { (void)ParseMat(bytes, "x.mat"); });
  EXPECT_EQ(error.place().byte, second);
  EXPECT_THAT(error.message(), HasSubstr("(byte 56 of what the variable unpacks to)"));
}

TEST(MatReader, StopsUnpackingWhereAFileWasMadeToFillAMemory) {
  MatFile mat;
  mat.variables.push_back({"zeros", false, MatColumn(std::vector<double>(1 << 20, 0))});
  const std::string bytes = FormatMat(mat);
  EXPECT_EQ(ParseMat(bytes, "zeros.mat"), mat);
  const Error error = test::ErrorOf(
      [&] { (void)ParseMat(bytes, "zeros.mat", {.unpacked_limit = std::size_t{1} << 20}); });
  EXPECT_THAT(error.message(), HasSubstr("does not compress"));
}

TEST(MatReader, ReadsTheOriginalCacheFilesBackAsWritten) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto files = test::FilesBelow(test::TestData("data/hdm05/fk_oracle"), ".mat");
  ASSERT_EQ(files.size(), 8);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const MatFile mat = ReadMat(file);
    EXPECT_THAT(NamesOf(mat), ElementsAre("skel", "mot"));
    EXPECT_THAT(mat.diagnostics, IsEmpty());
    EXPECT_EQ(ParseMat(FormatMat(mat), file), mat);
  }
}

// matio is another reader of the format.
TEST(MatWriter, WritesWhatMatioReads) {
  MatFile mat;
  mat.variables.push_back(
      {"s", false,
       MatStruct({{"name", MatText("thorax")},
                  {"wide", MatText("Zürich")},
                  {"cells", MatCells({MatMatrix(2, {1, 2, 3, 4}), MatArray()})},
                  {"a_field_with_a_name_of_more_than_31_characters", MatScalar(-2.5)}})});
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "written.mat";
  test::WriteText(path, FormatMat(mat));

  const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY),
                                                          &Mat_Close);
  ASSERT_NE(file, nullptr);
  const std::unique_ptr<matvar_t, decltype(&Mat_VarFree)> s(Mat_VarRead(file.get(), "s"),
                                                            &Mat_VarFree);
  ASSERT_NE(s, nullptr);
  const auto field = [&](const char* name) {
    return Mat_VarGetStructFieldByName(s.get(), name, 0);
  };
  const matvar_t* const name = field("name");
  EXPECT_EQ(std::string(static_cast<const char*>(name->data), name->dims[1]), "thorax");
  const matvar_t* const wide = field("wide");
  EXPECT_EQ(wide->dims[1], 6);
  EXPECT_EQ(static_cast<const std::uint16_t*>(wide->data)[1], 0xFC);  // ü
  matvar_t* const matrix = Mat_VarGetCell(field("cells"), 0);
  EXPECT_EQ(matrix->dims[0], 2);
  EXPECT_EQ(static_cast<const double*>(matrix->data)[3], 4);
  EXPECT_EQ(Mat_VarGetCell(field("cells"), 1)->nbytes, 0);
  EXPECT_EQ(
      *static_cast<const double*>(field("a_field_with_a_name_of_more_than_31_characters")->data),
      -2.5);
}

TEST(MatWriter, WritesTheSameBytesEveryTime) {
  MatFile mat;
  mat.variables.push_back({"x", true, MatColumn({1, 2, 3})});
  EXPECT_EQ(FormatMat(mat), FormatMat(mat));
  EXPECT_EQ(ParseMat(FormatMat(mat), "x.mat"), mat);
}

std::string AnyName() {
  return "n" + *rc::gen::container<std::string>(rc::gen::elementOf(std::string("abcXYZ019_")));
}

std::vector<double> NumbersOf(MatClass type, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    switch (type) {
      case MatClass::kDouble:
        numbers.push_back(*rc::gen::arbitrary<double>());
        break;
      case MatClass::kSingle:
        numbers.push_back(static_cast<double>(*rc::gen::arbitrary<float>()));
        break;
      case MatClass::kInt8:
        numbers.push_back(*rc::gen::arbitrary<std::int8_t>());
        break;
      case MatClass::kUint8:
        numbers.push_back(*rc::gen::arbitrary<std::uint8_t>());
        break;
      case MatClass::kInt16:
        numbers.push_back(*rc::gen::arbitrary<std::int16_t>());
        break;
      case MatClass::kUint16:
        numbers.push_back(*rc::gen::arbitrary<std::uint16_t>());
        break;
      case MatClass::kInt32:
        numbers.push_back(*rc::gen::arbitrary<std::int32_t>());
        break;
      default:
        numbers.push_back(*rc::gen::arbitrary<std::uint32_t>());
    }
  }
  return numbers;
}

MatArray AnyMatArray(int depth) {
  const int kinds = static_cast<int>(depth > 2 ? MatClass::kChar : MatClass::kStruct) + 1;
  MatArray array{.type = static_cast<MatClass>(*rc::gen::inRange(0, kinds))};
  array.dims = *rc::gen::container<std::vector<std::int32_t>>(
      *rc::gen::element<std::size_t>(2, 2, 3), rc::gen::inRange(0, 4));
  if (array.type == MatClass::kChar) {
    for (std::size_t i = 0; i < array.size(); ++i) {
      array.characters.push_back(*rc::gen::arbitrary<char16_t>());
    }
    return array;
  }
  std::size_t elements = array.type == MatClass::kCell ? array.size() : 0;
  if (array.type == MatClass::kStruct) {
    array.fields = *rc::gen::container<std::vector<std::string>>(*rc::gen::inRange(0, 3),
                                                                 rc::gen::exec(&AnyName));
    elements = array.size() * array.fields.size();
  }
  for (std::size_t i = 0; i < elements; ++i) array.elements.push_back(AnyMatArray(depth + 1));
  if (array.type < MatClass::kChar) array.numbers = NumbersOf(array.type, array.size());
  return array;
}

RC_GTEST_PROP(Mat, ComesBackAsItWasWritten, ()) {
  MatFile mat;
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    mat.variables.push_back({AnyName(), *rc::gen::arbitrary<bool>(), AnyMatArray(0)});
  }
  RC_ASSERT(ParseMat(FormatMat(mat), "any.mat") == mat);
}

}  // namespace
}  // namespace kinebase
