// Touches every layer, so that a library that was not installed or not linked is noticed.
#include <iostream>
#include <vector>

#include "kinebase/features/feature_extraction.h"
#include "kinebase/library/takes.h"
#include "kinebase/pictures/pose_strip.h"
#include "kinebase/search/template_search.h"
#include "kinebase/synth/synthetic_motion.h"

int main() {
  const kinebase::FeatureSet features = kinebase::LoadFeatureSet("bonn");
  const kinebase::QuantizedTemplate nothing{.rate_hz = 30,
                                            .feature_count = features.feature_count(),
                                            .columns = {kinebase::QuantizedColumn{}}};
  const auto hits = kinebase::SearchTemplate(nothing, std::vector<kinebase::FeatureView>{});
  const bool understands = kinebase::ParsePoseView("front").has_value() &&
                           kinebase::ParseTakeStretch("take.amc:120-480").first_frame == 120 &&
                           !kinebase::SyntheticClasses().empty();
  std::cout << features.feature_count() << " features, " << hits.size() << " hits\n";
  return understands ? 0 : 1;
}
