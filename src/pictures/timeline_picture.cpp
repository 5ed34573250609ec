#include "kinebase/pictures/timeline_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "kinebase/core/error.h"
#include "pictures/axis.h"

namespace kinebase {
namespace {

constexpr double kMargin = 24;
constexpr double kBarsWidth = 900;
constexpr double kTitleHeight = 26;
constexpr double kTruthHeight = 8;
constexpr double kFoundHeight = 14;
constexpr double kRowGap = 6;
constexpr double kAxisHeight = 34;
constexpr double kLegendHeight = 20;
constexpr double kMostNameWidth = 240;
constexpr double kNameGap = 12;  // Between names and bars.

constexpr TextStyle kTitle = {.size = 14, .bold = true};
constexpr TextStyle kName = {.size = 11, .align = TextAlign::kRight};
constexpr TextStyle kTick = {.size = 10, .color = {60, 60, 60}, .align = TextAlign::kCenter};
constexpr TextStyle kCaption = {.size = 10, .color = {95, 95, 95}, .align = TextAlign::kRight};
constexpr TextStyle kLegend = {.size = 10, .color = {60, 60, 60}};
constexpr Color kFrame = {120, 120, 120};
constexpr Color kBackground = {244, 244, 244};

double RowHeight(const Timeline& timeline) {
  return kFoundHeight + (timeline.has_truth ? kTruthHeight : 0);
}

double Height(const Timeline& timeline) {
  return kTitleHeight +
         static_cast<double>(timeline.rows.size()) * (RowHeight(timeline) + kRowGap) + kAxisHeight;
}

void CheckBars(const std::vector<TimelineBar>& bars, const TimelineRow& row) {
  for (const TimelineBar& bar : bars) {
    if (bar.start_s <= bar.end_s) continue;
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a bar of '{}' from {} to {} s; expected start ≤ end", row.name,
                            bar.start_s, bar.end_s));
  }
}

void CheckTimelines(std::span<const Timeline> timelines) {
  if (timelines.empty()) throw Error(ErrorCode::kInvalidArgument, "a picture of no recording");
  for (const Timeline& timeline : timelines) {
    if (timeline.rows.empty() || !(timeline.duration_s > 0) ||
        !std::isfinite(timeline.duration_s)) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("a timeline of {} rows and {} s; expected one and more than 0",
                              timeline.rows.size(), timeline.duration_s));
    }
    for (const TimelineRow& row : timeline.rows) {
      CheckBars(row.truth, row);
      CheckBars(row.found, row);
    }
  }
}

double NamesWidth(std::span<const Timeline> timelines) {
  double width = 0;
  for (const Timeline& timeline : timelines) {
    for (const TimelineRow& row : timeline.rows) {
      width = std::max(width, TextWidth(row.name, kName));
    }
  }
  return std::min(std::ceil(width), kMostNameWidth);
}

// One recording's part of the picture.
class TimelineDrawing {
 public:
  TimelineDrawing(Canvas& canvas, const Timeline& timeline, double left, double top)
      : canvas_(canvas), timeline_(timeline), left_(left), top_(top) {}

  void Draw() {
    canvas_.BeginGroup("timeline");
    canvas_.Text({kMargin, top_ + 14},
                 ShortenText(timeline_.title, left_ + kBarsWidth - kMargin, kTitle), kTitle);
    double top = top_ + kTitleHeight;
    for (const TimelineRow& row : timeline_.rows) {
      DrawRow(row, top);
      top += RowHeight(timeline_) + kRowGap;
    }
    DrawAxis(top);
    canvas_.EndGroup();
  }

 private:
  [[nodiscard]] double Place(double time_s) const {
    return left_ + kBarsWidth * std::clamp(time_s / timeline_.duration_s, 0.0, 1.0);
  }

  void DrawBar(double start_s, double end_s, double top, double height, const Color& color) {
    if (start_s >= timeline_.duration_s || end_s <= 0) return;
    const double start = std::min(Place(start_s), left_ + kBarsWidth - 1);
    canvas_.Rectangle({start, top, std::max(Place(end_s) - start, 1.0), height}, color);
  }

  // Red where nothing of the truth lies below, blue over it where something does.
  void DrawFound(const TimelineRow& row, double top) {
    for (const TimelineBar& found : row.found) {
      DrawBar(found.start_s, found.end_s, top, kFoundHeight,
              timeline_.has_truth ? kTimelineWrong : kTimelineRight);
      for (const TimelineBar& truth : row.truth) {
        const double start_s = std::max(found.start_s, truth.start_s);
        const double end_s = std::min(found.end_s, truth.end_s);
        if (start_s < end_s) DrawBar(start_s, end_s, top, kFoundHeight, kTimelineRight);
      }
    }
    // A line where a segment begins, so that repetitions can be counted.
    for (const TimelineBar& found : row.found) {
      if (found.start_s < 0 || found.start_s >= timeline_.duration_s) continue;
      const double x = Place(found.start_s);
      const std::array<PicturePoint, 2> line = {PicturePoint{x, top},
                                                PicturePoint{x, top + kFoundHeight}};
      canvas_.Line(line, {.width = 1, .color = {255, 255, 255}, .round_ends = false});
    }
  }

  void DrawRow(const TimelineRow& row, double top) {
    canvas_.BeginGroup("row");
    const double height = RowHeight(timeline_);
    canvas_.Text({left_ - kNameGap, top + height / 2 + 4},
                 ShortenText(row.name, kMostNameWidth, kName), kName);
    canvas_.Rectangle({left_, top, kBarsWidth, height}, kBackground);
    for (const TimelineBar& bar : row.truth) {
      DrawBar(bar.start_s, bar.end_s, top, kTruthHeight - 1, kTimelineTruth);
    }
    DrawFound(row, top + height - kFoundHeight);
    canvas_.EndGroup();
  }

  void DrawAxis(double top) {
    const std::array<PicturePoint, 2> base = {PicturePoint{left_, top},
                                              PicturePoint{left_ + kBarsWidth, top}};
    canvas_.Line(base, {.width = 0.75, .color = kFrame, .round_ends = false});
    canvas_.Text({left_ - kNameGap, top + 15}, "time in s", kCaption);
    const auto ticks = internal::RoundTicks(timeline_.duration_s, 1e-3, kTick,
                                            [this](double time_s) { return Place(time_s); });
    for (const internal::Tick& tick : ticks) {
      const std::array<PicturePoint, 2> mark = {PicturePoint{tick.at, top},
                                                PicturePoint{tick.at, top + 4}};
      canvas_.Line(mark, {.width = 0.75, .color = kFrame, .round_ends = false});
      canvas_.Text({tick.at, top + 15}, tick.label, kTick);
    }
  }

  Canvas& canvas_;
  const Timeline& timeline_;
  double left_;
  double top_;
};

void DrawLegend(Canvas& canvas, PicturePoint at, bool has_truth) {
  using Swatch = std::pair<Color, std::string_view>;
  std::vector<Swatch> swatches = {{kTimelineRight, "found"}};
  if (has_truth) {
    swatches = {{kTimelineTruth, "truth, above"},
                {kTimelineRight, "found, and true"},
                {kTimelineWrong, "found, and not true"}};
  }
  canvas.BeginGroup("legend");
  for (const auto& [color, label] : swatches) {
    canvas.Rectangle({at.x, at.y, 22, 12}, color);
    canvas.Text({at.x + 30, at.y + 10}, label, kLegend);
    at.x += 30 + std::ceil(TextWidth(label, kLegend)) + 24;
  }
  canvas.EndGroup();
}

}  // namespace

void DrawTimelines(std::span<const Timeline> timelines, const std::filesystem::path& path,
                   Overwrite overwrite) {
  CheckTimelines(timelines);
  const double left = kMargin + NamesWidth(timelines) + kNameGap;
  PictureSize size = {left + kBarsWidth + kMargin, 2 * kMargin + kLegendHeight};
  bool has_truth = false;
  for (const Timeline& timeline : timelines) {
    size.height += Height(timeline);
    has_truth = has_truth || timeline.has_truth;
  }
  WritePicture(path, size, overwrite, [&](Canvas& canvas) {
    double top = kMargin;
    for (const Timeline& timeline : timelines) {
      TimelineDrawing(canvas, timeline, left, top).Draw();
      top += Height(timeline);
    }
    DrawLegend(canvas, {left, top}, has_truth);
  });
}

}  // namespace kinebase
