#include "pictures/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace kinebase::internal {
namespace {

constexpr double kSwatchWidth = 26;
constexpr double kSwatchGap = 8;

// Okabe and Ito's palette without its yellow, which is too light for lines on white.
constexpr std::array<Color, 7> kSeriesColors = {kBlue,
                                                kVermilion,
                                                Color{0, 158, 115},
                                                Color{230, 159, 0},
                                                Color{204, 121, 167},
                                                Color{86, 180, 233},
                                                Color{0, 0, 0}};

void DrawHairline(Canvas& canvas, PicturePoint from, PicturePoint to, const Color& color) {
  const std::array<PicturePoint, 2> ends = {from, to};
  canvas.Line(ends, {.width = 0.75, .color = color, .round_ends = false});
}

TextStyle Aligned(TextStyle style, TextAlign align) {
  style.align = align;
  return style;
}

}  // namespace

void Plot::DrawAxes() {
  DrawAxisUp();
  DrawAxisAcross();
}

void Plot::DrawAxisAcross() {
  const double right = frame_.left + frame_.width;
  const double bottom = frame_.top + frame_.height;
  canvas_.BeginGroup("axis-across");
  DrawHairline(canvas_, {frame_.left, bottom}, {right, bottom}, kAxisColor);
  const auto ticks = RoundTicks(across_.last, across_.least_step, kPlotTickStyle,
                                [this](double value) { return Across(value); });
  for (const Tick& tick : ticks) {
    DrawHairline(canvas_, {tick.at, bottom}, {tick.at, bottom + 4}, kAxisColor);
    canvas_.Text({tick.at, bottom + 15}, tick.label, Aligned(kPlotTickStyle, TextAlign::kCenter));
  }
  canvas_.Text({right, bottom + 29}, across_.name, Aligned(kPlotCaptionStyle, TextAlign::kRight));
  canvas_.EndGroup();
}

void Plot::DrawAxisUp() {
  const double right = frame_.left + frame_.width;
  canvas_.BeginGroup("axis-up");
  const auto ticks = RoundTicksUp(up_.last, up_.least_step, kPlotTickStyle,
                                  [this](double value) { return Up(value); });
  for (const Tick& tick : ticks) {
    DrawHairline(canvas_, {frame_.left, tick.at}, {right, tick.at}, kGridColor);
    canvas_.Text({frame_.left - 6, tick.at + 3.5}, tick.label,
                 Aligned(kPlotTickStyle, TextAlign::kRight));
  }
  canvas_.Text({frame_.left, frame_.top - 7}, up_.name, kPlotCaptionStyle);
  canvas_.EndGroup();
}

void Plot::DrawTitle(std::string_view title) {
  const double above = up_.name.empty() ? 7 : kPlotCaption + 7;
  canvas_.Text({frame_.left, frame_.top - above}, ShortenText(title, frame_.width, kPlotTitleStyle),
               kPlotTitleStyle);
}

void Plot::DrawCurve(std::span<const PicturePoint> values, const Stroke& stroke) {
  std::vector<PicturePoint> piece;
  const auto finish = [&] {
    // A single point between gaps would not be seen.
    if (piece.size() == 1) piece.push_back({piece.front().x + 0.5, piece.front().y});
    canvas_.Line(piece, stroke);
    piece.clear();
  };
  for (const PicturePoint& value : values) {
    if (std::isfinite(value.x) && std::isfinite(value.y)) {
      piece.push_back(Place(value));
    } else {
      finish();
    }
  }
  finish();
}

void Plot::DrawBand(double from, double to, const Color& color) {
  const double left = Across(std::clamp(from, 0.0, across_.last));
  const double right = Across(std::clamp(to, 0.0, across_.last));
  canvas_.Rectangle({left, frame_.top, std::max(right - left, 1.0), frame_.height}, color);
}

void Plot::DrawBar(double from, double to, double up, const Color& color) {
  canvas_.Rectangle({Across(from), Up(up), Across(to) - Across(from), Up(0) - Up(up)}, color);
}

Stroke SeriesStroke(std::size_t series, std::size_t series_count) {
  const auto before_last = static_cast<double>(series_count - 1);
  const double step = before_last > 0 ? std::min(1.6, 3 / before_last) : 0;
  return {.width = 1.6 + step * (before_last - static_cast<double>(series)),
          .color = kSeriesColors[series % kSeriesColors.size()],
          .round_ends = false,
          .dash = series < kSeriesColors.size() ? 0.0 : 5.0};
}

void DrawSeriesLegend(Canvas& canvas, PicturePoint at, std::span<const std::string> names) {
  canvas.BeginGroup("legend");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double y = at.y + static_cast<double>(i) * kLegendRow;
    const std::array<PicturePoint, 2> swatch = {PicturePoint{at.x, y},
                                                PicturePoint{at.x + kSwatchWidth, y}};
    canvas.Line(swatch, SeriesStroke(i, names.size()));
    canvas.Text({at.x + kSwatchWidth + kSwatchGap, y + 4}, names[i], kPlotLegendStyle);
  }
  canvas.EndGroup();
}

double SeriesLegendWidth(std::span<const std::string> names) {
  double width = 0;
  for (const std::string& name : names) width = std::max(width, TextWidth(name, kPlotLegendStyle));
  return kSwatchWidth + kSwatchGap + std::ceil(width);
}

}  // namespace kinebase::internal
