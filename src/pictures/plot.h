// A panel with axes that data are drawn into, and the series' colours and legend. Internal.
//
// Texts stand outside the frame that the caller gives: he leaves the room that the constants say.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "kinebase/pictures/canvas.h"
#include "pictures/axis.h"

namespace kinebase::internal {

inline constexpr double kPlotMargin = 24;   // Around a picture.
inline constexpr double kPlotLeft = 38;     // Beside a frame, for the ticks of its axis.
inline constexpr double kPlotBottom = 36;   // Below, for ticks and the axis' name.
inline constexpr double kPlotCaption = 16;  // Above, for the name of the axis that goes up,
inline constexpr double kPlotTitle = 20;    // and above that, for a title.

inline constexpr TextStyle kPictureTitleStyle = {.size = 17, .bold = true};
inline constexpr TextStyle kPlotTitleStyle = {.size = 11, .bold = true};
inline constexpr TextStyle kPlotTickStyle = {.size = 10, .color = {60, 60, 60}};
inline constexpr TextStyle kPlotCaptionStyle = {.size = 10, .color = {95, 95, 95}};
inline constexpr TextStyle kPlotLegendStyle = {.size = 11};

inline constexpr Color kAxisColor = {120, 120, 120};
inline constexpr Color kGridColor = {228, 228, 228};
inline constexpr Color kBlue = {0, 114, 178};
inline constexpr Color kVermilion = {213, 94, 0};

// From 0.
struct PlotAxis {
  double last = 1;
  double least_step = 0.01;  // No finer ticks.
  std::string_view name;     // May be empty.
};

class Plot {
 public:
  Plot(Canvas& canvas, const PictureBox& frame, const PlotAxis& across, const PlotAxis& up)
      : canvas_(canvas), frame_(frame), across_(across), up_(up) {}

  // Hairlines at the ticks, their labels and the names of the axes. What comes later covers them.
  void DrawAxes();
  // Only one of them, where the other means nothing or is drawn elsewhere.
  void DrawAxisAcross();
  void DrawAxisUp();

  // Above the frame and the caption of its axis, as much as fits the frame's width.
  void DrawTitle(std::string_view title);

  [[nodiscard]] double Across(double value) const {
    return frame_.left + frame_.width * value / across_.last;
  }
  [[nodiscard]] double Up(double value) const {
    return frame_.top + frame_.height * (1 - value / up_.last);
  }
  [[nodiscard]] PicturePoint Place(const PicturePoint& values) const {
    return {Across(values.x), Up(values.y)};
  }

  // values  Not pixels. The line is broken where one is not finite.
  void DrawCurve(std::span<const PicturePoint> values, const Stroke& stroke);

  // Over the whole height, from one value across to another; at least a pixel wide.
  void DrawBand(double from, double to, const Color& color);

  // From the bottom to a height.
  void DrawBar(double from, double to, double up, const Color& color);

 private:
  Canvas& canvas_;
  PictureBox frame_;
  PlotAxis across_;
  PlotAxis up_;
};

// Colours that people of every colour vision can tell apart; after seven, dashes. What is drawn
// first is drawn wider, so that equal curves do not hide each other.
[[nodiscard]] Stroke SeriesStroke(std::size_t series, std::size_t series_count);

inline constexpr double kLegendRow = 18;

// Names below each other, each beside a piece of its line.
void DrawSeriesLegend(Canvas& canvas, PicturePoint at, std::span<const std::string> names);
[[nodiscard]] double SeriesLegendWidth(std::span<const std::string> names);

}  // namespace kinebase::internal
