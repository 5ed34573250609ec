// The picture that templates and feature matrices share: rows with names, time axis, legend.
// Internal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/features/feature_set.h"

namespace kinebase::internal {

enum class CellCoding {
  kShare,      // Values from 0 to 1.
  kQuantized,  // 0, 1, or anything else for "any".
  kBits,       // 0 and 1.
};

// What a recording does where a template asks for something.
struct FoundEntry {
  bool holds = false;
  bool is_wrong = false;
};

struct MatrixPicture {
  std::string title;
  std::vector<std::string> facts;  // For the line below the title.
  CellCoding coding = CellCoding::kShare;
  double rate_hz = 0;             // Columns of weight 1 a second.
  std::vector<double> values;     // [column × feature].
  std::vector<FoundEntry> found;  // The same; drawn below the values if there are any.
  std::vector<double> weights;    // [column].
  bool show_weights = true;
  std::vector<std::string> row_notes;  // [feature] at the right, what a row costs; may be empty.
  // So many rows, the last ones, are not about features: how far off, from 0 = white to 1 = red.
  int shaded_rows = 0;

  [[nodiscard]] int column_count() const { return static_cast<int>(weights.size()); }
};

// features  One for each row of the picture.
// Errors    Those of WritePicture.
void DrawMatrixPicture(const MatrixPicture& picture, const FeatureSet& features,
                       const std::filesystem::path& path, Overwrite overwrite);

}  // namespace kinebase::internal
