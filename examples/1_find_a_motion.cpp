// Learns a motion from one person's examples and finds it in a long take of another: the whole
// method in one file. Made-up motion stands in for recordings; LoadRecording() reads yours.

#include <algorithm>
#include <cstdio>
#include <vector>

#include "kinebase/features/feature_extraction.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/search/template_search.h"
#include "kinebase/synth/synthetic_motion.h"
#include "kinebase/templates/learning.h"
#include "kinebase/templates/quantized_template.h"

int main() {
  constexpr std::uint64_t kSeed = 1;
  const kinebase::FeatureSet features = kinebase::LoadFeatureSet("bonn");

  // Three squats of one person become one template.
  const auto teacher = kinebase::MakeSyntheticActor(0, kSeed);
  std::vector<kinebase::TemplateMatrix> performances;
  for (int repetition = 0; repetition < 3; ++repetition) {
    const kinebase::Motion clip =
        kinebase::MakeSyntheticClip("squat1Reps", teacher, repetition, kSeed);
    performances.push_back(kinebase::ToTemplateMatrix(
        kinebase::ExtractFeatures(kinebase::StandardJoints(clip), features)));
  }
  const kinebase::TemplateMatrix squat = kinebase::LearnTemplate(performances).matrix;

  // Somebody else does twelve different things in one take.
  const auto performer = kinebase::MakeSyntheticActor(1, kSeed);
  const kinebase::SyntheticTake take = kinebase::MakeSyntheticTake(performer, 12, 1, kSeed);
  const std::vector<kinebase::FeatureMatrix> recordings = {
      kinebase::ExtractFeatures(kinebase::StandardJoints(take.motion), features)};

  const auto quantized = kinebase::Quantize(squat, 0.1, kinebase::Profile::kBonn);
  const std::vector<kinebase::Hit> hits = kinebase::SearchTemplate(quantized, recordings);
  for (const kinebase::Hit& hit : hits) {
    std::printf("found at %.2f to %.2f s, cost %.3f\n", hit.first / squat.rate_hz,
                (hit.last + 1) / squat.rate_hz, hit.cost);
  }
  bool found_all = true;
  for (const kinebase::SyntheticSegment& segment : take.segments) {
    if (segment.class_name != "squat1Reps") continue;
    const double start_s = (segment.first_frame - 1) / take.motion.rate_hz;
    const double end_s = segment.last_frame / take.motion.rate_hz;
    std::printf("truth:   %.2f to %.2f s\n", start_s, end_s);
    found_all = found_all && std::ranges::any_of(hits, [&](const kinebase::Hit& hit) {
                  const double middle_s = (hit.first + hit.last + 1) / 2.0 / squat.rate_hz;
                  return start_s <= middle_s && middle_s <= end_s;
                });
  }
  return found_all && !hits.empty() ? 0 : 1;
}
