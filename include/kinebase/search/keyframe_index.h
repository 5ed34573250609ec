// Preselection: the stretches of recordings that show a template's keyframes in order, so that the
// template is matched with them only.
//
// What shows the motion without its keyframes is missed. A scan of everything is quick
// (docs/performance.md), so keyframes are for leaving out what only looks alike.
// Read templates/keyframes.h and search/feature_index.h first; search/template_search.h matches.
// Method: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 5.4. docs/design/keyframes.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kinebase/features/feature_set.h"
#include "kinebase/search/feature_index.h"
#include "kinebase/search/run_lists.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// Inverted lists for each group of features. Immutable: one serves all threads.
class KeyframeIndex {
 public:
  // groups  FeatureSet::Groups.
  // Cost    That of a FeatureIndex for each group.
  KeyframeIndex(std::span<const FeatureView> recordings, std::span<const FeatureGroup> groups);
  KeyframeIndex(std::span<const FeatureMatrix> recordings, std::span<const FeatureGroup> groups)
      : KeyframeIndex(ViewsOf(recordings), groups) {}

  // By recording and place, without overlaps.
  //
  // Keyframes are found in the order of their columns, from the first to the last within twice the
  // columns that they span in the template, and with the time from one to the next as its stiffness
  // asks. Around them are 3 · n columns more: before the first, n is its column counted from 1;
  // after the last, the number of template columns after it. What overlaps or touches is joined.
  //
  // keyframes  At least one.
  // Errors     InvalidArgument: none; one that tests features of several groups; what
  //            ProblemOfKeyframes finds.
  // Cost       O(columns that show the first keyframe · runs of the others nearby).
  [[nodiscard]] std::vector<Stretch> Preselect(std::span<const Keyframe> keyframes,
                                               int template_columns) const;

 private:
  [[nodiscard]] std::vector<std::vector<Stretch>> Find(const Keyframe& keyframe) const;

  std::vector<int> column_counts_;     // [recording]
  std::vector<FeatureIndex> indices_;  // One for each group.
};

// The same of one recording by its run lists, which may be stored: one for each feature, whatever
// the groups.
//
// recording  What the stretches say.
// Errors     As KeyframeIndex::Preselect.
// Cost       O(changes of the tested features + columns that show the first keyframe · runs of the
//            others nearby).
[[nodiscard]] std::vector<Stretch> Preselect(std::span<const Keyframe> keyframes,
                                             int template_columns,
                                             std::span<const FeatureGroup> groups,
                                             const RunLists& lists, int recording);

// Columns in stretches that do not overlap.
[[nodiscard]] std::int64_t CountColumns(std::span<const Stretch> stretches);

}  // namespace kinebase
