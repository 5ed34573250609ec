// Back to real time. Profile bonn stretches and merges whole columns, as the authors' toolbox does;
// profile paper cuts columns where a unit of time ends, as the paper describes (Sect. 4.1).
#include <algorithm>
#include <cmath>

#include "kinebase/templates/learning.h"
#include "templates/matrix_builder.h"

namespace kinebase {
namespace {

using internal::AppendColumn;
using internal::ColumnMean;
using internal::DropLastColumn;
using internal::EmptyLike;

// A lighter rest at the end does not stand as a column of its own; in bonn no column does.
constexpr double kLeastWeight = 0.75;

// A column of weight w becomes round(w) columns, halves up, at least one.
TemplateMatrix Expand(const TemplateMatrix& matrix) {
  TemplateMatrix expanded = EmptyLike(matrix);
  for (int c = 0; c < matrix.column_count(); ++c) {
    const double weight = matrix.weights[c];
    const double copies = std::max(1.0, std::floor(weight + 0.5));
    for (double i = 0; i < copies; ++i) {
      AppendColumn(expanded, matrix.Column(c), weight / copies);
    }
  }
  return expanded;
}

// Columns [begin, end) become one; a single column is taken over bit for bit.
void AppendMerged(TemplateMatrix& out, const TemplateMatrix& matrix, int begin, int end) {
  if (end - begin == 1) {
    AppendColumn(out, matrix.Column(begin), matrix.weights[begin]);
    return;
  }
  ColumnMean mean(matrix.feature_count);
  for (int c = begin; c < end; ++c) mean.Add(matrix.Column(c), matrix.weights[c]);
  mean.AppendTo(out);
}

// Neighbours are merged until they weigh enough.
TemplateMatrix Contract(const TemplateMatrix& matrix) {
  TemplateMatrix contracted = EmptyLike(matrix);
  int begin = 0;
  while (begin < matrix.column_count()) {
    double weight = 0;
    int end = begin;
    while (end < matrix.column_count() && weight < kLeastWeight) weight += matrix.weights[end++];
    if (weight < kLeastWeight && begin > 0) {
      // The toolbox joins a light rest with the column before it and loses the others that had been
      // merged with that one. Kept: the authors' templates came about this way.
      DropLastColumn(contracted);
      --begin;
    }
    AppendMerged(contracted, matrix, begin, end);
    begin = end;
  }
  return contracted;
}

TemplateMatrix CutToUnits(const TemplateMatrix& matrix) {
  TemplateMatrix cut = EmptyLike(matrix);
  ColumnMean unit(matrix.feature_count);
  for (int c = 0; c < matrix.column_count(); ++c) {
    double left = matrix.weights[c];
    while (left > 0) {
      const double missing = 1 - unit.weight();
      const bool fills = left >= missing;
      unit.Add(matrix.Column(c), fills ? missing : left);
      left -= fills ? missing : left;
      if (!fills) continue;
      unit.AppendTo(cut);
      cut.weights.back() = 1;
      unit.Clear();
    }
  }
  if (unit.weight() == 0) return cut;
  if (unit.weight() >= kLeastWeight || cut.weights.empty()) {
    unit.AppendTo(cut);
    return cut;
  }
  ColumnMean last(matrix.feature_count);
  last.Add(cut.Column(cut.column_count() - 1), 1);
  TemplateMatrix rest = EmptyLike(matrix);
  unit.AppendTo(rest);
  last.Add(rest.Column(0), unit.weight());
  DropLastColumn(cut);
  last.AppendTo(cut);
  return cut;
}

}  // namespace

TemplateMatrix Unwarp(const TemplateMatrix& matrix, Profile profile) {
  if (profile == Profile::kPaper) return CutToUnits(matrix);
  return Expand(Contract(Expand(matrix)));
}

}  // namespace kinebase
