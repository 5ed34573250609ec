// Templates and recordings for tests of the search.
#pragma once

#include <cstdint>
#include <vector>

#include "kinebase/search/subsequence_dtw.h"
#include "templates/matrices.h"

namespace kinebase::test {

inline std::uint64_t AllFeatures(int features) {
  return features == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << features) - 1;
}

// Feature words that hold for a while, as in real recordings: plateaus bring ties.
inline std::vector<std::uint64_t> RandomRecording(Random& random, int columns, int features) {
  std::vector<std::uint64_t> words(columns);
  std::uint64_t word = random.Word();
  for (std::uint64_t& column : words) {
    if (random.Below(4) == 0) word ^= random.Word() & random.Word() & random.Word();
    if (random.Below(30) == 0) word = random.Word();
    column = word & AllFeatures(features);
  }
  return words;
}

// Some columns test everything, some a few features, some nothing ("any" throughout).
inline QuantizedTemplate RandomQuantized(Random& random, int columns, int features,
                                         Profile matching) {
  TemplateMatrix matrix = RandomMatrix(random, columns, features);
  for (int column = 0; column < columns; ++column) {
    const int kind = random.Below(4);
    for (int feature = 0; feature < features; ++feature) {
      double& value = matrix.values[static_cast<std::size_t>(column) * features + feature];
      const bool is_free = kind == 0 || (kind == 1 && random.Below(10) != 0);
      value = is_free ? 0.5 : std::round(value);
    }
  }
  return Quantize(matrix, 0.1, matching);
}

}  // namespace kinebase::test
