#include "kinebase/search/template_search.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "search/hit_extraction.h"
#include "search/kernels/filter_plan.h"
#include "search/kernels/scan_plan.h"
#include "search/search_checks.h"

namespace kinebase {
namespace {

using internal::Candidate;

// Long recordings are cut, so that one alone still occupies all threads. What a piece computes
// twice, two columns for each template column, is then 1 in 300 for a template of three seconds.
constexpr std::size_t kColumnsOfAPiece = std::size_t{1} << 16;
// Short ones are taken together: handing out a piece costs as much as scanning some hundred
// columns.
constexpr std::size_t kColumnsOfATurn = std::size_t{1} << 13;

// Some columns of a stretch, in which paths may begin to their left.
struct Piece {
  Stretch stretch;
  std::size_t begin = 0;  // From the stretch's first column.
  std::size_t end = 0;
};

void CheckRecordings(const QuantizedTemplate& motion_template,
                     std::span<const FeatureView> recordings) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const FeatureView& recording = recordings[i];
    if (recording.feature_count != motion_template.feature_count) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("recording {} has {} features, the template {}; extract both with "
                              "the same feature set",
                              i + 1, recording.feature_count, motion_template.feature_count));
    }
    if (recording.rate_hz != motion_template.rate_hz) {
      throw Error(ErrorCode::kMismatch,
                  fmt::format("recording {} has {} columns a second, the template {}; extract its "
                              "features at the template's rate",
                              i + 1, recording.rate_hz, motion_template.rate_hz));
    }
  }
}

void CheckStretches(std::span<const Stretch> stretches, std::span<const FeatureView> recordings) {
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const Stretch& stretch = stretches[i];
    const bool exists = stretch.recording >= 0 && stretch.recording < std::ssize(recordings) &&
                        stretch.first >= 0 && stretch.first <= stretch.last &&
                        stretch.last < recordings[stretch.recording].column_count();
    const bool follows =
        i == 0 || stretches[i - 1].recording < stretch.recording ||
        (stretches[i - 1].recording == stretch.recording && stretches[i - 1].last < stretch.first);
    if (exists && follows) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("stretch {}, columns {} to {} of recording {}: expected stretches of "
                            "recordings in their order, without overlaps",
                            i + 1, stretch.first, stretch.last, stretch.recording + 1));
  }
}

std::vector<Stretch> WholeRecordings(std::span<const FeatureView> recordings) {
  std::vector<Stretch> stretches;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const int columns = recordings[i].column_count();
    if (columns > 0) stretches.push_back({static_cast<int>(i), 0, columns - 1});
  }
  return stretches;
}

std::vector<Piece> CutIntoPieces(std::span<const Stretch> stretches) {
  std::vector<Piece> pieces;
  for (const Stretch& stretch : stretches) {
    const auto columns = static_cast<std::size_t>(stretch.last - stretch.first) + 1;
    for (std::size_t begin = 0; begin < columns; begin += kColumnsOfAPiece) {
      pieces.push_back({stretch, begin, std::min(columns, begin + kColumnsOfAPiece)});
    }
  }
  return pieces;
}

// Where each turn of the work begins among the pieces, and the end of the last.
std::vector<std::size_t> TurnsOf(std::span<const Piece> pieces) {
  std::vector<std::size_t> turns;
  std::size_t columns = kColumnsOfATurn;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (columns >= kColumnsOfATurn) {
      turns.push_back(i);
      columns = 0;
    }
    columns += pieces[i].end - pieces[i].begin;
  }
  turns.push_back(pieces.size());
  return turns;
}

// A template ready to be scanned for, first roughly.
struct Plans {
  internal::FilterPlan filter;
  internal::ScanPlan scan;
};

// The candidates of columns [begin, end) of a stretch.
void ScanColumns(const internal::ScanPlan& plan, std::span<const std::uint64_t> columns,
                 std::size_t begin, std::size_t end, double tau,
                 std::vector<Candidate>& candidates) {
  std::vector<double> delta(end - begin);
  std::vector<std::int32_t> start(delta.size());
  internal::ScanRange(plan, columns, begin, end, delta.data(), start.data());
  internal::AppendCandidates(delta, start, tau, begin, candidates);
}

std::vector<Candidate> ScanPiece(const Plans& plans, const FeatureView& recording,
                                 const Piece& piece, double tau) {
  const Stretch& stretch = piece.stretch;
  const auto columns =
      recording.columns.subspan(static_cast<std::size_t>(stretch.first),
                                static_cast<std::size_t>(stretch.last - stretch.first) + 1);
  std::vector<Candidate> candidates;
  if (plans.filter.rules_out()) {
    for (const internal::ColumnRun& run :
         internal::FilterRange(plans.filter, columns, piece.begin, piece.end)) {
      ScanColumns(plans.scan, columns, run.first, run.last + 1, tau, candidates);
    }
  } else {
    ScanColumns(plans.scan, columns, piece.begin, piece.end, tau, candidates);
  }
  for (Candidate& candidate : candidates) {
    candidate.column += stretch.first;
    candidate.start += stretch.first;
  }
  return candidates;
}

struct RecordingCandidates {
  int recording = 0;
  std::vector<Candidate> candidates;
};

// Of recordings that have any.
// candidates  [piece]
std::vector<RecordingCandidates> CollectByRecording(
    std::span<const Piece> pieces, std::vector<std::vector<Candidate>> candidates) {
  std::vector<RecordingCandidates> collected;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (candidates[i].empty()) continue;
    const int recording = pieces[i].stretch.recording;
    if (collected.empty() || collected.back().recording != recording) {
      collected.push_back({recording, std::move(candidates[i])});
    } else {
      std::vector<Candidate>& all = collected.back().candidates;
      all.insert(all.end(), candidates[i].begin(), candidates[i].end());
      candidates[i] = {};  // Not all of them twice.
    }
  }
  return collected;
}

// By recording.
std::vector<Hit> HitsOf(std::vector<RecordingCandidates> recordings, int threads) {
  std::vector<std::vector<Hit>> found(recordings.size());
  ParallelFor(recordings.size(), threads, [&](std::size_t i) {
    found[i] = internal::ExtractHits(std::move(recordings[i].candidates), recordings[i].recording);
  });
  std::vector<Hit> hits;
  for (const std::vector<Hit>& each : found) hits.insert(hits.end(), each.begin(), each.end());
  return hits;
}

// stretches  Checked.
std::vector<Hit> SearchStretches(const QuantizedTemplate& motion_template,
                                 std::span<const FeatureView> recordings,
                                 std::span<const Stretch> stretches, const SearchOptions& options) {
  const Plans plans{.filter = {motion_template, options.tau},
                    .scan = internal::ScanPlan(motion_template)};
  const std::vector<Piece> pieces = CutIntoPieces(stretches);
  std::vector<std::vector<Candidate>> candidates(pieces.size());
  const std::vector<std::size_t> turns = TurnsOf(pieces);
  ParallelFor(
      turns.size() - 1, options.threads, "searching", options.progress, [&](std::size_t turn) {
        for (std::size_t i = turns[turn]; i < turns[turn + 1]; ++i) {
          const Piece& piece = pieces[i];
          candidates[i] = ScanPiece(plans, recordings[piece.stretch.recording], piece, options.tau);
        }
      });

  return BestHits(HitsOf(CollectByRecording(pieces, std::move(candidates)), options.threads),
                  options.most_hits);
}

}  // namespace

std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                std::span<const FeatureView> recordings,
                                const SearchOptions& options) {
  internal::CheckTau(options.tau);
  CheckRecordings(motion_template, recordings);
  return SearchStretches(motion_template, recordings, WholeRecordings(recordings), options);
}

std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                std::span<const FeatureView> recordings,
                                std::span<const Stretch> stretches, const SearchOptions& options) {
  internal::CheckTau(options.tau);
  CheckRecordings(motion_template, recordings);
  CheckStretches(stretches, recordings);
  return SearchStretches(motion_template, recordings, stretches, options);
}

std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                std::span<const FeatureMatrix> recordings,
                                const SearchOptions& options) {
  return SearchTemplate(motion_template, ViewsOf(recordings), options);
}

std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                std::span<const FeatureMatrix> recordings,
                                std::span<const Stretch> stretches, const SearchOptions& options) {
  return SearchTemplate(motion_template, ViewsOf(recordings), stretches, options);
}

}  // namespace kinebase
