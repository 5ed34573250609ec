// The canvas that writes SVG elements. Internal.
#pragma once

#include <string>

#include "kinebase/pictures/canvas.h"

namespace kinebase::internal {

// Text stays text. `textLength` keeps every text as wide as it was measured, whatever font the
// viewer has.
class SvgCanvas final : public Canvas {
 public:
  explicit SvgCanvas(PictureSize size);

  void Rectangle(const PictureBox& box, const Color& fill) override;
  void Line(std::span<const PicturePoint> points, const Stroke& stroke) override;
  void Circle(PicturePoint centre, double radius, const Color& fill,
              const Stroke& outline) override;
  void BeginGroup(std::string_view name) override;
  void EndGroup() override;

  [[nodiscard]] std::string Finish() &&;

 protected:
  void DrawText(PicturePoint baseline, const std::string& text, const TextStyle& style) override;

 private:
  std::string svg_;
};

}  // namespace kinebase::internal
