// Queries of several templates, by the features that they need. Internal.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace kinebase::internal {

// Of one feature set at one rate: such templates share the features of the takes.
using FeatureKey = std::pair<std::uint64_t, double>;

// query  Has `motion_template` and `features`.
template <typename Query>
FeatureKey FeatureKeyOf(const Query& query) {
  return {query.features.hash, query.motion_template.matrix.rate_hz};
}

using FeatureGroups = std::vector<std::vector<std::size_t>>;

// [group] the queries of one key, by index; groups in the order of their keys.
template <typename Query>
FeatureGroups GroupByFeatures(std::span<const Query> queries) {
  std::map<FeatureKey, std::vector<std::size_t>> by_key;
  for (std::size_t i = 0; i < queries.size(); ++i) by_key[FeatureKeyOf(queries[i])].push_back(i);
  FeatureGroups groups;
  groups.reserve(by_key.size());
  for (auto& [key, group] : by_key) groups.push_back(std::move(group));
  return groups;
}

}  // namespace kinebase::internal
