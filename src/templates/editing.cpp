#include "kinebase/templates/editing.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/features/feature_extraction.h"
#include "templates/matrix_builder.h"
#include "templates/matrix_check.h"

namespace kinebase {
namespace {

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

void CheckMatrix(const MotionTemplate& motion_template) {
  if (const std::string problem = internal::ProblemOf(motion_template.matrix); !problem.empty()) {
    Refuse(fmt::format("template '{}' has {}", motion_template.name, problem));
  }
}

void CheckColumnCount(std::int64_t columns) {
  if (columns < 1 || columns > kMostTemplateColumns) {
    Refuse(
        fmt::format("a template of {} columns; expected 1 to {}", columns, kMostTemplateColumns));
  }
}

void CheckColumns(const MotionTemplate& motion_template, ColumnRange columns) {
  const int count = motion_template.matrix.column_count();
  if (columns.first < 0 || columns.last < columns.first || columns.last >= count) {
    Refuse(fmt::format("columns {} to {} of template '{}'; it has columns 0 to {}", columns.first,
                       columns.last, motion_template.name, count - 1));
  }
}

void CheckRows(const MotionTemplate& motion_template, std::span<const int> rows) {
  for (const int row : rows) {
    if (row < 0 || row >= motion_template.matrix.feature_count) {
      Refuse(fmt::format("row {} of template '{}'; it has rows 0 to {}", row, motion_template.name,
                         motion_template.matrix.feature_count - 1));
    }
  }
}

// At least one, each sound, and all made for the same columns of the same recordings.
void CheckTogether(std::span<const MotionTemplate> templates) {
  if (templates.empty()) Refuse("no templates to put together; give at least one");
  const MotionTemplate& first = templates[0];
  for (const MotionTemplate& other : templates) {
    CheckMatrix(other);
    if (other.feature_set_hash != first.feature_set_hash ||
        other.matrix.feature_count != first.matrix.feature_count) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("template '{}' was made with feature set '{}' ({:016x}), '{}' with "
                              "'{}' ({:016x}); only templates of one set go together",
                              first.name, first.feature_set, first.feature_set_hash, other.name,
                              other.feature_set, other.feature_set_hash));
    }
    if (other.matrix.rate_hz != first.matrix.rate_hz) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("template '{}' has {} columns a second, '{}' has {}; only templates "
                              "of one rate go together",
                              first.name, first.matrix.rate_hz, other.name, other.matrix.rate_hz));
    }
  }
}

// A template that asks for something else than it did has no threshold of its own; what set the
// class off was measured, keyframes were chosen and hits were judged, for other columns.
void DropThreshold(MotionTemplate& motion_template) {
  motion_template.tau.reset();
  motion_template.tau_origin.clear();
  motion_template.calibration.reset();
  motion_template.contrast.reset();
  motion_template.marks.clear();
  motion_template.keyframes.clear();
}

void NoteChange(MotionTemplate& motion_template, const std::string& change) {
  DropThreshold(motion_template);
  if (!motion_template.origin.empty()) motion_template.origin += "; ";
  motion_template.origin += change;
}

void SetEntries(TemplateMatrix& matrix, std::span<const int> rows, ColumnRange columns,
                double value) {
  for (int c = columns.first; c <= columns.last; ++c) {
    double* column = matrix.values.data() + static_cast<std::ptrdiff_t>(c) * matrix.feature_count;
    for (const int row : rows) column[row] = value;
  }
}

void AppendAny(TemplateMatrix& matrix, int columns) {
  const std::vector<double> any(static_cast<std::size_t>(matrix.feature_count), kAnyValue);
  for (int i = 0; i < columns; ++i) internal::AppendColumn(matrix, any, 1.0);
}

void AppendMatrix(TemplateMatrix& matrix, const TemplateMatrix& more) {
  matrix.values.insert(matrix.values.end(), more.values.begin(), more.values.end());
  matrix.weights.insert(matrix.weights.end(), more.weights.begin(), more.weights.end());
}

// The first template without its matrix, the clips of all.
MotionTemplate StartFrom(std::span<const MotionTemplate> templates, std::string_view verb) {
  MotionTemplate result = templates[0];
  result.matrix = internal::EmptyLike(templates[0].matrix);
  result.origin = std::string(verb);
  DropThreshold(result);
  for (std::size_t i = 0; i < templates.size(); ++i) {
    const MotionTemplate& source = templates[i];
    result.origin += fmt::format("{}'{}'", i == 0 ? " " : ", ", source.name);
    result.rounds = std::max(result.rounds, source.rounds);
    if (i == 0) continue;
    result.name += " + " + source.name;
    result.clips.insert(result.clips.end(), source.clips.begin(), source.clips.end());
  }
  return result;
}

}  // namespace

ColumnRange ColumnsBetween(const TemplateMatrix& matrix, double start_s, double end_s) {
  ColumnRange columns{.first = -1, .last = -1};
  double time = 0;  // In columns of weight 1.
  for (int c = 0; c < matrix.column_count(); ++c) {
    const double weight = matrix.weights[static_cast<std::size_t>(c)];
    const double middle_s = (time + weight / 2) / matrix.rate_hz;
    time += weight;
    if (middle_s < start_s || middle_s > end_s) continue;
    if (columns.first < 0) columns.first = c;
    columns.last = c;
  }
  if (columns.first < 0) {
    Refuse(
        fmt::format("no column's middle lies between {:g} and {:g} s; the template lasts {:.2f} "
                    "s, a column about {:.3f} s",
                    start_s, end_s, time / matrix.rate_hz, 1 / matrix.rate_hz));
  }
  return columns;
}

int ColumnsOfDuration(double duration_s, double rate_hz) {
  const double columns = std::round(duration_s * rate_hz);
  if (!(duration_s > 0) || !(columns <= kMostTemplateColumns)) {
    Refuse(fmt::format("a duration of {:g} s; expected more than 0 and at most {:g} s", duration_s,
                       kMostTemplateColumns / rate_hz));
  }
  return std::max(1, static_cast<int>(columns));
}

MotionTemplate BlankTemplate(std::string name, const FeatureSet& features, int columns,
                             double rate_hz) {
  CheckColumnRate(features, rate_hz);
  CheckColumnCount(columns);
  MotionTemplate blank;
  blank.name = std::move(name);
  blank.feature_set = features.name;
  blank.feature_set_hash = features.hash;
  blank.origin = "drawn by hand";
  blank.matrix.rate_hz = rate_hz;
  blank.matrix.feature_count = features.feature_count();
  AppendAny(blank.matrix, columns);
  return blank;
}

MotionTemplate WithEntries(MotionTemplate motion_template, std::span<const int> rows,
                           ColumnRange columns, double value) {
  CheckMatrix(motion_template);
  CheckRows(motion_template, rows);
  CheckColumns(motion_template, columns);
  if (!(value >= 0 && value <= 1)) {
    Refuse(fmt::format("value {} of an entry; expected 0 to 1", value));
  }
  SetEntries(motion_template.matrix, rows, columns, value);
  NoteChange(motion_template,
             fmt::format("{} of {} rows set to {} in columns {} to {}", rows.size(),
                         motion_template.matrix.feature_count, value, columns.first, columns.last));
  return motion_template;
}

MotionTemplate RestrictToFeatures(MotionTemplate motion_template, std::span<const int> rows) {
  CheckMatrix(motion_template);
  CheckRows(motion_template, rows);
  std::vector<int> others;
  for (int row = 0; row < motion_template.matrix.feature_count; ++row) {
    if (std::ranges::find(rows, row) == rows.end()) others.push_back(row);
  }
  SetEntries(motion_template.matrix, others, {0, motion_template.matrix.column_count() - 1},
             kAnyValue);
  NoteChange(motion_template, fmt::format("restricted to {} of {} rows", rows.size(),
                                          motion_template.matrix.feature_count));
  return motion_template;
}

MotionTemplate CutTemplate(MotionTemplate motion_template, ColumnRange columns) {
  CheckMatrix(motion_template);
  CheckColumns(motion_template, columns);
  const TemplateMatrix whole =
      std::exchange(motion_template.matrix, internal::EmptyLike(motion_template.matrix));
  for (int c = columns.first; c <= columns.last; ++c) {
    internal::AppendColumn(motion_template.matrix, whole.Column(c),
                           whole.weights[static_cast<std::size_t>(c)]);
  }
  NoteChange(motion_template, fmt::format("cut to columns {} to {}", columns.first, columns.last));
  return motion_template;
}

MotionTemplate StretchTemplate(MotionTemplate motion_template, int columns) {
  CheckMatrix(motion_template);
  CheckColumnCount(columns);
  const TemplateMatrix whole =
      std::exchange(motion_template.matrix, internal::EmptyLike(motion_template.matrix));
  const double share = whole.total_weight() / columns;
  internal::ColumnMean mean(whole.feature_count);
  int from = 0;
  double left = whole.weights[0];  // Of column `from`.
  for (int c = 0; c < columns; ++c) {
    mean.Clear();
    for (double wanted = share; wanted > 0;) {
      const bool is_last = from + 1 == whole.column_count();
      // Rounding may leave the last column a little short.
      const double taken = is_last ? wanted : std::min(wanted, left);
      if (taken > 0) mean.Add(whole.Column(from), taken);
      wanted -= taken;
      left -= taken;
      if (left > 0 || is_last) continue;
      ++from;
      left = whole.weights[static_cast<std::size_t>(from)];
    }
    mean.AppendTo(motion_template.matrix);
    motion_template.matrix.weights.back() = 1;
  }
  NoteChange(motion_template, fmt::format("stretched to {} columns", columns));
  return motion_template;
}

MotionTemplate ExtendTemplate(MotionTemplate motion_template, int before, int after) {
  CheckMatrix(motion_template);
  if (before < 0 || after < 0) {
    Refuse(fmt::format("{} columns before and {} after; expected 0 or more", before, after));
  }
  CheckColumnCount(std::int64_t{before} + motion_template.matrix.column_count() + after);
  const TemplateMatrix middle =
      std::exchange(motion_template.matrix, internal::EmptyLike(motion_template.matrix));
  AppendAny(motion_template.matrix, before);
  AppendMatrix(motion_template.matrix, middle);
  AppendAny(motion_template.matrix, after);
  NoteChange(motion_template, fmt::format("extended by {} and {} columns", before, after));
  return motion_template;
}

MotionTemplate ConcatenateTemplates(std::span<const MotionTemplate> templates, int gap) {
  CheckTogether(templates);
  if (gap < 0) Refuse(fmt::format("a gap of {} columns; expected 0 or more", gap));
  std::int64_t columns = std::int64_t{gap} * (std::ssize(templates) - 1);
  for (const MotionTemplate& part : templates) columns += part.matrix.column_count();
  CheckColumnCount(columns);
  MotionTemplate result = StartFrom(templates, "one after the other:");
  for (std::size_t i = 0; i < templates.size(); ++i) {
    if (i > 0) AppendAny(result.matrix, gap);
    AppendMatrix(result.matrix, templates[i].matrix);
  }
  return result;
}

MotionTemplate CombineTemplates(std::span<const MotionTemplate> templates,
                                const LearnOptions& options) {
  CheckTogether(templates);
  std::vector<TemplateMatrix> matrices;
  matrices.reserve(templates.size());
  for (const MotionTemplate& source : templates) matrices.push_back(source.matrix);
  LearnedMatrix learned = LearnTemplate(matrices, options);
  MotionTemplate result = StartFrom(templates, "combined from");
  result.learning = options.profile;
  result.rounds = static_cast<int>(learned.largest_costs.size());
  result.matrix = std::move(learned.matrix);
  return result;
}

}  // namespace kinebase
