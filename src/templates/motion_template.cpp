#include "kinebase/templates/motion_template.h"

#include <numeric>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase {

double TemplateMatrix::total_weight() const {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TemplateMatrix ToTemplateMatrix(const FeatureView& features) {
  TemplateMatrix matrix;
  matrix.rate_hz = features.rate_hz;
  matrix.feature_count = features.feature_count;
  matrix.weights.assign(features.columns.size(), 1.0);
  matrix.values.reserve(features.columns.size() * features.feature_count);
  for (const std::uint64_t column : features.columns) {
    for (int feature = 0; feature < features.feature_count; ++feature) {
      matrix.values.push_back(((column >> feature) & 1U) != 0 ? 1.0 : 0.0);
    }
  }
  return matrix;
}

std::string_view ToString(Profile profile) { return profile == Profile::kBonn ? "bonn" : "paper"; }

std::optional<Profile> ParseProfile(std::string_view text) {
  for (const Profile profile : {Profile::kBonn, Profile::kPaper}) {
    if (text == ToString(profile)) return profile;
  }
  return std::nullopt;
}

std::string_view ToString(Verdict verdict) {
  return verdict == Verdict::kRight ? "right" : "wrong";
}

std::optional<Verdict> ParseVerdict(std::string_view text) {
  for (const Verdict verdict : {Verdict::kRight, Verdict::kWrong}) {
    if (text == ToString(verdict)) return verdict;
  }
  return std::nullopt;
}

namespace {

template <typename T>
void MirrorRows(std::vector<T>& matrix, const std::vector<int>& rows) {
  const std::vector<T> from = matrix;
  for (std::size_t first = 0; first < from.size(); first += rows.size()) {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      matrix[first + row] = from[first + static_cast<std::size_t>(rows[row])];
    }
  }
}

// Values of poses: joints change sides, and what pointed left points right.
std::vector<int> MirrorPoseRows() {
  std::vector<int> rows;
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    const int other = static_cast<int>(Mirrored(static_cast<StandardJoint>(joint)));
    for (int axis = 0; axis < 3; ++axis) rows.push_back(3 * other + axis);
  }
  return rows;
}

void MirrorPoses(PoseModel& model) {
  const std::vector<int> rows = MirrorPoseRows();
  for (std::vector<float>* values :
       {&model.mean, &model.weight, &model.spread, &model.lookalikes}) {
    MirrorRows(*values, rows);
  }
  for (std::vector<float>* values : {&model.mean, &model.lookalikes}) {
    for (std::size_t x = 0; x < values->size(); x += 3) (*values)[x] = -(*values)[x];
  }
}

void MirrorBackground(Background& background, const std::vector<int>& features) {
  MirrorRows(background.ones, features);
  const std::vector<int> rows = MirrorPoseRows();
  MirrorRows(background.places.mean, rows);
  MirrorRows(background.places.variance, rows);
  for (std::size_t x = 0; x < rows.size(); x += 3) background.places.mean[x] *= -1;
}

std::uint64_t MirrorBits(std::uint64_t bits, const std::vector<int>& rows) {
  std::uint64_t mirrored = 0;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    mirrored |= ((bits >> rows[row]) & 1U) << row;
  }
  return mirrored;
}

}  // namespace

MotionTemplate MirrorTemplate(const MotionTemplate& motion_template, const FeatureSet& features) {
  CheckFeatureSet(motion_template, features);
  const std::vector<int> rows = features.MirrorRows();
  MotionTemplate mirrored = motion_template;
  MirrorRows(mirrored.matrix.values, rows);
  if (mirrored.contrast) {
    MirrorRows(mirrored.contrast->entry_weights, rows);
    MirrorPoses(mirrored.contrast->places);
    if (mirrored.contrast->background) MirrorBackground(*mirrored.contrast->background, rows);
  }
  for (Keyframe& keyframe : mirrored.keyframes) {
    keyframe.tested = MirrorBits(keyframe.tested, rows);
    keyframe.ones = MirrorBits(keyframe.ones, rows);
  }
  // Twice mirrored is the original again, by name too.
  constexpr std::string_view kMark = " mirrored";
  if (mirrored.name.ends_with(kMark)) {
    mirrored.name.resize(mirrored.name.size() - kMark.size());
  } else {
    mirrored.name += kMark;
  }
  return mirrored;
}

void CheckFeatureSet(const MotionTemplate& motion_template, const FeatureSet& features) {
  if (motion_template.feature_set_hash == features.hash &&
      motion_template.matrix.feature_count == features.feature_count()) {
    return;
  }
  throw Error(
      ErrorCode::kMismatch,
      fmt::format("template '{}' was made with feature set '{}' ({:016x}, {} features), not with "
                  "'{}' ({:016x}, {} features); learn it again or choose its own set",
                  motion_template.name, motion_template.feature_set,
                  motion_template.feature_set_hash, motion_template.matrix.feature_count,
                  features.name, features.hash, features.feature_count()));
}

}  // namespace kinebase
