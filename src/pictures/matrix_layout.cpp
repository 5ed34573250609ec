#include "pictures/matrix_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kinebase::internal {
namespace {

constexpr int kMostDrawnColumns = 1600;  // About what a wide screen shows.
constexpr double kUsualMatrixWidth = 720;
constexpr double kLeastContentWidth = 560;  // So that title and legend have room over one column.
constexpr double kMostFactsWidth = 900;
constexpr double kMostNameWidth = 280;
constexpr double kMostGroupWidth = 90;
constexpr double kColumnGap = 12;  // Between group, id, name and cells.
constexpr double kGroupGap = 7;

double WidestText(const FeatureSet& features, std::string Feature::*text, const TextStyle& style) {
  double width = 0;
  for (const Feature& feature : features.features) {
    width = std::max(width, TextWidth(feature.*text, style));
  }
  return std::ceil(width);
}

std::vector<RowGroup> GroupRows(const FeatureSet& features) {
  std::vector<RowGroup> groups;
  for (int i = 0; i < features.feature_count(); ++i) {
    const std::string& label = features.features[i].group;
    if (groups.empty() || groups.back().label != label) groups.push_back({label, i, 0});
    ++groups.back().count;
  }
  return groups;
}

// Whole pixels, so that cells have sharp borders: wide for short templates, never under one.
void LayOutColumns(int columns, MatrixLayout& layout) {
  layout.merged = (columns + kMostDrawnColumns - 1) / kMostDrawnColumns;
  layout.drawn_columns = (columns + layout.merged - 1) / layout.merged;
  const double usual = std::floor(kUsualMatrixWidth / layout.drawn_columns);
  const int narrowest = std::clamp(kMostDrawnColumns / layout.drawn_columns, 1, 3);
  layout.column_width = std::clamp<double>(usual, narrowest, 24);
  layout.matrix_width = layout.drawn_columns * layout.column_width;
}

void LayOutTexts(const FeatureSet& features, MatrixLayout& layout) {
  const double group_width =
      std::min(WidestText(features, &Feature::group, kGroupStyle), kMostGroupWidth);
  layout.group_left = kMargin;
  layout.id_left = kMargin + (group_width > 0 ? group_width + kColumnGap : 0);
  layout.name_left = layout.id_left +
                     std::min(WidestText(features, &Feature::id, kIdStyle), kMostGroupWidth) +
                     kColumnGap;
  layout.name_width = std::min(WidestText(features, &Feature::name, kNameStyle), kMostNameWidth);
  layout.matrix_left = layout.name_left + layout.name_width + kColumnGap;
}

double LayOutRows(double top, int feature_count, MatrixLayout& layout) {
  layout.row_top.resize(feature_count);
  for (const RowGroup& group : layout.groups) {
    if (group.first > 0) top += kGroupGap;
    for (int i = group.first; i < group.first + group.count; ++i) {
      layout.row_top[i] = top;
      top += kRowPitch;
    }
  }
  return top - (kRowPitch - kRowHeight);
}

}  // namespace

MatrixLayout LayOutMatrix(const MatrixPicture& picture, const FeatureSet& features) {
  MatrixLayout layout;
  layout.groups = GroupRows(features);
  LayOutColumns(picture.column_count(), layout);
  LayOutTexts(features, layout);
  layout.facts = fmt::format("{}", fmt::join(picture.facts, " · "));
  if (layout.merged > 1) {
    layout.facts += fmt::format(" · drawn {} columns at a time", layout.merged);
  }

  layout.weights_top = kMargin + 56;
  const double rows_top = layout.weights_top + (picture.show_weights ? kWeightHeight + 8 : 0);
  layout.matrix_bottom = LayOutRows(rows_top, features.feature_count(), layout);
  layout.legend_top = layout.matrix_bottom + 56;
  const double notes = picture.row_notes.empty() ? 0 : kNoteWidth;
  const double content =
      std::max({layout.matrix_left + layout.matrix_width + notes - kMargin, kLeastContentWidth,
                std::min(std::ceil(TextWidth(layout.facts, kFactStyle)), kMostFactsWidth)});
  const double more_legend =
      (picture.found.empty() ? 0 : kLegendPitch) + (picture.shaded_rows == 0 ? 0 : kLegendPitch);
  layout.size = {kMargin + content + kMargin, layout.legend_top + 30 + more_legend + kMargin};
  return layout;
}

}  // namespace kinebase::internal
