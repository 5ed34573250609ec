// Retrieval without a learned template, to compare templates with: one example of a motion against
// recordings, by features, rotations or positions; and templates that are not quantised.
//
// The warping steps, what ties prefer, and the rule for hits are those of templates:
// search/subsequence_dtw.h and search/hits.h. Only the local cost differs.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.5 (RF, Q, 3D), Fig. 7b.
// Departures and figures: docs/design/baselines.md.
#pragma once

#include <span>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/features/joint_stream.h"
#include "kinebase/search/template_search.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// The Δ curve of an example in one recording. Costs of a cell:
//
// features   (RF) Manhattan distance of the columns, divided by the number of features.
// rotations  (Q) the mean over joints of (2/π) · acos |q · q′|, from 0 to 1.
// positions  (3D) the mean over joints of the distance, in humerus lengths.
//
// matching   Which steps cost double, as for templates.
// Errors     Mismatch: another rate, kind or number of rows or joints than the example's;
//            InvalidArgument: an example without columns.
// Cost       O(columns of the example · columns · numbers a column).
[[nodiscard]] DeltaCurve ComputeExampleDelta(const FeatureMatrix& example,
                                             const FeatureMatrix& recording,
                                             Profile matching = Profile::kBonn);
[[nodiscard]] DeltaCurve ComputeExampleDelta(const JointStream& example,
                                             const JointStream& recording,
                                             Profile matching = Profile::kBonn);

// The same of a template as it was learned, every value with its share: Manhattan distance of the
// columns, divided by the number of features, by the column's weight as in a quantised one.
// Errors  Also InvalidArgument for a matrix that breaks what TemplateMatrix promises.
[[nodiscard]] DeltaCurve ComputeUnquantizedDelta(const TemplateMatrix& matrix,
                                                 const FeatureMatrix& recording,
                                                 Profile matching = Profile::kBonn);

// Hits in many recordings, best first, as SearchTemplate gives them. No path crosses from one
// recording to another.
//
// Errors   As above, naming the recording; Cancelled.
// Threads  The result does not depend on the thread count.
[[nodiscard]] std::vector<Hit> SearchExample(const FeatureMatrix& example,
                                             std::span<const FeatureMatrix> recordings,
                                             const SearchOptions& options = {},
                                             Profile matching = Profile::kBonn);
[[nodiscard]] std::vector<Hit> SearchExample(const JointStream& example,
                                             std::span<const JointStream> recordings,
                                             const SearchOptions& options = {},
                                             Profile matching = Profile::kBonn);
[[nodiscard]] std::vector<Hit> SearchUnquantized(const TemplateMatrix& matrix,
                                                 std::span<const FeatureMatrix> recordings,
                                                 const SearchOptions& options = {},
                                                 Profile matching = Profile::kBonn);

}  // namespace kinebase
