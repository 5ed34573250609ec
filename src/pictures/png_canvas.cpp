#include "pictures/png_canvas.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <numbers>

#include "kinebase/core/error.h"
#include "pictures/text.h"

namespace kinebase::internal {
namespace {

// Cairo counts dots with 16 bits and a sign.
constexpr int kMostPixels = 32767 / kPngScale;

cairo_surface_t* MakeSurface(PictureSize size) {
  if (size.width > kMostPixels || size.height > kMostPixels) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the picture would be {} × {} pixels and a PNG holds at most {} × {}: "
                            "write an SVG, or draw less",
                            size.width, size.height, kMostPixels, kMostPixels));
  }
  return cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(size.width) * kPngScale,
                                    static_cast<int>(size.height) * kPngScale);
}

void Check(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  if (status == CAIRO_STATUS_NO_MEMORY) throw std::bad_alloc();
  throw Error(ErrorCode::kIoFailure,
              fmt::format("Cairo could not draw the picture: {}", cairo_status_to_string(status)));
}

// Called through C code, which no exception may cross.
cairo_status_t Append(void* png, const unsigned char* data, unsigned length) noexcept {
  try {
    static_cast<std::string*>(png)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  } catch (const std::exception&) {
    return CAIRO_STATUS_NO_MEMORY;
  }
}

}  // namespace

PngCanvas::PngCanvas(PictureSize size)
    : surface_(MakeSurface(size), &cairo_surface_destroy),
      context_(cairo_create(surface_.get()), &cairo_destroy) {
  Check(cairo_status(context_.get()));
  cairo_set_source_rgb(context_.get(), 1, 1, 1);
  cairo_paint(context_.get());
  cairo_scale(context_.get(), kPngScale, kPngScale);
}

void PngCanvas::Rectangle(const PictureBox& box, const Color& fill) {
  SetColor(fill);
  cairo_rectangle(context_.get(), box.left, box.top, box.width, box.height);
  cairo_fill(context_.get());
}

void PngCanvas::Line(std::span<const PicturePoint> points, const Stroke& stroke) {
  if (points.size() < 2) return;
  for (const PicturePoint& point : points) cairo_line_to(context_.get(), point.x, point.y);
  StrokePath(stroke);
}

void PngCanvas::Circle(PicturePoint centre, double radius, const Color& fill,
                       const Stroke& outline) {
  cairo_new_sub_path(context_.get());
  cairo_arc(context_.get(), centre.x, centre.y, radius, 0, 2 * std::numbers::pi);
  cairo_close_path(context_.get());
  SetColor(fill);
  cairo_fill_preserve(context_.get());
  StrokePath(outline);
}

std::string PngCanvas::Finish() && {
  Check(cairo_status(context_.get()));
  cairo_surface_flush(surface_.get());
  std::string png;
  Check(cairo_surface_write_to_png_stream(surface_.get(), &Append, &png));
  return png;
}

void PngCanvas::DrawText(PicturePoint baseline, const std::string& text, const TextStyle& style) {
  SelectFont(context_.get(), style);
  SetColor(style.color);
  double left = baseline.x;
  if (style.align != TextAlign::kLeft) {
    const double width = CleanTextWidth(text, style);
    left -= style.align == TextAlign::kCenter ? width / 2 : width;
  }
  cairo_move_to(context_.get(), left, baseline.y);
  cairo_show_text(context_.get(), text.c_str());
  cairo_new_path(context_.get());
}

void PngCanvas::SetColor(const Color& color) {
  cairo_set_source_rgba(context_.get(), color.red / 255.0, color.green / 255.0, color.blue / 255.0,
                        color.alpha);
}

void PngCanvas::StrokePath(const Stroke& stroke) {
  if (stroke.width > 0) {
    SetColor(stroke.color);
    cairo_set_line_width(context_.get(), stroke.width);
    cairo_set_line_cap(context_.get(),
                       stroke.round_ends ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(context_.get(),
                        stroke.round_ends ? CAIRO_LINE_JOIN_ROUND : CAIRO_LINE_JOIN_MITER);
    if (stroke.dash > 0) cairo_set_dash(context_.get(), &stroke.dash, 1, 0);
    cairo_stroke_preserve(context_.get());
    cairo_set_dash(context_.get(), nullptr, 0, 0);
  }
  cairo_new_path(context_.get());
}

}  // namespace kinebase::internal
