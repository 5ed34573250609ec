// Finds kicks by a description instead of examples: a query becomes a template, and one that is not
// understood says where.

#include <cstdio>
#include <vector>

#include "kinebase/features/feature_extraction.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/search/template_search.h"
#include "kinebase/synth/synthetic_motion.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/query.h"

int main() {
  constexpr std::uint64_t kSeed = 1;
  const kinebase::FeatureSet features = kinebase::LoadFeatureSet("bonn");

  // The first try has a slip in it.
  kinebase::CompiledQuery query;
  try {
    query = kinebase::CompileQuery("rfoot raised & rthigh liftd then rfoot low", features);
  } catch (const kinebase::QueryError& error) {
    std::printf("%s\n%s\n", error.what(), error.marked().c_str());
    query = kinebase::CompileQuery("rfoot raised & rthigh lifted then rfoot low", features);
  }

  // A kick among other motions.
  const auto performer = kinebase::MakeSyntheticActor(0, kSeed);
  std::vector<kinebase::FeatureMatrix> recordings;
  for (const char* motion : {"squat1Reps", "kickRFront1Reps", "jumpingJack1Reps"}) {
    const kinebase::Motion clip = kinebase::MakeSyntheticClip(motion, performer, 0, kSeed);
    recordings.push_back(kinebase::ExtractFeatures(kinebase::StandardJoints(clip), features));
  }
  const kinebase::MotionTemplate& kick = query.templates[0];
  const auto quantized = kinebase::Quantize(kick.matrix, kick.quantisation, kick.matching);
  const std::vector<kinebase::Hit> hits =
      kinebase::SearchTemplate(quantized, recordings, {.tau = 0.02});
  for (const kinebase::Hit& hit : hits) {
    std::printf("found in recording %d at %.2f to %.2f s\n", hit.recording + 1,
                hit.first / kick.matrix.rate_hz, (hit.last + 1) / kick.matrix.rate_hz);
  }
  // The second recording, and no other.
  return hits.size() == 1 && hits[0].recording == 1 ? 0 : 1;
}
