// Hits of templates that know what sets their class off, ranked by more than features.
//
// Read templates/contrast.h and search/hits.h first. docs/design/contrast.md has the method and
// what each ingredient gains.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kinebase/core/progress.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/search/hits.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

struct RankOptions {
  // The ingredients beside the template itself; each may be left out.
  bool places = true;      // How joints lie along the path, against what the class does.
  bool lookalikes = true;  // Where places count: whether they are rather those of look-alikes.
  bool rivals = true;      // What other templates say of the same stretch.
  // On the cost. Empty: each template's own, and no limit where it has none.
  std::optional<double> tau = std::numeric_limits<double>::infinity();
  // Every column where a path ends, instead of hits alone: for those who choose among them.
  bool every_end = false;
  std::size_t most_hits = 500;  // Of each template.
  int threads = 0;              // 0 = as many as the hardware has.
  ProgressCallback progress;
};

// Another class's template that fits nearly the same stretch.
struct Rival {
  std::size_t motion_template = 0;  // Index of it.
  int first = 0;                    // Columns, 0-based, inclusive.
  int last = 0;
  double matching = 0;  // Its Δ, below ½.

  friend bool operator==(const Rival&, const Rival&) = default;
};

struct RankedHit {
  Hit hit;              // Its cost is Δ, places and look-alikes, weighed and added.
  double matching = 0;  // Δ of the template, with its entry weights.
  double places = 0;    // Mean over the path, in units of the background's variance; at most 4.
  // 1 less the same distance from what looks like the class and is not; 0 where it is farther, or
  // the template knows of none.
  double lookalikes = 0;
  std::optional<Rival> nearest;  // The other class's that fits best there, if any does.
  double rival = 0;              // ½ less its Δ; 0 where there is none.
  double score = 0;  // The cost and the rival, weighed: what hits are ordered by. Rivals do not
                     // decide whether it is a hit, as one may search without them.
};

// For each template its hits, by score. Templates of the same name are no rivals: they stand for
// one class in several styles. Of their hits that share more than half of the shorter one only the
// best is given. Templates without a contrast are ranked by Δ and rivals alone.
//
// Errors   Mismatch if a recording has another rate or feature count than a template, or no pose
// for
//          each column where a template looks at places; Cancelled.
// Cost     O(columns · sum of template columns), and the square of a template's columns a hit.
// Threads  The result does not depend on the thread count.
[[nodiscard]] std::vector<std::vector<RankedHit>> RankHits(
    std::span<const MotionTemplate> templates, std::span<const RecordingStreams> recordings,
    const RankOptions& options = {});

// The hits of all templates of one name, by score: what RankHits found of the class.
[[nodiscard]] std::vector<RankedHit> HitsOfClass(std::string_view name,
                                                 std::span<const MotionTemplate> templates,
                                                 std::span<const std::vector<RankedHit>> hits);

// What RankHits would give for one path, whatever it costs: that of templates[which] which ends
// with a column of the recording; nothing where none ends.
//
// Errors  Mismatch, as above.
// Cost    O(columns · sum of template columns).
[[nodiscard]] std::optional<RankedHit> RankEnd(std::span<const MotionTemplate> templates,
                                               std::size_t which, const RecordingStreams& recording,
                                               int last, const RankOptions& options = {});

}  // namespace kinebase
