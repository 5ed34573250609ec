// What a class of motion is: for every moment and feature, how consistently the feature held.
//
// Read features/feature_matrix.h first. Made by templates/learning.h or templates/template_file.h,
// used by search/ through templates/quantized_template.h.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Sect. 4.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/features/feature_matrix.h"
#include "kinebase/features/feature_set.h"

namespace kinebase {

// The matrix itself.
struct TemplateMatrix {
  double rate_hz = 0;           // Columns a second.
  int feature_count = 0;        // Rows; order of the FeatureSet.
  std::vector<double> values;   // [column × feature] in [0, 1]: 1 = held in every performance.
  std::vector<double> weights;  // [column] duration in columns of real time; about 1.

  [[nodiscard]] int column_count() const { return static_cast<int>(weights.size()); }
  [[nodiscard]] std::span<const double> Column(int column) const {
    return std::span(values).subspan(static_cast<std::size_t>(column) * feature_count,
                                     feature_count);
  }
  [[nodiscard]] double total_weight() const;

  friend bool operator==(const TemplateMatrix&, const TemplateMatrix&) = default;
};

[[nodiscard]] TemplateMatrix ToTemplateMatrix(const FeatureView& features);  // Weights 1.

// How the pieces of the method are computed: the paper's words, or the authors' toolbox as it ran.
enum class Profile { kBonn, kPaper };

[[nodiscard]] std::string_view ToString(Profile profile);  // "bonn", "paper".
[[nodiscard]] std::optional<Profile> ParseProfile(std::string_view text);

// A stretch of a recording that a template was learned from.
struct TemplateClip {
  std::string file;              // As given.
  std::int64_t first_frame = 0;  // 1-based, inclusive; 0 = whole file.
  std::int64_t last_frame = 0;

  friend bool operator==(const TemplateClip&, const TemplateClip&) = default;
};

enum class Verdict { kRight, kWrong };

[[nodiscard]] std::string_view ToString(Verdict verdict);  // "right", "wrong".
[[nodiscard]] std::optional<Verdict> ParseVerdict(std::string_view text);

// What somebody said of a hit; library/feedback.h learns from it.
struct TemplateMark {
  std::string file;              // As given.
  std::int64_t first_frame = 0;  // 1-based, inclusive.
  std::int64_t last_frame = 0;
  Verdict verdict = Verdict::kRight;

  friend bool operator==(const TemplateMark&, const TemplateMark&) = default;
};

// The poses of a class, column by column.
struct PoseModel {
  std::vector<float> mean;    // [column × kPoseValues]
  std::vector<float> weight;  // [column × kPoseValues]; each column sums to 1.
  std::vector<float> spread;  // [kPoseValues] variance of other motion.
  // [column × kPoseValues] mean of what matches the class best and is mostly something else; may be
  // empty. library/class_learning.h says where it comes from.
  std::vector<float> lookalikes;

  friend bool operator==(const PoseModel&, const PoseModel&) = default;
};

// Mean and variance of each value of a pose.
struct PoseStatistics {
  std::vector<double> mean;      // [kPoseValues]
  std::vector<double> variance;  // [kPoseValues]

  friend bool operator==(const PoseStatistics&, const PoseStatistics&) = default;
};

// Motion in general.
struct Background {
  std::vector<double> ones;  // [feature] how often it is one, in (0, 1).
  PoseStatistics places;

  friend bool operator==(const Background&, const Background&) = default;
};

// What sets the class off from other motion; templates/contrast.h.
struct Contrast {
  std::vector<double> entry_weights;  // [column × feature]; each column sums to 1, or is all 0.
  PoseModel places;                   // Of the joints.
  // What it was measured against, so that it can be measured again; files before version 3 have
  // none.
  std::optional<Background> background;

  friend bool operator==(const Contrast&, const Contrast&) = default;
};

// How often a hit is right, by its cost: 1 / (1 + exp(slope · cost + offset));
// templates/calibration.h.
struct Calibration {
  double slope = 0;
  double offset = 0;

  friend bool operator==(const Calibration&, const Calibration&) = default;
};

// A moment of the motion that a recording must show before the template is looked for there, by
// some of the features; templates/keyframes.h chooses them.
struct Keyframe {
  int column = 0;            // Of the template, 0-based.
  std::uint64_t tested = 0;  // Bit i: feature i is looked at.
  std::uint64_t ones = 0;    // Those of the tested that must hold; the others must not.
  int misses = 0;            // How many of the tested may be otherwise; fewer than there are.
  // How closely the time since the keyframe before must be the template's: from 0, half to twice
  // as long, to 1, as long. Without: only all keyframes together are bounded.
  std::optional<double> stiffness;

  friend bool operator==(const Keyframe&, const Keyframe&) = default;
};

// A template with all that is known of it; what a template file holds.
struct MotionTemplate {
  std::string name;
  Profile learning = Profile::kBonn;
  Profile matching = Profile::kBonn;
  std::string feature_set;             // Its name,
  std::uint64_t feature_set_hash = 0;  // and what it must hash to.
  TemplateMatrix matrix;
  std::vector<TemplateClip> clips;
  std::string origin;  // How it was made, if not by learning: "query: lknee bent", else empty.
  int rounds = 0;      // Of learning; 0 = not learned.
  double quantisation = 0.1;  // δ: values ≤ δ count as 0, values ≥ 1 − δ as 1, others as "any".
  std::optional<double> tau;         // Its own threshold on the cost of a hit.
  std::string tau_origin;            // How it was chosen.
  std::optional<Contrast> contrast;  // Without: a plain template, as in the paper.
  std::optional<Calibration> calibration;
  std::vector<Keyframe> keyframes;  // By column; may be empty.
  std::vector<TemplateMark> marks;  // That it was updated with; may be empty.

  friend bool operator==(const MotionTemplate&, const MotionTemplate&) = default;
};

// The same motion done with the other side: rows exchanged, the name marked with " mirrored".
// Errors  Mismatch if `features` is not the template's set.
[[nodiscard]] MotionTemplate MirrorTemplate(const MotionTemplate& motion_template,
                                            const FeatureSet& features);

// Throws Mismatch, naming both, unless the template was made with this feature set.
void CheckFeatureSet(const MotionTemplate& motion_template, const FeatureSet& features);

}  // namespace kinebase
