// A library whose takes do not all have the same features, and templates for both sets.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kinebase/templates/learning.h"
#include "kinebase/templates/motion_template.h"
#include "library/made_up_takes.h"

namespace kinebase::test {

// Six takes: the first four have the features of `bonn`, the last four those of `paper`.
class TwoSetsOfTakes {
 public:
  TwoSetsOfTakes() {
    const std::vector<ImportSource> sources = takes_.Sources();
    ImportOptions options = MadeUpTakes::Options();
    options.takes_per_batch = 2;
    ImportTakes(takes_.library(), std::span(sources).first(4), options);
    options.features = paper_;
    ImportTakes(takes_.library(), std::span(sources).last(4), options);
  }

  [[nodiscard]] std::filesystem::path library() const { return takes_.library(); }
  [[nodiscard]] const FeatureSet& bonn() const { return bonn_; }
  [[nodiscard]] const FeatureSet& paper() const { return paper_; }
  [[nodiscard]] std::filesystem::path File(std::size_t i) const {
    return std::filesystem::canonical(takes_.files()[i]);
  }

  // Read from the files of takes first … last.
  [[nodiscard]] std::vector<TakeFeatures> Read(const FeatureSet& features, std::size_t first,
                                               std::size_t last) const {
    std::vector<TakeFeatures> takes;
    takes.reserve(last - first + 1);
    for (std::size_t i = first; i <= last; ++i) {
      takes.push_back(LoadTakeFeatures({File(i)}, features, 30, {}));
    }
    return takes;
  }

  // What the first eight columns of the third take show; it has both sets.
  [[nodiscard]] MotionTemplate Template(const FeatureSet& features, double tau) const {
    TakeFeatures take = std::move(Read(features, 2, 2).front());
    take.features.columns.resize(8);
    MotionTemplate motion_template{.name = features.name,
                                   .feature_set = features.name,
                                   .feature_set_hash = features.hash,
                                   .matrix = ToTemplateMatrix(take.features)};
    motion_template.tau = tau;
    return motion_template;
  }

 private:
  FeatureSet bonn_ = LoadFeatureSet("bonn");
  FeatureSet paper_ = LoadFeatureSet("paper");
  MadeUpTakes takes_{6};
};

}  // namespace kinebase::test
