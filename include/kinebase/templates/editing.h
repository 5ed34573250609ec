// Templates by hand: drawn from scratch, changed entry by entry, cut, stretched, put together.
//
// Read templates/motion_template.h first; features/vocabulary.h finds rows by name and
// templates/query.h draws templates from words.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4 (a template drawn by hand).
// Departures: docs/design/templates.md.
//
// What is said of the clips stays with a template that is changed. Its own threshold does not: a
// template that asks for something else has other costs.
#pragma once

#include <span>
#include <string>

#include "kinebase/templates/learning.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// The value of an entry that nothing is asked of, with every δ.
inline constexpr double kAnyValue = 0.5;

inline constexpr int kMostTemplateColumns = 100000;

// Columns of a template, 0-based, both included.
struct ColumnRange {
  int first = 0;
  int last = 0;

  friend bool operator==(const ColumnRange&, const ColumnRange&) = default;
};

// All columns whose middle lies in a span of time; a column lasts weight / rate seconds.
// Errors  InvalidArgument if there is none.
[[nodiscard]] ColumnRange ColumnsBetween(const TemplateMatrix& matrix, double start_s,
                                         double end_s);

// How many columns of weight 1 a span of time takes, at least one.
// Errors  InvalidArgument if it is not above 0 or takes more than kMostTemplateColumns.
[[nodiscard]] int ColumnsOfDuration(double duration_s, double rate_hz);

// A template that asks for nothing: every entry is "any". It fits everywhere at no cost; draw with
// WithEntries.
//
// columns  1 to kMostTemplateColumns.
// Errors   InvalidArgument, also if the set has no such rate.
[[nodiscard]] MotionTemplate BlankTemplate(std::string name, const FeatureSet& features,
                                           int columns, double rate_hz = 30);

// The same template with one value in some rows and columns.
//
// rows   Of features, 0-based; see FindFeatures.
// value  0 to 1.
// Errors InvalidArgument for a row, column or value that is outside.
[[nodiscard]] MotionTemplate WithEntries(MotionTemplate motion_template, std::span<const int> rows,
                                         ColumnRange columns, double value);

// Only these features count; all others become "any".
// Errors  InvalidArgument for a row that is outside.
[[nodiscard]] MotionTemplate RestrictToFeatures(MotionTemplate motion_template,
                                                std::span<const int> rows);

// Only these columns.
// Errors  InvalidArgument for columns that are outside.
[[nodiscard]] MotionTemplate CutTemplate(MotionTemplate motion_template, ColumnRange columns);

// The same motion, slower or quicker: `columns` columns of weight 1. Each is the mean of what
// happens in its share of the whole time; borders between columns are blurred where they fall
// inside one.
// Errors  InvalidArgument unless 1 ≤ columns ≤ kMostTemplateColumns.
[[nodiscard]] MotionTemplate StretchTemplate(MotionTemplate motion_template, int columns);

// Columns of "any" before and after.
// Errors  InvalidArgument for fewer than 0 columns or more than kMostTemplateColumns in all.
[[nodiscard]] MotionTemplate ExtendTemplate(MotionTemplate motion_template, int before, int after);

// One motion after the other, with `gap` columns of "any" in between. Profiles and quantisation are
// those of the first; clips are those of all.
//
// Errors  Mismatch unless all have one feature set and rate; InvalidArgument for none, a negative
//         gap or too many columns.
[[nodiscard]] MotionTemplate ConcatenateTemplates(std::span<const MotionTemplate> templates,
                                                  int gap = 0);

// Several classes as one: aligned and averaged as LearnTemplate does it with performances, each
// template counting once, however many clips it was learned from. What they agree in stays 0 or 1,
// where they differ the result is in between, which mostly means "any". Clips are those of all.
//
// Errors  Mismatch unless all have one feature set and rate; those of LearnTemplate.
// Cost    As LearnTemplate.
[[nodiscard]] MotionTemplate CombineTemplates(std::span<const MotionTemplate> templates,
                                              const LearnOptions& options = {});

}  // namespace kinebase
