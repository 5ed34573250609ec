#include <fmt/format.h>

#include <algorithm>
#include <array>
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

constexpr double kSide = 300;       // Of the upper frame, which is square.
constexpr double kBarsHeight = 60;  // Of the lower one.
constexpr double kBarsTop = 52;     // Between them, for ticks, the lower caption and numbers.
constexpr double kPanelGap = 30;
constexpr double kRadius = 4;
constexpr double kFaint = 0.3;

constexpr TextStyle kCount = {.size = 9, .color = {95, 95, 95}, .align = TextAlign::kCenter};

bool IsShare(double value) { return value >= 0 && value <= 1; }

void Check(const std::vector<ReliabilityPanel>& panels) {
  if (panels.empty()) throw Error(ErrorCode::kInvalidArgument, "a picture of no confidences");
  for (const ReliabilityPanel& panel : panels) {
    const bool possible = std::ranges::all_of(panel.groups, [](const ReliabilityGroup& group) {
      return group.hits == 0 || (IsShare(group.confidence) && IsShare(group.right));
    });
    if (possible && !panel.groups.empty()) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("'{}' has {} groups of confidences; expected one or more, confidence "
                            "and share right from 0 to 1",
                            panel.title, panel.groups.size()));
  }
}

// As wide as a bar at most.
std::string ShortCount(std::size_t count) {
  if (count < 10000) return std::to_string(count);
  if (count < 10000000) return fmt::format("{}k", (count + 500) / 1000);
  return fmt::format("{}M", (count + 500000) / 1000000);
}

Color GroupColor(const ReliabilityGroup& group) {
  Color color = internal::kBlue;
  if (group.hits < kFewHits) color.alpha = kFaint;
  return color;
}

void DrawShares(Canvas& canvas, const PictureBox& frame, const ReliabilityPanel& panel) {
  Plot plot(canvas, frame, {.least_step = 0.1}, {.least_step = 0.1, .name = "share right"});
  plot.DrawTitle(panel.title);
  plot.DrawAxes();
  const std::array<PicturePoint, 2> diagonal = {PicturePoint{0, 0}, PicturePoint{1, 1}};
  plot.DrawCurve(diagonal,
                 {.width = 1, .color = internal::kAxisColor, .round_ends = false, .dash = 4});
  canvas.BeginGroup("shares");
  for (const ReliabilityGroup& group : panel.groups) {
    if (group.hits == 0) continue;
    const Color color = GroupColor(group);
    const std::array<PicturePoint, 2> stem = {PicturePoint{group.confidence, group.confidence},
                                              PicturePoint{group.confidence, group.right}};
    plot.DrawCurve(stem, {.width = 1.6, .color = color, .round_ends = false});
    canvas.Circle(plot.Place({group.confidence, group.right}), kRadius, color, {.width = 0});
  }
  canvas.EndGroup();
}

void DrawNumbers(Canvas& canvas, const PictureBox& frame, const ReliabilityPanel& panel) {
  // One more than the hits, so that a single one has a height.
  const auto height = [](std::size_t hits) { return std::log10(static_cast<double>(hits) + 1); };
  double highest = 1;
  for (const ReliabilityGroup& group : panel.groups) {
    highest = std::max(highest, height(group.hits));
  }
  Plot plot(canvas, frame, {.least_step = 0.1, .name = "confidence"}, {.last = highest});
  plot.DrawAxisAcross();
  canvas.BeginGroup("numbers");
  canvas.Text({frame.left, frame.top - 18}, "hits, logarithmic", internal::kPlotCaptionStyle);
  const double step = 1.0 / static_cast<double>(panel.groups.size());
  for (std::size_t i = 0; i < panel.groups.size(); ++i) {
    const ReliabilityGroup& group = panel.groups[i];
    if (group.hits == 0) continue;
    const double from = static_cast<double>(i) * step;
    plot.DrawBar(from + 0.1 * step, from + 0.9 * step, height(group.hits), GroupColor(group));
    canvas.Text({plot.Across(from + step / 2), plot.Up(height(group.hits)) - 3},
                ShortCount(group.hits), kCount);
  }
  canvas.EndGroup();
}

std::size_t PanelsInRow(std::size_t count) {
  return count == 4 ? 2 : std::min<std::size_t>(count, 3);
}

constexpr double kPanelWidth = kPlotLeft + kSide;
constexpr double kPanelHeight =
    kPlotTitle + kPlotCaption + kSide + kBarsTop + kBarsHeight + kPlotBottom;

void DrawPanel(Canvas& canvas, PicturePoint corner, const ReliabilityPanel& panel) {
  const double left = corner.x + kPlotLeft;
  const double top = corner.y + kPlotTitle + kPlotCaption;
  canvas.BeginGroup("panel");
  DrawShares(canvas, {left, top, kSide, kSide}, panel);
  DrawNumbers(canvas, {left, top + kSide + kBarsTop, kSide, kBarsHeight}, panel);
  canvas.EndGroup();
}

}  // namespace

Picture ReliabilityPicture(std::vector<ReliabilityPanel> panels) {
  Check(panels);
  const std::size_t in_row = PanelsInRow(panels.size());
  const std::size_t rows = (panels.size() + in_row - 1) / in_row;
  const PictureSize size = {
      2 * kPlotMargin + static_cast<double>(in_row) * (kPanelWidth + kPanelGap) - kPanelGap,
      2 * kPlotMargin + static_cast<double>(rows) * (kPanelHeight + kPanelGap) - kPanelGap};
  return {size, [panels = std::move(panels), in_row](Canvas& canvas) {
            for (std::size_t i = 0; i < panels.size(); ++i) {
              const auto column = static_cast<double>(i % in_row);
              const std::size_t full_rows = i / in_row;
              const auto row = static_cast<double>(full_rows);
              DrawPanel(canvas,
                        {kPlotMargin + column * (kPanelWidth + kPanelGap),
                         kPlotMargin + row * (kPanelHeight + kPanelGap)},
                        panels[i]);
            }
          }};
}

}  // namespace kinebase
