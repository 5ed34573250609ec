// Dots of a PNG file, read by Cairo.
#pragma once

#include <cairo/cairo.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>

#include "kinebase/pictures/canvas.h"

namespace kinebase::test {

class PngReader {
 public:
  explicit PngReader(const std::filesystem::path& path)
      : surface_(cairo_image_surface_create_from_png(path.c_str()), &cairo_surface_destroy) {
    EXPECT_EQ(cairo_surface_status(surface_.get()), CAIRO_STATUS_SUCCESS) << path;
  }

  [[nodiscard]] int width() const { return cairo_image_surface_get_width(surface_.get()); }
  [[nodiscard]] int height() const { return cairo_image_surface_get_height(surface_.get()); }

  // The dot at a place given in pixels of the picture.
  [[nodiscard]] Color At(double x, double y) const {
    const int column = static_cast<int>(x * kPngScale);
    const int row = static_cast<int>(y * kPngScale);
    std::uint32_t dot = 0;
    std::memcpy(
        &dot,
        cairo_image_surface_get_data(surface_.get()) +
            static_cast<std::ptrdiff_t>(row) * cairo_image_surface_get_stride(surface_.get()) +
            static_cast<std::ptrdiff_t>(4) * column,
        sizeof dot);
    return {static_cast<std::uint8_t>(dot >> 16 & 0xFF), static_cast<std::uint8_t>(dot >> 8 & 0xFF),
            static_cast<std::uint8_t>(dot & 0xFF)};
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
};

}  // namespace kinebase::test
