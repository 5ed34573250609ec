// The experiments behind library/paper_tables.h, a function a table.
#pragma once

#include <string_view>
#include <vector>

#include "kinebase/library/paper_tables.h"

namespace kinebase::internal {

struct PaperInput {
  const EvaluationData& data;
  const FeatureSet& features;
  const PaperOptions& options;
  std::set<std::string> class_names;  // Of the data.
  std::vector<bool> learned_from;     // [clip] every other one of its class, from the first.
};

// The template of the clips, as the paper has it: without what sets it off from other motion.
[[nodiscard]] MotionTemplate LearnFrom(std::span<const LabelledClip* const> clips,
                                       const PaperInput& input);

// The row's figure in a column of the table.
void SetFigure(const PaperTable& table, PaperRow& row, std::string_view column, double figure);

// The clips of some classes, those that are learned from or the others.
[[nodiscard]] std::vector<const LabelledClip*> ClipsOf(const std::set<std::string>& names,
                                                       bool learned_from, const PaperInput& input);

// Throws Cancelled.
void ReportRow(const PaperInput& input, std::size_t done, std::size_t total);

// Each fills in what is here: `here` and `ours` of rows whose class is, and notes.
void RunTable1(const PaperInput& input, PaperComparison& comparison);
void RunTable2(const PaperInput& input, PaperComparison& comparison);
void RunTable3(const PaperInput& input, PaperComparison& comparison);
void RunTable4(const PaperInput& input, PaperComparison& comparison);
void RunTable5(const PaperInput& input, PaperComparison& comparison);
void RunFigure(const PaperInput& input, PaperComparison& comparison);

}  // namespace kinebase::internal
