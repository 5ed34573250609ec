#include "kinebase/search/template_search.h"

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "search/hit_extraction.h"
#include "search/kernels/scan_plan.h"

namespace kinebase {
namespace {

using internal::Candidate;

// Long recordings are cut, so that one alone still occupies all threads. What a piece computes
// twice, two columns for each template column, is then 1 in 300 for a template of three seconds.
constexpr std::size_t kColumnsOfAPiece = std::size_t{1} << 16;

struct Piece {
  int recording = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

void CheckRecordings(const QuantizedTemplate& motion_template,
                     std::span<const FeatureMatrix> recordings) {
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const FeatureMatrix& recording = recordings[i];
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

std::vector<Piece> CutIntoPieces(std::span<const FeatureMatrix> recordings) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const std::size_t columns = recordings[i].columns.size();
    for (std::size_t begin = 0; begin < columns; begin += kColumnsOfAPiece) {
      pieces.push_back({static_cast<int>(i), begin, std::min(columns, begin + kColumnsOfAPiece)});
    }
  }
  return pieces;
}

std::vector<Candidate> ScanPiece(const internal::ScanPlan& plan, const FeatureMatrix& recording,
                                 const Piece& piece, double tau) {
  std::vector<double> delta(piece.end - piece.begin);
  std::vector<std::int32_t> start(delta.size());
  internal::ScanRange(plan, recording.columns, piece.begin, piece.end, delta.data(), start.data());
  std::vector<Candidate> candidates;
  internal::AppendCandidates(delta, start, tau, piece.begin, candidates);
  return candidates;
}

}  // namespace

std::vector<Hit> SearchTemplate(const QuantizedTemplate& motion_template,
                                std::span<const FeatureMatrix> recordings,
                                const SearchOptions& options) {
  if (!(options.tau >= 0)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("threshold tau {}; expected 0 or more", options.tau));
  }
  CheckRecordings(motion_template, recordings);
  const internal::ScanPlan plan(motion_template);
  const std::vector<Piece> pieces = CutIntoPieces(recordings);
  std::vector<std::vector<Candidate>> candidates(pieces.size());
  ParallelFor(pieces.size(), options.threads, "searching", options.progress, [&](std::size_t i) {
    const Piece& piece = pieces[i];
    candidates[i] = ScanPiece(plan, recordings[piece.recording], piece, options.tau);
  });

  std::vector<Hit> hits;
  for (std::size_t i = 0; i < pieces.size();) {
    const int recording = pieces[i].recording;
    std::vector<Candidate> all;
    for (; i < pieces.size() && pieces[i].recording == recording; ++i) {
      all.insert(all.end(), candidates[i].begin(), candidates[i].end());
    }
    const std::vector<Hit> found =
        internal::ExtractHits(std::move(all), recordings[recording].columns.size(), recording);
    hits.insert(hits.end(), found.begin(), found.end());
  }
  return BestHits(std::move(hits), options.most_hits);
}

}  // namespace kinebase
