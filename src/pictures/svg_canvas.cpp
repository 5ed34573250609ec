#include "pictures/svg_canvas.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "kinebase/core/text_scanner.h"
#include "pictures/text.h"

namespace kinebase::internal {
namespace {

// Hundredths of a pixel are finer than any screen.
std::string Number(double value) {
  const double rounded = std::round(value * 100) / 100;
  std::string text = fmt::format("{:.2f}", rounded == 0 ? 0 : rounded);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

std::string Paint(std::string_view property, const Color& color) {
  std::string attributes =
      fmt::format(" {}=\"#{:02x}{:02x}{:02x}\"", property, color.red, color.green, color.blue);
  if (color.alpha < 1) {
    attributes += fmt::format(" {}-opacity=\"{}\"", property, Number(color.alpha));
  }
  return attributes;
}

std::string StrokeAttributes(const Stroke& stroke) {
  if (stroke.width <= 0) return {};
  std::string attributes = Paint("stroke", stroke.color);
  attributes += fmt::format(" stroke-width=\"{}\"", Number(stroke.width));
  if (stroke.round_ends) attributes += " stroke-linecap=\"round\" stroke-linejoin=\"round\"";
  if (stroke.dash > 0) attributes += fmt::format(" stroke-dasharray=\"{}\"", Number(stroke.dash));
  return attributes;
}

}  // namespace

// Verdana has nearly the widths of DejaVu Sans, which "sans-serif" means on most Linux machines.
SvgCanvas::SvgCanvas(PictureSize size)
    : svg_(fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" "
                       "viewBox=\"0 0 {0} {1}\" "
                       "font-family=\"DejaVu Sans, Verdana, sans-serif\">\n"
                       "<style>rect {{ shape-rendering: crispEdges; }}</style>\n"
                       "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
                       size.width, size.height)) {}

void SvgCanvas::Rectangle(const PictureBox& box, const Color& fill) {
  fmt::format_to(std::back_inserter(svg_),
                 "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"{}/>\n", Number(box.left),
                 Number(box.top), Number(box.width), Number(box.height), Paint("fill", fill));
}

void SvgCanvas::Line(std::span<const PicturePoint> points, const Stroke& stroke) {
  if (points.size() < 2 || stroke.width <= 0) return;
  std::string places;
  for (const PicturePoint& point : points) {
    if (!places.empty()) places += ' ';
    places += Number(point.x) + "," + Number(point.y);
  }
  fmt::format_to(std::back_inserter(svg_), "<polyline points=\"{}\" fill=\"none\"{}/>\n", places,
                 StrokeAttributes(stroke));
}

void SvgCanvas::Circle(PicturePoint centre, double radius, const Color& fill,
                       const Stroke& outline) {
  fmt::format_to(std::back_inserter(svg_), "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}{}/>\n",
                 Number(centre.x), Number(centre.y), Number(radius), Paint("fill", fill),
                 StrokeAttributes(outline));
}

void SvgCanvas::BeginGroup(std::string_view name) {
  svg_ += fmt::format("<g class=\"{}\">\n", EscapeXml(CleanText(name)));
}

void SvgCanvas::EndGroup() { svg_ += "</g>\n"; }

std::string SvgCanvas::Finish() && {
  svg_ += "</svg>\n";
  return std::move(svg_);
}

void SvgCanvas::DrawText(PicturePoint baseline, const std::string& text, const TextStyle& style) {
  std::string attributes = Paint("fill", style.color);
  if (style.bold) attributes += " font-weight=\"bold\"";
  if (style.align != TextAlign::kLeft) {
    attributes +=
        fmt::format(" text-anchor=\"{}\"", style.align == TextAlign::kCenter ? "middle" : "end");
  }
  fmt::format_to(std::back_inserter(svg_),
                 "<text x=\"{}\" y=\"{}\" font-size=\"{}\" textLength=\"{}\" "
                 "lengthAdjust=\"spacingAndGlyphs\"{}>{}</text>\n",
                 Number(baseline.x), Number(baseline.y), Number(style.size),
                 Number(CleanTextWidth(text, style)), attributes, EscapeXml(text));
}

}  // namespace kinebase::internal
