// The canvas that paints dots with Cairo and ends as PNG. Internal.
#pragma once

#include <cairo.h>

#include <memory>
#include <string>

#include "kinebase/pictures/canvas.h"

namespace kinebase::internal {

class PngCanvas final : public Canvas {
 public:
  // Errors  InvalidArgument if the picture is larger than Cairo can paint.
  explicit PngCanvas(PictureSize size);

  void Rectangle(const PictureBox& box, const Color& fill) override;
  void Line(std::span<const PicturePoint> points, const Stroke& stroke) override;
  void Circle(PicturePoint centre, double radius, const Color& fill,
              const Stroke& outline) override;
  void BeginGroup(std::string_view) override {}
  void EndGroup() override {}

  [[nodiscard]] std::string Finish() &&;

 protected:
  void DrawText(PicturePoint baseline, const std::string& text, const TextStyle& style) override;

 private:
  void SetColor(const Color& color);
  void StrokePath(const Stroke& stroke);

  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
  std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace kinebase::internal
