#include "pictures/matrix_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "kinebase/pictures/canvas.h"
#include "kinebase/pictures/template_picture.h"
#include "pictures/axis.h"
#include "pictures/matrix_layout.h"

namespace kinebase::internal {
namespace {

constexpr Color kBlack = {0, 0, 0};
constexpr Color kWhite = {255, 255, 255};
constexpr Color kFrame = {120, 120, 120};
constexpr Color kWrong = {214, 39, 40};  // Holds and must not; the other way round it is paler.
constexpr Color kLacking = {255, 152, 150};
constexpr Color kHairline = {205, 205, 205};
constexpr Color kLightWeight = {198, 219, 239};  // Of weight 0,
constexpr Color kHeavyWeight = {8, 48, 107};     // of weight 2 and more.

Color CellColor(CellCoding coding, double value) {
  if (coding == CellCoding::kQuantized && value > 0 && value < 1) return kAnyColor;
  return TemplateColor(value);
}

// Mean over the columns that are drawn as the one with this number.
double DrawnMean(std::span<const double> values, const MatrixLayout& layout, int drawn_column,
                 int stride, int offset) {
  const int columns = static_cast<int>(values.size()) / stride;
  const int first = drawn_column * layout.merged;
  const int end = std::min(first + layout.merged, columns);
  double sum = 0;
  for (int column = first; column < end; ++column) {
    sum += values[static_cast<std::size_t>(column) * stride + offset];
  }
  return sum / (end - first);
}

void DrawHead(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout) {
  const double width = layout.size.width - 2 * kMargin;
  canvas.Text({kMargin, kMargin + 14}, ShortenText(picture.title, width, kTitleStyle), kTitleStyle);
  canvas.Text({kMargin, kMargin + 34}, ShortenText(layout.facts, width, kFactStyle), kFactStyle);
}

void DrawWeights(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout) {
  const double bottom = layout.weights_top + kWeightHeight;
  const double right = layout.matrix_left + layout.matrix_width;
  std::vector<double> weights(layout.drawn_columns);
  for (int i = 0; i < layout.drawn_columns; ++i) {
    weights[i] = DrawnMean(picture.weights, layout, i, 1, 0);
  }
  const double scale = kWeightHeight / std::max(1.5, *std::ranges::max_element(weights));
  canvas.BeginGroup("weights");
  for (int i = 0; i < layout.drawn_columns; ++i) {
    const double height = weights[i] * scale;
    canvas.Rectangle({layout.matrix_left + i * layout.column_width, bottom - height,
                      layout.column_width, height},
                     Mix(kLightWeight, kHeavyWeight, std::min(weights[i] / 2, 1.0)));
  }
  const std::array<PicturePoint, 2> one = {PicturePoint{layout.matrix_left - 4, bottom - scale},
                                           PicturePoint{right, bottom - scale}};
  canvas.Line(one, {.width = 0.75, .color = {200, 60, 40}, .round_ends = false});
  const std::array<PicturePoint, 2> base = {PicturePoint{layout.matrix_left, bottom},
                                            PicturePoint{right, bottom}};
  canvas.Line(base, {.width = 0.75, .color = kFrame, .round_ends = false});
  canvas.Text({layout.matrix_left - 8, bottom - 1}, "weight (line at 1)", kCaptionStyle);
  canvas.EndGroup();
}

void DrawRowNames(Canvas& canvas, const FeatureSet& features, const MatrixLayout& layout) {
  canvas.BeginGroup("names");
  for (int i = 0; i < features.feature_count(); ++i) {
    const Feature& feature = features.features[i];
    const double baseline = layout.row_top[i] + 12;
    canvas.Text({layout.id_left, baseline},
                ShortenText(feature.id, layout.name_left - layout.id_left - 4, kIdStyle), kIdStyle);
    canvas.Text({layout.name_left, baseline},
                ShortenText(feature.name, layout.name_width, kNameStyle), kNameStyle);
  }
  for (const RowGroup& group : layout.groups) {
    const double top = layout.row_top[group.first];
    canvas.Text({layout.group_left, top + 12},
                ShortenText(group.label, layout.id_left - layout.group_left - 4, kGroupStyle),
                kGroupStyle);
    if (group.first == 0) continue;
    const std::array<PicturePoint, 2> line = {
        PicturePoint{kMargin, top - 4},
        PicturePoint{layout.matrix_left + layout.matrix_width, top - 4}};
    canvas.Line(line, {.width = 0.75, .color = kFrame, .round_ends = false});
  }
  canvas.EndGroup();
}

// What rows cost, in a column of its own.
void DrawRowNotes(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout) {
  TextStyle style = kTickStyle;
  style.align = TextAlign::kRight;
  const double right = layout.matrix_left + layout.matrix_width + kNoteWidth;
  canvas.BeginGroup("notes");
  canvas.Text({right, layout.row_top.front() - 6}, "cost", style);
  for (std::size_t row = 0; row < picture.row_notes.size(); ++row) {
    canvas.Text({right, layout.row_top[row] + 12}, picture.row_notes[row], style);
  }
  canvas.EndGroup();
}

struct RowBand {
  double top = 0;
  double height = 0;
};

// One rectangle for neighbours of one colour: cells are many, and repeat.
template <typename ColorOfColumn>
void DrawBand(Canvas& canvas, const MatrixLayout& layout, const RowBand& band,
              ColorOfColumn color) {
  for (int first = 0; first < layout.drawn_columns;) {
    const Color shared = color(first);
    int end = first + 1;
    while (end < layout.drawn_columns && color(end) == shared) ++end;
    canvas.Rectangle({layout.matrix_left + first * layout.column_width, band.top,
                      (end - first) * layout.column_width, band.height},
                     shared);
    first = end;
  }
}

// Of several columns that are drawn as one, what is wrong in any of them is seen.
Color FoundColor(const MatrixPicture& picture, const MatrixLayout& layout, int drawn_column,
                 int feature_count, int feature) {
  const int first = drawn_column * layout.merged;
  const int end = std::min(first + layout.merged, picture.column_count());
  FoundEntry shown;
  for (int column = first; column < end; ++column) {
    const FoundEntry& entry =
        picture.found[static_cast<std::size_t>(column) * feature_count + feature];
    if (entry.is_wrong || !shown.is_wrong) shown = entry;
  }
  if (shown.is_wrong) return shown.holds ? kWrong : kLacking;
  return shown.holds ? kWhite : kBlack;
}

void DrawRow(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout,
             int feature_count, int feature) {
  const double top = layout.row_top[feature];
  if (feature >= feature_count - picture.shaded_rows) {
    DrawBand(canvas, layout, {top, kRowHeight}, [&](int column) {
      return Mix(kWhite, kWrong, DrawnMean(picture.values, layout, column, feature_count, feature));
    });
    return;
  }
  const double height = picture.found.empty() ? kRowHeight : kRowHeight / 2;
  DrawBand(canvas, layout, {top, height}, [&](int column) {
    return CellColor(picture.coding,
                     DrawnMean(picture.values, layout, column, feature_count, feature));
  });
  if (picture.found.empty()) return;
  DrawBand(canvas, layout, {top + height, height},
           [&](int column) { return FoundColor(picture, layout, column, feature_count, feature); });
}

void DrawCells(Canvas& canvas, const MatrixPicture& picture, const FeatureSet& features,
               const MatrixLayout& layout) {
  canvas.BeginGroup("frames");
  for (const RowGroup& group : layout.groups) {
    canvas.Rectangle({layout.matrix_left - 1, layout.row_top[group.first] - 1,
                      layout.matrix_width + 2, group.count * kRowPitch + 1},
                     kFrame);
  }
  canvas.EndGroup();
  canvas.BeginGroup("cells");
  for (int i = 0; i < features.feature_count(); ++i) {
    DrawRow(canvas, picture, layout, features.feature_count(), i);
  }
  canvas.EndGroup();
}

// Where a time lies among columns that last as long as their weights say.
class TimeScale {
 public:
  TimeScale(const MatrixPicture& picture, const MatrixLayout& layout)
      : left_(layout.matrix_left), pixels_a_column_(layout.column_width / layout.merged) {
    for (const double weight : picture.weights)
      ends_s_.push_back(end_s() + weight / picture.rate_hz);
  }

  [[nodiscard]] double end_s() const { return ends_s_.empty() ? 0 : ends_s_.back(); }

  [[nodiscard]] double Place(double time_s) const {
    const auto end = std::ranges::lower_bound(ends_s_, time_s);
    if (end == ends_s_.end()) return left_ + pixels_a_column_ * static_cast<double>(ends_s_.size());
    const double begin_s = end == ends_s_.begin() ? 0 : *(end - 1);
    const double share = *end > begin_s ? (time_s - begin_s) / (*end - begin_s) : 0;
    return left_ + pixels_a_column_ * (static_cast<double>(end - ends_s_.begin()) + share);
  }

 private:
  double left_;
  double pixels_a_column_;
  std::vector<double> ends_s_;  // [column]
};

void DrawTicks(Canvas& canvas, std::span<const Tick> ticks, double top, double label_baseline) {
  TextStyle style = kTickStyle;
  style.align = TextAlign::kCenter;
  for (const Tick& tick : ticks) {
    const std::array<PicturePoint, 2> mark = {PicturePoint{tick.at, top},
                                              PicturePoint{tick.at, top + 4}};
    canvas.Line(mark, {.width = 0.75, .color = kFrame, .round_ends = false});
    canvas.Text({tick.at, label_baseline}, tick.label, style);
  }
}

void DrawAxes(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout) {
  const double top = layout.matrix_bottom + 2;
  const TimeScale time(picture, layout);
  canvas.BeginGroup("axes");
  canvas.Text({layout.matrix_left - 22, top + 15}, "time in s", kCaptionStyle);
  DrawTicks(
      canvas,
      RoundTicks(time.end_s(), 1e-3, kTickStyle, [&](double time_s) { return time.Place(time_s); }),
      top, top + 15);

  const double columns_top = top + 22;
  const std::array<PicturePoint, 2> line = {
      PicturePoint{layout.matrix_left, columns_top},
      PicturePoint{layout.matrix_left + layout.matrix_width, columns_top}};
  canvas.Line(line, {.width = 0.75, .color = kHairline, .round_ends = false});
  canvas.Text({layout.matrix_left - 22, columns_top + 15}, "column", kCaptionStyle);
  const double pixels_a_column = layout.column_width / layout.merged;
  const auto middle = [&](double column) {
    return layout.matrix_left + (column + 0.5) * pixels_a_column;
  };
  DrawTicks(canvas, RoundTicks(picture.column_count() - 1, 1, kTickStyle, middle), columns_top,
            columns_top + 15);
  canvas.EndGroup();
}

void DrawSwatches(Canvas& canvas, PicturePoint at,
                  std::span<const std::pair<Color, std::string_view>> swatches) {
  for (const auto& [color, label] : swatches) {
    canvas.Rectangle({at.x - 1, at.y - 1, 24, 14}, kFrame);
    canvas.Rectangle({at.x, at.y, 22, 12}, color);
    canvas.Text({at.x + 30, at.y + 10}, label, kTickStyle);
    at.x += 30 + std::ceil(TextWidth(label, kTickStyle)) + 24;
  }
}

void DrawShareLegend(Canvas& canvas, PicturePoint at, std::string_view meaning) {
  constexpr int kSteps = 160;
  canvas.Rectangle({at.x - 1, at.y - 1, kSteps + 2, 14}, kFrame);
  for (int i = 0; i < kSteps; ++i) {
    canvas.Rectangle({at.x + i, at.y, 1, 12}, TemplateColor(i / (kSteps - 1.0)));
  }
  for (const auto& [value, label] : {std::pair{0.0, "0"}, {0.5, "0.5"}, {1.0, "1"}}) {
    canvas.Text({at.x + value * kSteps, at.y + 24}, label,
                {.size = 10, .color = kTickStyle.color, .align = TextAlign::kCenter});
  }
  canvas.Text({at.x + kSteps + 14, at.y + 10}, meaning, kTickStyle);
}

void DrawLegend(Canvas& canvas, const MatrixPicture& picture, const MatrixLayout& layout) {
  using Swatch = std::pair<Color, std::string_view>;
  const PicturePoint at = {kMargin + 1, layout.legend_top};
  canvas.BeginGroup("legend");
  switch (picture.coding) {
    case CellCoding::kShare:
      DrawShareLegend(canvas, at, "share of the performances in which the feature holds");
      break;
    case CellCoding::kQuantized:
      DrawSwatches(canvas, at,
                   std::array{Swatch{kBlack, "must not hold (0)"}, Swatch{kWhite, "must hold (1)"},
                              Swatch{kAnyColor, "any"}});
      if (picture.found.empty()) break;
      DrawSwatches(canvas, {at.x, at.y + kLegendPitch},
                   std::array{Swatch{kBlack, "below: does not hold"}, Swatch{kWhite, "holds"},
                              Swatch{kWrong, "holds and must not"},
                              Swatch{kLacking, "must hold and does not"}});
      if (picture.shaded_rows == 0) break;
      DrawSwatches(canvas, {at.x, at.y + 2 * kLegendPitch},
                   std::array{Swatch{kWhite, "poses: as the class"},
                              Swatch{Mix(kWhite, kWrong, 0.5), "1 spread off"},
                              Swatch{kWrong, "2 and more"}});
      break;
    case CellCoding::kBits:
      if (layout.merged > 1) {
        DrawShareLegend(canvas, at, "share of the columns in which the feature holds");
      } else {
        DrawSwatches(canvas, at,
                     std::array{Swatch{kBlack, "does not hold (0)"}, Swatch{kWhite, "holds (1)"}});
      }
      break;
  }
  canvas.EndGroup();
}

}  // namespace

void DrawMatrixPicture(const MatrixPicture& picture, const FeatureSet& features,
                       const std::filesystem::path& path, Overwrite overwrite) {
  const MatrixLayout layout = LayOutMatrix(picture, features);
  WritePicture(path, layout.size, overwrite, [&](Canvas& canvas) {
    DrawHead(canvas, picture, layout);
    if (picture.show_weights) DrawWeights(canvas, picture, layout);
    DrawRowNames(canvas, features, layout);
    DrawCells(canvas, picture, features, layout);
    if (!picture.row_notes.empty()) DrawRowNotes(canvas, picture, layout);
    DrawAxes(canvas, picture, layout);
    DrawLegend(canvas, picture, layout);
  });
}

}  // namespace kinebase::internal
