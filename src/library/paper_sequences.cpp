// Figures 7 and 8: Δ over clips behind each other.

#include <algorithm>
#include <limits>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/search/example_search.h"
#include "kinebase/search/template_search.h"
#include "kinebase/templates/quantized_template.h"
#include "library/paper_experiments.h"

namespace kinebase::internal {
namespace {

// The clips of a class that can be shown, as learning keeps others back.
std::vector<const LabelledClip*> Shown(const std::set<std::string>& names,
                                       const PaperInput& input) {
  return ClipsOf(names, false, input);
}

// Gives classes that are not here, or have one clip only, the place of others that are.
void FillPlaces(const PaperInput& input, PaperComparison& comparison) {
  std::vector<PaperRow>& rows = comparison.table.rows;
  std::set<std::string> taken;
  for (PaperRow& row : rows) {
    if (Shown(row.here, input).empty()) row.here.clear();
    taken.insert(row.here.begin(), row.here.end());
  }
  for (PaperRow& row : rows) {
    if (!row.here.empty()) continue;
    const auto other = std::ranges::find_if(input.class_names, [&](const std::string& name) {
      return !taken.contains(name) && !Shown({name}, input).empty();
    });
    if (other == input.class_names.end()) continue;
    taken.insert(*other);
    comparison.notes.push_back(
        fmt::format("{} is not here; {} has its place", row.paper_class, *other));
    for (PaperRow& each : rows) {
      if (each.paper_class == row.paper_class) each.here = {*other};
    }
  }
}

std::string NameOf(const PaperRow& row) { return fmt::format("{}", fmt::join(row.here, " and ")); }

// How many clips of the row's class the figure shows.
std::size_t WantedClips(const PaperRow& row) {
  return static_cast<std::size_t>(row.paper.front().value_or(0));
}

// Appends the first clips of each class; the columns of all.
FeatureMatrix MakeSequence(const PaperInput& input, std::span<const PaperRow> rows,
                           PaperSequence& sequence) {
  FeatureMatrix joined;
  std::set<std::string> shown;
  for (const PaperRow& row : rows) {
    if (row.here.empty() || !shown.insert(row.paper_class).second) continue;
    std::vector<const LabelledClip*> clips = Shown(row.here, input);
    clips.resize(std::min(clips.size(), WantedClips(row)));
    for (const LabelledClip* clip : clips) {
      const FeatureMatrix& features = clip->take.features;
      const int first = joined.column_count();
      joined.rate_hz = features.rate_hz;
      joined.feature_count = features.feature_count;
      joined.columns.insert(joined.columns.end(), features.columns.begin(), features.columns.end());
      sequence.parts.push_back({NameOf(row), first, joined.column_count() - 1});
    }
  }
  sequence.rate_hz = joined.rate_hz;
  return joined;
}

// Best first; right is the best hit whose middle lies in a part of the class.
std::vector<JudgedHit> JudgeByParts(std::span<const Hit> hits, const std::string& class_name,
                                    std::span<const PaperSequence::Part> parts) {
  std::set<std::size_t> claimed;
  std::vector<JudgedHit> judged;
  for (const Hit& hit : hits) {
    const int middle = (hit.first + hit.last) / 2;
    const auto part = std::ranges::find_if(parts, [&](const PaperSequence::Part& each) {
      return each.first <= middle && middle <= each.last;
    });
    const bool right = part != parts.end() && part->class_name == class_name &&
                       claimed.insert(static_cast<std::size_t>(part - parts.begin())).second;
    judged.push_back({.cost = hit.cost, .matching = hit.cost, .right = right});
  }
  return judged;
}

void SetFigures(const PaperTable& table, std::span<const JudgedHit> judged, std::size_t clips,
                PaperRow& row) {
  const auto best = judged.first(std::min(clips, judged.size()));
  SetFigure(table, row, "best_right",
            static_cast<double>(std::ranges::count(best, true, &JudgedHit::right)));
  // Hits are in order: the last right one costs most, the first other least.
  for (const JudgedHit& hit : best) {
    if (hit.right) SetFigure(table, row, "highest_right", hit.cost);
  }
  const auto other = std::ranges::find(judged, false, &JudgedHit::right);
  if (other != judged.end()) SetFigure(table, row, "lowest_other", other->cost);
}

void AddCurve(const PaperInput& input, const FeatureMatrix& joined, const PaperTable& table,
              PaperRow& row, PaperSequence& sequence) {
  const std::string name = NameOf(row);
  const auto clips = static_cast<std::size_t>(
      std::ranges::count(sequence.parts, name, &PaperSequence::Part::class_name));
  SetFigure(table, row, "clips", static_cast<double>(clips));
  if (row.variant == "in the sequence") return;
  const MotionTemplate learned = LearnFrom(ClipsOf(row.here, true, input), input);
  DeltaCurve curve = row.variant == "quantised"
                         ? ComputeDelta(Quantize(learned), joined.columns)
                         : ComputeUnquantizedDelta(learned.matrix, joined, input.options.profile);
  std::vector<Hit> hits = ExtractHits(curve, std::numeric_limits<double>::max());
  SetFigures(table, JudgeByParts(hits, name, sequence.parts), clips, row);
  std::erase_if(hits, [](const Hit& hit) { return hit.cost > kDefaultTau; });
  sequence.curves.push_back({name, row.variant, std::move(curve), std::move(hits)});
}

}  // namespace

void RunFigure(const PaperInput& input, PaperComparison& comparison) {
  FillPlaces(input, comparison);
  PaperSequence& sequence = comparison.sequence.emplace();
  PaperTable& table = comparison.table;
  const FeatureMatrix joined = MakeSequence(input, table.rows, sequence);
  if (sequence.parts.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "no class has two clips: nothing is left to show when one is learned from");
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    ReportRow(input, i, table.rows.size());
    if (!table.rows[i].here.empty()) AddCurve(input, joined, table, table.rows[i], sequence);
  }
  ReportRow(input, table.rows.size(), table.rows.size());
}

}  // namespace kinebase::internal
