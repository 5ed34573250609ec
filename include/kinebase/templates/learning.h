// Turns several performances of one motion class into one motion template.
//
// Read templates/motion_template.h first; search/template_search.h consumes the result.
// Method: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 4.1.
// Departures: docs/design/templates.md.
#pragma once

#include <span>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

struct LearnOptions {
  Profile profile = Profile::kBonn;
  int max_rounds = 10;        // At least 1.
  double cost_limit = 0.005;  // Stop when a round's largest cost is at most this; at least 0.
  int threads = 0;            // 0 = as many as the hardware has.
  ProgressCallback progress;
};

struct LearnedMatrix {
  TemplateMatrix matrix;
  std::vector<double> largest_costs;  // One for each round; see LearningRound.
};

// Aligns the performances in time and averages them, feature by feature.
//
// Each performance takes a turn as the reference, because one fixed reference would stamp one
// actor's rhythm onto the result.
//
// performances  One or more; same feature count and rate; none empty.
// Errors        InvalidArgument, naming the first performance that breaks a rule; Cancelled.
// Cost          O(rounds · n² · columns² · features) time, O(columns²) memory a thread.
// Threads       May be called concurrently; the result does not depend on the thread count.
[[nodiscard]] LearnedMatrix LearnTemplate(std::span<const TemplateMatrix> performances,
                                          const LearnOptions& options = {});

// What follows are the parts, for those who want to look inside.

struct LearningRound {
  std::vector<TemplateMatrix> matrices;  // One for each that went in, with it as the reference.
  // The largest alignment cost per feature and unit of the averaged matrix's total weight: how far
  // the matrices that went in still were from each other.
  double largest_cost = 0;
};

// Aligns all matrices to each of them in turn, averages and unwarps.
// Errors  InvalidArgument, as above.
[[nodiscard]] LearningRound LearnRound(std::span<const TemplateMatrix> matrices, Profile profile,
                                       int threads = 0);

// One cell of an alignment: columns of the reference and of the other matrix, 0-based.
struct AlignedColumns {
  int reference = 0;
  int other = 0;
};

struct Alignment {
  std::vector<AlignedColumns> path;  // From the first columns to the last.
  double cost = 0;                   // Accumulated.
};

// Classical DTW with steps (1,0), (0,1), (1,1); ties prefer diagonal, then the step along `other`,
// then along `reference`. Local cost: Manhattan distance; in profile bonn divided by the number of
// features and multiplied by the mean of the two weights.
[[nodiscard]] Alignment Align(const TemplateMatrix& reference, const TemplateMatrix& other,
                              Profile profile);

// `other` brought to the columns of the reference along the path, weights kept in sum.
[[nodiscard]] TemplateMatrix WarpToReference(const TemplateMatrix& other,
                                             const Alignment& alignment, int reference_columns);

// Weighted mean of one or more matrices of equal size; the weights are averaged.
[[nodiscard]] TemplateMatrix AverageMatrices(std::span<const TemplateMatrix> matrices);

// Back to real time: columns stretched and merged until weights are about 1 (bonn) or, all but the
// last one's, exactly 1 (paper). The total weight stays; bonn can lose a little of it at the right
// border (docs/design/templates.md).
[[nodiscard]] TemplateMatrix Unwarp(const TemplateMatrix& matrix, Profile profile);

}  // namespace kinebase
