// A feature set is data: a table of geometric tests, each of them 0 or 1 in every frame.
//
// Read features/feature_matrix.h for what comes out and features/feature_extraction.h for how;
// features/vocabulary.h finds features by their words.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Appendix A; the built-in sets `bonn`
// and `paper` are data/feature_sets/*.toml; docs/feature-sets.md shows how to write your own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

inline constexpr int kMaxFeatures = 64;  // One machine word a frame.

// A number that a pose (and its neighbours in time) gives for some joints. Joints in the order of
// `FeatureTerm::joints`; the last is the one that is tested.
enum class TermType {
  kPlane,  // a b c q: signed distance of q from the plane through c with normal (a−c)×(b−c); cm.
  kNormalPlane,  // a b c q: signed distance of q from the plane through c with normal b−a; cm.
  kAngle,        // a b c d: angle between the directions b→a and d→c; degrees.
  kAngleWithUp,  // a b: angle between a→b and the Y axis; degrees.
  kNormalMove,   // a b c q: smoothed velocity of q−c along b−a; cm/s.
  kPlaneMove,    // a b c q: smoothed velocity of q−c along (a−c)×(b−c); cm/s.
  kFast,         // q: length of the smoothed velocity; cm/s.
  kApproach,  // a b c d: (v·u)|u·h|, v = smoothed velocity of d−c, u = unit(c−d), h = unit(a−b);
              // cm/s.
  kHeight,        // q: height over the lowest joint that is not in `ignored_joints`; cm.
  kHeightExtent,  // (none): highest minus lowest joint; cm.
  kGroundExtent,  // joints (none = all): largest distance of two of them in the XZ plane; cm.
};

struct FeatureTerm {
  TermType type = TermType::kPlane;
  std::vector<StandardJoint> joints;
  std::vector<StandardJoint> ignored_joints;  // kHeight only.
  double window_ms = 0;                       // Velocity smoothing; 0 = none.
  bool absolute = false;                      // Magnitude of the value.
  double factor = 1;                          // Multiplies the value; −1 turns it round.
};

enum class TermCombination { kSum, kSmallest };

// Which side of a threshold counts as 1. A closed range for kInside.
enum class ThresholdTest { kAbove, kAtLeast, kBelow, kAtMost, kInside };

struct Threshold {
  double low = 0;   // The threshold itself; the lower end for kInside.
  double high = 0;  // kInside only.
};

// One row of a feature matrix.
//
// Hysteresis: from 0 to 1 where the strong test becomes true, back where the weak test fails.
struct Feature {
  std::string id;                      // "F1".
  std::string name;                    // "rhand moving forwards".
  std::string group;                   // "upper", "lower", "mix".
  std::vector<std::string> synonyms;   // Other words for its name: "rhand raised".
  std::vector<std::string> opposites;  // Words for the feature not holding: "rknee straight".
  std::vector<FeatureTerm> terms;
  TermCombination combination = TermCombination::kSum;
  ThresholdTest test = ThresholdTest::kAbove;
  Threshold strong;
  Threshold weak;
  int length = -1;  // Index into FeatureSet::lengths that thresholds are multiples of; -1: none.
  int mirror = -1;  // Row of the feature of the other side; its own row in the middle.
};

// A length of the body in the first frame: the sum of some distances.
struct BodyLength {
  std::string name;  // "hl".
  std::vector<std::pair<StandardJoint, StandardJoint>> segments;
};

// What is asked of one feature.
struct FeatureState {
  int feature = 0;  // Row.
  bool holds = true;

  friend bool operator==(const FeatureState&, const FeatureState&) = default;
};

// Words for some features at once: "both knees bent".
struct FeaturePhrase {
  std::string text;
  std::vector<FeatureState> states;  // At least one.
};

// The features of one group, which keyframes are looked for by.
struct FeatureGroup {
  std::string name;            // "upper"; empty for features without one.
  std::uint64_t features = 0;  // Bit i: feature i.
};

struct FeatureSet {
  std::string name;  // "bonn".
  std::string description;
  double rate_hz = 120;  // Rate at which values are computed; recordings are brought to it.
  std::vector<BodyLength> lengths;
  std::vector<Feature> features;  // 1 … kMaxFeatures.
  std::vector<FeaturePhrase> phrases;
  std::uint64_t hash = 0;  // Of all that decides values (not of names): equal sets, equal bits.

  [[nodiscard]] int feature_count() const { return static_cast<int>(features.size()); }
  [[nodiscard]] std::optional<int> Find(std::string_view id) const;
  [[nodiscard]] std::vector<FeatureGroup> Groups() const;  // In the order of their first features.
  [[nodiscard]] std::vector<int> MirrorRows() const;       // [row] → row of the other side.
};

// Errors  MalformedFile with the line: an unknown type, joint, unit or key, a wrong number of
//         joints, a mirror partner that does not exist or does not answer, more than kMaxFeatures
//         features, words with two meanings.
[[nodiscard]] FeatureSet ParseFeatureSet(std::string_view toml, const std::filesystem::path& file);

// "bonn", "paper", or a file. Errors: NotFound, naming the built-in ones; those of ParseFeatureSet.
[[nodiscard]] FeatureSet LoadFeatureSet(std::string_view name_or_path);

[[nodiscard]] std::vector<std::string> BuiltInFeatureSets();
[[nodiscard]] std::string_view BuiltInFeatureSetText(std::string_view name);

}  // namespace kinebase
