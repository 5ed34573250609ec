// Where the parts of a matrix picture stand. Internal to pictures/matrix_picture.cpp.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinebase/pictures/canvas.h"
#include "pictures/matrix_picture.h"

namespace kinebase::internal {

inline constexpr TextStyle kTitleStyle = {.size = 17, .bold = true};
inline constexpr TextStyle kFactStyle = {.size = 11, .color = {95, 95, 95}};
inline constexpr TextStyle kNameStyle = {.size = 11};
inline constexpr TextStyle kIdStyle = {.size = 11, .color = {110, 110, 110}};
inline constexpr TextStyle kGroupStyle = {.size = 11, .bold = true, .color = {70, 70, 70}};
inline constexpr TextStyle kTickStyle = {.size = 10, .color = {60, 60, 60}};
inline constexpr TextStyle kCaptionStyle = {
    .size = 10, .color = {95, 95, 95}, .align = TextAlign::kRight};

inline constexpr double kMargin = 24;
inline constexpr double kRowPitch = 17;   // From row to row,
inline constexpr double kRowHeight = 16;  // of which this is coloured: a hairline guides the eye.
inline constexpr double kWeightHeight = 30;
inline constexpr double kNoteWidth = 56;    // Of what stands at the right of a row.
inline constexpr double kLegendPitch = 20;  // From line to line.

// A run of rows of one group.
struct RowGroup {
  std::string label;
  int first = 0;
  int count = 0;
};

struct MatrixLayout {
  int merged = 1;  // Columns drawn as one.
  int drawn_columns = 0;
  double column_width = 0;

  double group_left = 0;  // Left edges of the texts,
  double id_left = 0;
  double name_left = 0;
  double name_width = 0;
  double matrix_left = 0;  // and of the cells.
  double matrix_width = 0;

  double weights_top = 0;
  std::vector<RowGroup> groups;
  std::vector<double> row_top;  // [feature]
  double matrix_bottom = 0;
  double legend_top = 0;
  std::string facts;
  PictureSize size;
};

[[nodiscard]] MatrixLayout LayOutMatrix(const MatrixPicture& picture, const FeatureSet& features);

}  // namespace kinebase::internal
