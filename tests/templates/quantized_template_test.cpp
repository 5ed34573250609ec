#include "kinebase/templates/quantized_template.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "kinebase/core/error.h"
#include "support/files.h"
#include "templates/matrices.h"

namespace kinebase::test {
namespace {

using ::testing::HasSubstr;

TEST(Quantization, CountsValuesAtTheThresholdsAsZeroAndOne) {
  const TemplateMatrix matrix = MakeMatrix({{0, 0.25, 0.26, 0.74, 0.75, 1}});
  const QuantizedTemplate quantized = Quantize(matrix, 0.25, Profile::kPaper);
  ASSERT_EQ(quantized.column_count(), 1);
  EXPECT_EQ(quantized.columns[0].consistent, 0b110011U);
  EXPECT_EQ(quantized.columns[0].ones, 0b110000U);
  EXPECT_EQ(quantized.columns[0].scale, 1.0 / 4);
}

TEST(Quantization, WeighsColumnsInBonnOnly) {
  const TemplateMatrix matrix = MakeMatrix({{0, 1}, {0.5, 1}}, {1.5, 0.75});
  const QuantizedTemplate bonn = Quantize(matrix, 0.1, Profile::kBonn);
  EXPECT_EQ(bonn.columns[0].scale, 0.5 * 1.25);
  EXPECT_EQ(bonn.columns[1].scale, 0.875);
  EXPECT_EQ(bonn.matching, Profile::kBonn);
  const QuantizedTemplate paper = Quantize(matrix, 0.1, Profile::kPaper);
  EXPECT_EQ(paper.columns[0].scale, 0.5);
  EXPECT_EQ(paper.columns[1].scale, 1);
  EXPECT_EQ(paper.matching, Profile::kPaper);
}

TEST(Quantization, MakesAColumnFreeWhereNothingIsConsistent) {
  const QuantizedTemplate quantized =
      Quantize(MakeMatrix({{0.5, 0.2}}, {1.5}), 0.1, Profile::kBonn);
  EXPECT_EQ(quantized.columns[0].consistent, 0U);
  EXPECT_EQ(quantized.columns[0].ones, 0U);
  EXPECT_EQ(quantized.columns[0].scale, 0);
}

TEST(Quantization, UsesAllSixtyFourBits) {
  const QuantizedTemplate quantized =
      Quantize(MakeMatrix({std::vector<double>(64, 1.0)}), 0, Profile::kPaper);
  EXPECT_EQ(quantized.columns[0].consistent, ~std::uint64_t{0});
  EXPECT_EQ(quantized.columns[0].ones, ~std::uint64_t{0});
}

TEST(Quantization, RefusesThresholdsThatMakeAValueBothZeroAndOne) {
  const TemplateMatrix matrix = MakeMatrix({{0, 1}});
  for (const double delta : {-0.1, 0.5, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const Error error = ErrorOf([&] { (void)Quantize(matrix, delta, Profile::kBonn); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("quantisation threshold"));
  }
}

TEST(Quantization, RefusesMatricesThatAreNone) {
  TemplateMatrix empty = MakeMatrix({{0, 1}});
  empty.values.clear();
  empty.weights.clear();
  for (const TemplateMatrix& matrix :
       {empty, MakeMatrix({std::vector<double>(65, 0.0)}), MakeMatrix({{-0.5}})}) {
    const Error error = ErrorOf([&] { (void)Quantize(matrix, 0.1, Profile::kBonn); });
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace kinebase::test
