#include "kinebase/templates/learning.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "templates/alignment.h"
#include "templates/matrix_builder.h"
#include "templates/matrix_check.h"

namespace kinebase {
namespace {

using internal::FeatureRows;
using internal::PairAlignment;

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(ErrorCode::kInvalidArgument, message);
}

void CheckPerformances(std::span<const TemplateMatrix> performances) {
  if (performances.empty()) Refuse("no performances to learn from; give at least one");
  const TemplateMatrix& first = performances[0];
  for (std::size_t i = 0; i < performances.size(); ++i) {
    const TemplateMatrix& performance = performances[i];
    if (const std::string problem = internal::ProblemOf(performance); !problem.empty()) {
      Refuse(fmt::format("performance {} has {}", i + 1, problem));
    }
    if (performance.feature_count != first.feature_count) {
      Refuse(
          fmt::format("performance {} has {} features, performance 1 has {}; use one feature set",
                      i + 1, performance.feature_count, first.feature_count));
    }
    if (performance.rate_hz != first.rate_hz) {
      Refuse(
          fmt::format("performance {} has {} columns a second, performance 1 has {}; use one rate",
                      i + 1, performance.rate_hz, first.rate_hz));
    }
  }
}

void CheckOptions(const LearnOptions& options) {
  if (options.max_rounds < 1) {
    Refuse(fmt::format("at most {} rounds of learning; expected 1 or more", options.max_rounds));
  }
  if (!(options.cost_limit >= 0)) {
    Refuse(fmt::format("cost limit {}; expected 0 or more", options.cost_limit));
  }
}

// [reference × other] alignments of every matrix to every other one.
class Alignments {
 public:
  Alignments(std::span<const TemplateMatrix> matrices, Profile profile, int threads)
      : count_(matrices.size()), alignments_(matrices.size() * matrices.size()) {
    const std::vector<FeatureRows> rows(matrices.begin(), matrices.end());
    ParallelFor(count_, threads, [&](std::size_t i) {
      PairAlignment pair;
      for (std::size_t j = i + 1; j < count_; ++j) {
        pair.Compute(matrices[i], matrices[j], rows[j], profile);
        alignments_[i * count_ + j] = pair.WithFirstAsReference();
        alignments_[j * count_ + i] = pair.WithSecondAsReference();
      }
    });
  }

  [[nodiscard]] const Alignment& Of(std::size_t reference, std::size_t other) const {
    return alignments_[reference * count_ + other];
  }

 private:
  std::size_t count_;
  std::vector<Alignment> alignments_;
};

struct Turn {
  TemplateMatrix matrix;
  double largest_cost = 0;
};

// One matrix as the reference of all.
Turn TakeTurn(std::span<const TemplateMatrix> matrices, std::size_t reference,
              const Alignments& alignments, Profile profile) {
  double largest_cost = 0;
  std::vector<TemplateMatrix> warped;
  warped.reserve(matrices.size());
  for (std::size_t other = 0; other < matrices.size(); ++other) {
    if (other == reference) {
      warped.push_back(matrices[reference]);
      continue;
    }
    const Alignment& alignment = alignments.Of(reference, other);
    warped.push_back(
        WarpToReference(matrices[other], alignment, matrices[reference].column_count()));
    largest_cost = std::max(largest_cost, alignment.cost);
  }
  const TemplateMatrix average = AverageMatrices(warped);
  // In bonn the local costs are per feature already.
  if (profile == Profile::kPaper) largest_cost /= average.feature_count;
  return {Unwarp(average, profile), largest_cost / average.total_weight()};
}

void ReportRound(const LearnOptions& options, int round) {
  if (options.progress && !options.progress("learning", static_cast<std::size_t>(round),
                                            static_cast<std::size_t>(options.max_rounds))) {
    throw Error(ErrorCode::kCancelled, "learning was cancelled");
  }
}

}  // namespace

Alignment Align(const TemplateMatrix& reference, const TemplateMatrix& other, Profile profile) {
  PairAlignment pair;
  pair.Compute(reference, other, FeatureRows(other), profile);
  return pair.WithFirstAsReference();
}

TemplateMatrix WarpToReference(const TemplateMatrix& other, const Alignment& alignment,
                               int reference_columns) {
  std::vector<int> matches(other.weights.size());
  for (const AlignedColumns& cell : alignment.path) ++matches[cell.other];
  TemplateMatrix warped = internal::EmptyLike(other);
  warped.values.reserve(static_cast<std::size_t>(reference_columns) * other.feature_count);
  warped.weights.reserve(reference_columns);
  internal::ColumnMean mean(other.feature_count);
  const auto share = [&](int column) { return other.weights[column] / matches[column]; };
  for (auto cell = alignment.path.begin(); cell != alignment.path.end();) {
    const auto end = std::find_if(cell, alignment.path.end(), [&](const AlignedColumns& next) {
      return next.reference != cell->reference;
    });
    if (end - cell == 1) {
      internal::AppendColumn(warped, other.Column(cell->other), share(cell->other));
    } else {
      mean.Clear();
      for (auto member = cell; member != end; ++member) {
        mean.Add(other.Column(member->other), share(member->other));
      }
      mean.AppendTo(warped);
    }
    cell = end;
  }
  return warped;
}

TemplateMatrix AverageMatrices(std::span<const TemplateMatrix> matrices) {
  TemplateMatrix average = internal::EmptyLike(matrices[0]);
  average.values.reserve(matrices[0].values.size());
  average.weights.reserve(matrices[0].weights.size());
  internal::ColumnMean mean(average.feature_count);
  for (int c = 0; c < matrices[0].column_count(); ++c) {
    mean.Clear();
    for (const TemplateMatrix& matrix : matrices) mean.Add(matrix.Column(c), matrix.weights[c]);
    mean.AppendTo(average);
    average.weights.back() /= static_cast<double>(matrices.size());
  }
  return average;
}

LearningRound LearnRound(std::span<const TemplateMatrix> matrices, Profile profile, int threads) {
  CheckPerformances(matrices);
  const Alignments alignments(matrices, profile, threads);
  std::vector<Turn> turns(matrices.size());
  ParallelFor(matrices.size(), threads, [&](std::size_t reference) {
    turns[reference] = TakeTurn(matrices, reference, alignments, profile);
  });
  LearningRound round;
  for (Turn& turn : turns) {
    round.matrices.push_back(std::move(turn.matrix));
    round.largest_cost = std::max(round.largest_cost, turn.largest_cost);
  }
  return round;
}

LearnedMatrix LearnTemplate(std::span<const TemplateMatrix> performances,
                            const LearnOptions& options) {
  CheckPerformances(performances);
  CheckOptions(options);
  LearnedMatrix learned;
  std::vector<TemplateMatrix> matrices(performances.begin(), performances.end());
  ReportRound(options, 0);
  for (int round = 1; round <= options.max_rounds; ++round) {
    LearningRound result = LearnRound(matrices, options.profile, options.threads);
    matrices = std::move(result.matrices);
    ReportRound(options, round);
    const bool unchanged =
        !learned.largest_costs.empty() && learned.largest_costs.back() == result.largest_cost;
    learned.largest_costs.push_back(result.largest_cost);
    if (result.largest_cost <= options.cost_limit || unchanged) break;
  }
  learned.matrix = std::move(matrices[0]);
  return learned;
}

}  // namespace kinebase
