// Template matrices for tests: read from golden results, made up, or drawn at random.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/templates/motion_template.h"
#include "support/files.h"

namespace kinebase::test {

inline double NumberIn(const CsvTable& table, std::size_t row, std::size_t column) {
  return ParseDouble(table.rows.at(row).at(column)).value();
}

// `column, weight, F1, F2, …`; without `weight` every column weighs 1.
inline TemplateMatrix ReadMatrix(const std::filesystem::path& path) {
  const CsvTable table = ReadCsv(path);
  const std::optional<std::size_t> weight = table.FindColumn("weight");
  const std::size_t first = table.Column("F1");
  TemplateMatrix matrix;
  matrix.rate_hz = 30;
  matrix.feature_count = static_cast<int>(table.columns.size() - first);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    matrix.weights.push_back(weight ? NumberIn(table, row, *weight) : 1.0);
    for (std::size_t column = first; column < table.columns.size(); ++column) {
      matrix.values.push_back(NumberIn(table, row, column));
    }
  }
  return matrix;
}

// One list for each column; all of one length.
inline TemplateMatrix MakeMatrix(const std::vector<std::vector<double>>& columns,
                                 std::vector<double> weights = {}) {
  TemplateMatrix matrix;
  matrix.rate_hz = 30;
  matrix.feature_count = static_cast<int>(columns.at(0).size());
  for (const auto& column : columns) {
    matrix.values.insert(matrix.values.end(), column.begin(), column.end());
  }
  matrix.weights = std::move(weights);
  if (matrix.weights.empty()) matrix.weights.assign(columns.size(), 1.0);
  return matrix;
}

// Numbers from a seed, the same with every standard library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  // 0 … limit − 1.
  int Below(int limit) { return static_cast<int>(Next() % static_cast<std::uint32_t>(limit)); }
  double Unit() { return Next() / 4294967296.0; }
  std::uint64_t Word() {
    const std::uint64_t high = Next();
    return high << 32U | Next();
  }

 private:
  std::uint32_t Next() { return static_cast<std::uint32_t>(engine_()); }

  std::mt19937 engine_;
};

// What a performance looks like: features hold or fail for a while.
inline TemplateMatrix RandomPerformance(Random& random, int columns, int features) {
  std::vector<std::vector<double>> values(columns, std::vector<double>(features));
  for (int feature = 0; feature < features; ++feature) {
    double state = random.Below(2);
    for (int column = 0; column < columns; ++column) {
      if (random.Below(6) == 0) state = 1 - state;
      values[column][feature] = state;
    }
  }
  return MakeMatrix(values);
}

// What an average looks like: values between 0 and 1, many of them 0 or 1, weights about 1.
inline TemplateMatrix RandomMatrix(Random& random, int columns, int features) {
  TemplateMatrix matrix = RandomPerformance(random, columns, features);
  for (double& value : matrix.values) {
    if (random.Below(3) == 0) value = random.Unit();
  }
  for (double& weight : matrix.weights) weight = 0.25 + 1.5 * random.Unit();
  return matrix;
}

inline void ExpectNear(const TemplateMatrix& actual, const TemplateMatrix& expected,
                       double tolerance) {
  ASSERT_EQ(actual.feature_count, expected.feature_count);
  ASSERT_EQ(actual.column_count(), expected.column_count());
  ASSERT_EQ(actual.values.size(), expected.values.size());
  for (std::size_t i = 0; i < expected.weights.size(); ++i) {
    EXPECT_NEAR(actual.weights[i], expected.weights[i], tolerance) << "column " << i;
  }
  for (std::size_t i = 0; i < expected.values.size(); ++i) {
    EXPECT_NEAR(actual.values[i], expected.values[i], tolerance)
        << "column " << i / expected.feature_count << ", row " << i % expected.feature_count;
  }
}

}  // namespace kinebase::test
