#include "kinebase/pictures/delta_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinebase/core/error.h"
#include "pictures/plot.h"

namespace kinebase {
namespace {

using internal::kPlotLeft;
using internal::kPlotMargin;
using internal::Plot;

constexpr double kCurvesWidth = 900;
constexpr double kCurveHeight = 84;
constexpr double kRowHead = 24;      // Above each curve: the name of its template.
constexpr double kTitleHeight = 24;  // Of a recording.
constexpr double kLabelsTop = 12;
constexpr double kLabelPitch = 16;
constexpr double kLabelHeight = 11;
constexpr double kAxisHeight = 38;  // Seconds, and frames below them.
constexpr double kPanelGap = 26;
constexpr double kLegendHeight = 16;
constexpr double kMostNameWidth = 200;
constexpr double kNameGap = 10;
// Finer than this no screen shows.
constexpr auto kMostPoints = static_cast<std::size_t>(2 * kCurvesWidth);

constexpr TextStyle kTitle = {.size = 14, .bold = true};
constexpr TextStyle kName = {.size = 11, .bold = true};
constexpr TextStyle kFact = {.size = 10, .color = {95, 95, 95}, .align = TextAlign::kRight};
constexpr TextStyle kLabelName = {.size = 10, .color = {60, 60, 60}, .align = TextAlign::kRight};
constexpr TextStyle kTick = {.size = 10, .color = {60, 60, 60}, .align = TextAlign::kCenter};
constexpr Color kBackground = {246, 246, 246};

void CheckBars(const std::vector<TimelineBar>& bars, const std::string& name) {
  for (const TimelineBar& bar : bars) {
    if (bar.start_s <= bar.end_s) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a stretch of '{}' from {} to {} s; expected start ≤ end", name,
                            bar.start_s, bar.end_s));
  }
}

bool IsPositive(double value) { return value > 0 && std::isfinite(value); }

void CheckRow(const DeltaRow& row) {
  const bool possible = row.tau >= 0 && std::isfinite(row.tau) && IsPositive(row.rate_hz) &&
                        std::ranges::all_of(row.cost, [](double cost) { return cost >= 0; });
  if (!possible) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the curve of '{}' at {} columns a second, or its threshold, {}, is "
                            "below 0 or no number",
                            row.name, row.rate_hz, row.tau));
  }
  CheckBars(row.hits, row.name);
}

void Check(std::span<const DeltaPanel> panels) {
  if (panels.empty()) throw Error(ErrorCode::kInvalidArgument, "a picture of no recording");
  for (const DeltaPanel& panel : panels) {
    if (panel.rows.empty() || !IsPositive(panel.duration_s) || !IsPositive(panel.frame_rate_hz)) {
      throw Error(
          ErrorCode::kInvalidArgument,
          fmt::format("'{}' has {} curves over {} s at {} frames a second; expected one "
                      "curve or more, and numbers above 0",
                      panel.title, panel.rows.size(), panel.duration_s, panel.frame_rate_hz));
    }
    for (const DeltaRow& row : panel.rows) CheckRow(row);
    for (const TimelineRow& label : panel.labels) CheckBars(label.truth, label.name);
  }
}

double HeightOf(const DeltaPanel& panel) {
  const double labels = panel.labels.empty()
                            ? 0
                            : kLabelsTop + static_cast<double>(panel.labels.size()) * kLabelPitch;
  return kTitleHeight + static_cast<double>(panel.rows.size()) * (kRowHead + kCurveHeight) +
         labels + kAxisHeight;
}

// Names of labels stand where the ticks of the curves do, and may need more room.
double LeftOf(std::span<const DeltaPanel> panels) {
  double width = kPlotLeft;
  for (const DeltaPanel& panel : panels) {
    for (const TimelineRow& label : panel.labels) {
      const double name = std::min(std::ceil(TextWidth(label.name, kLabelName)), kMostNameWidth);
      width = std::max(width, name + kNameGap);
    }
  }
  return kPlotMargin + width;
}

double HighestCost(const DeltaRow& row) {
  double highest = row.tau;
  for (const double cost : row.cost) {
    if (std::isfinite(cost)) highest = std::max(highest, cost);
  }
  // Nothing costs anything: any axis will do.
  return highest > 0 ? highest * 1.04 : 1;
}

// The curve in seconds; of many columns the least and the greatest of each few, in their order.
std::vector<PicturePoint> PointsOf(const DeltaRow& row, const DeltaPanel& panel) {
  const std::size_t few = std::max<std::size_t>(1, 2 * row.cost.size() / kMostPoints);
  const auto point = [&](std::size_t column) {
    const double end_s = static_cast<double>(column + 1) / row.rate_hz;
    return PicturePoint{std::min(end_s, panel.duration_s), row.cost[column]};
  };
  std::vector<PicturePoint> points;
  for (std::size_t first = 0; first < row.cost.size(); first += few) {
    const auto begin = row.cost.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end =
        row.cost.begin() + static_cast<std::ptrdiff_t>(std::min(first + few, row.cost.size()));
    const auto [least, greatest] = std::minmax_element(begin, end);
    const auto a = static_cast<std::size_t>(std::min(least, greatest) - row.cost.begin());
    const auto b = static_cast<std::size_t>(std::max(least, greatest) - row.cost.begin());
    points.push_back(point(a));
    if (b != a) points.push_back(point(b));
  }
  return points;
}

// One recording's part of the picture.
class PanelDrawing {
 public:
  PanelDrawing(Canvas& canvas, const DeltaPanel& panel, double left)
      : canvas_(canvas), panel_(panel), left_(left) {}

  void Draw(double top) {
    canvas_.BeginGroup("recording");
    canvas_.Text({kPlotMargin, top + 12},
                 ShortenText(panel_.title, left_ + kCurvesWidth - kPlotMargin, kTitle), kTitle);
    top += kTitleHeight;
    for (const DeltaRow& row : panel_.rows) {
      DrawRow(row, top + kRowHead);
      top += kRowHead + kCurveHeight;
    }
    if (!panel_.labels.empty()) top += kLabelsTop;
    for (const TimelineRow& label : panel_.labels) {
      DrawLabel(label, top);
      top += kLabelPitch;
    }
    DrawTime(top);
    canvas_.EndGroup();
  }

 private:
  [[nodiscard]] double Place(double time_s) const {
    return left_ + kCurvesWidth * std::clamp(time_s / panel_.duration_s, 0.0, 1.0);
  }

  void DrawRow(const DeltaRow& row, double top) {
    canvas_.BeginGroup("curve");
    const std::string facts = fmt::format("τ = {:.3g} · {} {}", row.tau, row.hits.size(),
                                          row.hits.size() == 1 ? "hit" : "hits");
    const double facts_width = TextWidth(facts, kFact);
    canvas_.Text({left_, top - 7},
                 ShortenText(row.name, kCurvesWidth - facts_width - kNameGap, kName), kName);
    canvas_.Text({left_ + kCurvesWidth, top - 7}, facts, kFact);
    Plot plot(canvas_, {left_, top, kCurvesWidth, kCurveHeight}, {.last = panel_.duration_s},
              {.last = HighestCost(row), .least_step = 1e-6});
    for (const TimelineBar& hit : row.hits) plot.DrawBand(hit.start_s, hit.end_s, kDeltaHit);
    plot.DrawAxisUp();
    const std::vector<PicturePoint> threshold = {{0, row.tau}, {panel_.duration_s, row.tau}};
    plot.DrawCurve(threshold,
                   {.width = 1, .color = kDeltaThreshold, .round_ends = false, .dash = 4});
    plot.DrawCurve(PointsOf(row, panel_), {.width = 1.2, .color = kDeltaCurve});
    canvas_.EndGroup();
  }

  void DrawLabel(const TimelineRow& label, double top) {
    canvas_.BeginGroup("label");
    canvas_.Text({left_ - kNameGap, top + kLabelHeight - 2},
                 ShortenText(label.name, kMostNameWidth, kLabelName), kLabelName);
    canvas_.Rectangle({left_, top, kCurvesWidth, kLabelHeight}, kBackground);
    for (const TimelineBar& bar : label.truth) {
      if (bar.start_s >= panel_.duration_s || bar.end_s <= 0) continue;
      const double start = std::min(Place(bar.start_s), left_ + kCurvesWidth - 1);
      // A pixel less than it lasts keeps repetitions apart.
      canvas_.Rectangle({start, top, std::max(Place(bar.end_s) - start - 1, 1.0), kLabelHeight},
                        kTimelineTruth);
    }
    canvas_.EndGroup();
  }

  void DrawTime(double top) {
    canvas_.BeginGroup("time");
    const std::vector<PicturePoint> base = {{left_, top}, {left_ + kCurvesWidth, top}};
    canvas_.Line(base, {.width = 0.75, .color = internal::kAxisColor, .round_ends = false});
    DrawTicks(top, 15, internal::RoundTicks(panel_.duration_s, 1e-3, kTick, [this](double time_s) {
                return Place(time_s);
              }));
    canvas_.Text({left_ - kNameGap, top + 15}, "s", kFact);
    // Frames count from 1; frame n begins at (n − 1) / rate.
    DrawTicks(top, 30,
              internal::RoundTicks(
                  panel_.duration_s * panel_.frame_rate_hz, 1, kTick,
                  [this](double frames) { return Place(frames / panel_.frame_rate_hz); }));
    canvas_.Text({left_ - kNameGap, top + 30}, "frames", kFact);
    canvas_.EndGroup();
  }

  void DrawTicks(double top, double baseline, const std::vector<internal::Tick>& ticks) {
    for (const internal::Tick& tick : ticks) {
      if (baseline < 20) {
        const std::vector<PicturePoint> mark = {{tick.at, top}, {tick.at, top + 4}};
        canvas_.Line(mark, {.width = 0.75, .color = internal::kAxisColor, .round_ends = false});
      }
      canvas_.Text({tick.at, top + baseline}, tick.label, kTick);
    }
  }

  Canvas& canvas_;
  const DeltaPanel& panel_;
  double left_;
};

void DrawLegend(Canvas& canvas, PicturePoint at, bool has_labels) {
  canvas.BeginGroup("legend");
  const auto name = [&](std::string_view text) {
    canvas.Text({at.x + 30, at.y + 10}, text, internal::kPlotTickStyle);
    at.x += 30 + std::ceil(TextWidth(text, internal::kPlotTickStyle)) + 24;
  };
  const auto line = [&](const Stroke& stroke) {
    const std::vector<PicturePoint> swatch = {{at.x, at.y + 6}, {at.x + 22, at.y + 6}};
    canvas.Line(swatch, stroke);
  };
  line({.width = 1.2, .color = kDeltaCurve});
  name("cost of the best match that ends there");
  line({.width = 1, .color = kDeltaThreshold, .round_ends = false, .dash = 4});
  name("threshold τ");
  canvas.Rectangle({at.x, at.y, 22, 12}, kDeltaHit);
  name("hit");
  if (has_labels) {
    canvas.Rectangle({at.x, at.y, 22, 12}, kTimelineTruth);
    name("labelled so");
  }
  canvas.EndGroup();
}

}  // namespace

Picture DeltaCurvesPicture(std::vector<DeltaPanel> panels) {
  Check(panels);
  const double left = LeftOf(panels);
  PictureSize size = {left + kCurvesWidth + kPlotMargin, 2 * kPlotMargin + kLegendHeight};
  bool has_labels = false;
  for (const DeltaPanel& panel : panels) {
    size.height += HeightOf(panel) + kPanelGap;
    has_labels = has_labels || !panel.labels.empty();
  }
  return {size, [panels = std::move(panels), left, has_labels](Canvas& canvas) {
            double top = kPlotMargin;
            for (const DeltaPanel& panel : panels) {
              PanelDrawing(canvas, panel, left).Draw(top);
              top += HeightOf(panel) + kPanelGap;
            }
            DrawLegend(canvas, {left, top}, has_labels);
          }};
}

void DrawDeltaCurves(std::span<const DeltaPanel> panels, const std::filesystem::path& path,
                     Overwrite overwrite) {
  const Picture picture = DeltaCurvesPicture({panels.begin(), panels.end()});
  WritePicture(path, picture.size, overwrite, picture.draw);
}

}  // namespace kinebase
