#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinebase/core/error.h"
#include "kinebase/pictures/evaluation_picture.h"
#include "pictures/plot.h"

namespace kinebase {
namespace {

using internal::kPlotBottom;
using internal::kPlotCaption;
using internal::kPlotLeft;
using internal::kPlotMargin;
using internal::kPlotTitle;
using internal::Plot;

constexpr PictureSize kWholeFrame = {460, 280};
constexpr PictureSize kPartFrame = {200, 110};
constexpr double kLegendGap = 28;
constexpr double kPartsGap = 24;    // Above the small panels,
constexpr double kPartGap = 22;     // between them,
constexpr double kPartBottom = 22;  // and below each, for its ticks.
constexpr std::size_t kPartsInRow = 4;

void CheckPanel(const PrecisionPanel& panel, std::size_t curve_count) {
  if (panel.curves.empty() || panel.curves.size() != curve_count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a panel '{}' of {} curves; expected one or more, as many in each",
                            panel.title, panel.curves.size()));
  }
  for (const PrecisionCurve& curve : panel.curves) {
    const bool possible =
        curve.precision.size() >= 2 &&
        std::ranges::all_of(curve.precision, [](double value) { return value >= 0 && value <= 1; });
    if (possible) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the curve of '{}' in '{}' has {} values; expected two or more from 0 "
                            "to 1",
                            curve.name, panel.title, curve.precision.size()));
  }
}

std::vector<std::string> NamesOf(const PrecisionPanel& panel) {
  std::vector<std::string> names;
  names.reserve(panel.curves.size());
  for (const PrecisionCurve& curve : panel.curves) names.push_back(curve.name);
  return names;
}

void DrawPanel(Canvas& canvas, const PictureBox& frame, const PrecisionPanel& panel,
               bool with_names) {
  canvas.BeginGroup("panel");
  Plot plot(canvas, frame, {.least_step = 0.1, .name = with_names ? "recall" : ""},
            {.least_step = 0.1, .name = with_names ? "precision" : ""});
  plot.DrawTitle(panel.title);
  plot.DrawAxes();
  for (std::size_t i = 0; i < panel.curves.size(); ++i) {
    const std::vector<double>& precision = panel.curves[i].precision;
    std::vector<PicturePoint> points;
    for (std::size_t k = 0; k < precision.size(); ++k) {
      points.push_back(
          {static_cast<double>(k) / static_cast<double>(precision.size() - 1), precision[k]});
    }
    plot.DrawCurve(points, internal::SeriesStroke(i, panel.curves.size()));
  }
  canvas.EndGroup();
}

PictureSize PictureSizeOf(const std::vector<std::string>& names, std::size_t part_count) {
  const std::size_t in_row = std::min(part_count, kPartsInRow);
  const std::size_t rows = (part_count + kPartsInRow - 1) / kPartsInRow;
  const double whole =
      kPlotLeft + kWholeFrame.width + kLegendGap + internal::SeriesLegendWidth(names);
  const double parts = static_cast<double>(in_row) * (kPlotLeft + kPartFrame.width + kPartGap);
  const double whole_height = kPlotTitle + kPlotCaption + kWholeFrame.height + kPlotBottom;
  const double part_height = kPlotTitle + kPartFrame.height + kPartBottom;
  return {2 * kPlotMargin + std::max(whole, parts - kPartGap),
          2 * kPlotMargin + whole_height +
              (rows > 0 ? kPartsGap + static_cast<double>(rows) * (part_height + kPartGap) : 0)};
}

PictureBox PartFrame(std::size_t index) {
  const auto column = static_cast<double>(index % kPartsInRow);
  const std::size_t full_rows = index / kPartsInRow;
  const auto row = static_cast<double>(full_rows);
  const double top = kPlotMargin + kPlotTitle + kPlotCaption + kWholeFrame.height + kPlotBottom +
                     kPartsGap + kPlotTitle;
  return {kPlotMargin + kPlotLeft + column * (kPlotLeft + kPartFrame.width + kPartGap),
          top + row * (kPlotTitle + kPartFrame.height + kPartBottom + kPartGap), kPartFrame.width,
          kPartFrame.height};
}

}  // namespace

Picture PrecisionPicture(PrecisionPanel whole, std::vector<PrecisionPanel> parts) {
  CheckPanel(whole, whole.curves.size());
  for (const PrecisionPanel& part : parts) CheckPanel(part, whole.curves.size());
  const std::vector<std::string> names = NamesOf(whole);
  const PictureSize size = PictureSizeOf(names, parts.size());
  return {size, [whole = std::move(whole), parts = std::move(parts), names](Canvas& canvas) {
            const PictureBox frame = {kPlotMargin + kPlotLeft,
                                      kPlotMargin + kPlotTitle + kPlotCaption, kWholeFrame.width,
                                      kWholeFrame.height};
            DrawPanel(canvas, frame, whole, true);
            internal::DrawSeriesLegend(
                canvas, {frame.left + frame.width + kLegendGap, frame.top + 8}, names);
            for (std::size_t i = 0; i < parts.size(); ++i) {
              DrawPanel(canvas, PartFrame(i), parts[i], false);
            }
          }};
}

}  // namespace kinebase
