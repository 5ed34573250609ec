#include "kinebase/templates/motion_template.h"

#include <numeric>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {

double TemplateMatrix::total_weight() const {
  return std::accumulate(weights.begin(), weights.end(), 0.0);
}

TemplateMatrix ToTemplateMatrix(const FeatureMatrix& features) {
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

MotionTemplate MirrorTemplate(const MotionTemplate& motion_template, const FeatureSet& features) {
  CheckFeatureSet(motion_template, features);
  const std::vector<int> rows = features.MirrorRows();
  MotionTemplate mirrored = motion_template;
  for (int column = 0; column < mirrored.matrix.column_count(); ++column) {
    const std::span<const double> from = motion_template.matrix.Column(column);
    double* to = mirrored.matrix.values.data() + from.size() * static_cast<std::size_t>(column);
    for (std::size_t row = 0; row < from.size(); ++row) to[row] = from[rows[row]];
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
