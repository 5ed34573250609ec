// What looks like a class and is mostly something else. Internal: learning asks for it.
//
// Walking agrees with sneaking in every feature; what tells them apart is a little in many joints,
// in the direction from the one to the other. So a template also keeps how the joints lie in what
// matches it best elsewhere (PoseModel::lookalikes), and search/ranking.h asks which of the two
// poses are nearer.
#pragma once

#include <span>
#include <vector>

#include "kinebase/library/class_learning.h"

namespace kinebase::internal {

// For each template that has a contrast: the mean poses of its best hits in the clips of other
// classes and in recordings without labels. Some of the latter may well be right. They are few
// among many, so that the mean hardly moves.
//
// Errors  As RankHits.
// Cost    Of RankHits.
void FindLookalikes(std::span<const LabelledClip* const> clips,
                    std::span<const RecordingStreams> unlabelled, int threads,
                    std::span<MotionTemplate> templates);

}  // namespace kinebase::internal
