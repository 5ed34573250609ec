// The tables and figures of the motion template paper, and what comes out of the same experiments
// on the clips that are here.
//
// The paper's figures, and what its classes are called in HDM05, are data/paper/*.csv.
// Read library/evaluation.h first. docs/quality.md has what came out.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sects. 4.2 and 5.3 to 5.5.
// Departures: its databases are not public in the form in which it used them, and where the paper
// searches all of HDM05 we search what is given. Hits are told from false ones by the clips, where
// its authors looked at them.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/evaluation.h"
#include "kinebase/search/subsequence_dtw.h"

namespace kinebase {

enum class PaperPreset {
  kTable1,   // Learning: how long, how many rounds.
  kTable2,   // Hits and right hits at six thresholds.
  kTable3,   // The same at one threshold, around keyframes.
  kTable4,   // Templates beside examples: right hits in the top 5, 10, 20; separation.
  kTable5,   // Templates beside fuzzy retrieval.
  kFigure7,  // Δ of one class over a sequence of three, quantised and not.
  kFigure8,  // Δ of three classes over a sequence of four.
};

// "table1" … "figure8", in the order of the enumeration.
[[nodiscard]] std::span<const std::string_view> PaperPresetNames();
[[nodiscard]] std::string_view ToString(PaperPreset preset);
[[nodiscard]] std::optional<PaperPreset> ParsePaperPreset(std::string_view name);

// What the paper's classes are called in a list of clips.
class PaperClasses {
 public:
  struct Found {
    std::set<std::string> names;  // Their clips together are the class. Empty: it is not here.
    std::string note;             // In what it differs from the paper's.
  };

  [[nodiscard]] static PaperClasses BuiltIn();  // As HDM05 calls them.

  // Columns class, hdm05 (one name, or several with spaces between that make up the class together)
  // and note. Of several rows for a class the first counts whose names are all here.
  // Errors  MalformedFile: no such table, a row without a name or with a class that no table of the
  //         paper has; those of MappedFile.
  [[nodiscard]] static PaperClasses Read(const std::filesystem::path& file);
  [[nodiscard]] static PaperClasses Parse(std::string_view text, const std::filesystem::path& file);

  // here  The classes of a list.
  [[nodiscard]] Found Find(std::string_view paper_class, const std::set<std::string>& here) const;

 private:
  struct Row {
    std::string paper_class;
    Found found;
  };
  std::vector<Row> rows_;
};

using PaperFigures = std::vector<std::optional<double>>;  // [column]; nothing: not known.

struct PaperRow {
  std::string paper_class;
  std::string variant;         // "rf", "by hand"; empty where a class has one row.
  std::string note;            // What is amiss with it.
  PaperFigures paper;          // What the paper has. Some figures are lost in our copy of it.
  std::set<std::string> here;  // The classes that stand for it; empty: not here,
  PaperFigures ours;           // and then this is empty, too.
};

struct PaperTable {
  std::vector<std::string> columns;  // "hits_0.02", "seconds".
  std::vector<PaperRow> rows;
};

// The paper's side of a table: data/paper/paper_<preset>.csv.
[[nodiscard]] PaperTable ReadPaperTable(PaperPreset preset);

// Clips behind each other, as if it were one recording.
struct PaperSequence {
  struct Part {
    std::string class_name;  // Of the list.
    int first = 0;           // Columns, 0-based, inclusive.
    int last = 0;
  };
  struct Curve {
    std::string class_name;
    std::string variant;
    DeltaCurve curve;
    std::vector<Hit> hits;  // That cost kDefaultTau or less.
  };
  double rate_hz = 0;
  std::vector<Part> parts;
  std::vector<Curve> curves;
};

struct PaperComparison {
  PaperTable table;
  std::vector<std::string> notes;
  std::optional<PaperSequence> sequence;  // Figures only.
};

// What takes must have for it.
[[nodiscard]] TakeParts PartsFor(PaperPreset preset);

struct PaperOptions {
  PaperClasses classes = PaperClasses::BuiltIn();
  Profile profile = Profile::kBonn;
  int threads = 0;
  ProgressCallback progress;
};

// Does a table's or figure's experiment again with the classes that are here.
//
// Of each class every other clip of the list, from its first, is learned from. Searched are:
//
// tables 2, 5  the others, and the distractors, as far as there are any
// table 3      all clips, and the distractors
// table 4      of at most 20 clips a class, evenly spread over the list, those not learned from,
//              and the distractors
// figures      of those not learned from the first ones, behind each other. A class that is not
//              here has its place taken by the next of the list that the figure does not show,
//              which is noted
//
// data    With PartsFor.
// Errors  InvalidArgument: none of the preset's classes is here, naming them; Cancelled.
// Cost    Of a learning and a search for each row.
[[nodiscard]] PaperComparison CompareWithPaper(PaperPreset preset, const EvaluationData& data,
                                               const FeatureSet& features,
                                               const PaperOptions& options = {});

}  // namespace kinebase
