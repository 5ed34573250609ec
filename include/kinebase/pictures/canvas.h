// A drawing surface that ends as SVG or PNG.
//
// Read pictures/template_picture.h and pictures/pose_strip.h for what is drawn on it. One picture
// is described once, by a function that draws on a Canvas; where it goes decides the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "kinebase/core/output_file.h"

namespace kinebase {

// Places and lengths are in pixels from the upper left corner, y downwards. A PNG has
// kPngScale × kPngScale dots a pixel, so that it stays sharp on dense screens and on paper.
inline constexpr int kPngScale = 2;

struct PictureSize {
  double width = 0;  // Pixels; rounded up to whole ones.
  double height = 0;
};

struct PicturePoint {
  double x = 0;
  double y = 0;
};

struct PictureBox {
  double left = 0;
  double top = 0;
  double width = 0;
  double height = 0;
};

struct Color {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  double alpha = 1;  // 0 = cannot be seen.

  friend bool operator==(const Color&, const Color&) = default;
};

// `share` = 0 gives `from`, 1 gives `to`.
[[nodiscard]] Color Mix(const Color& from, const Color& to, double share);

struct Stroke {
  double width = 1;  // 0 = none.
  Color color = {};
  bool round_ends = true;
  double dash = 0;  // Length of dashes and of the gaps between them; 0 = one line.
};

enum class TextAlign { kLeft, kCenter, kRight };

struct TextStyle {
  double size = 11;
  bool bold = false;
  Color color = {34, 34, 34};
  TextAlign align = TextAlign::kLeft;
};

// White when drawing begins. What is drawn later covers what was drawn before.
class Canvas {
 public:
  virtual ~Canvas() = default;

  virtual void Rectangle(const PictureBox& box, const Color& fill) = 0;
  virtual void Line(std::span<const PicturePoint> points, const Stroke& stroke) = 0;
  virtual void Circle(PicturePoint centre, double radius, const Color& fill,
                      const Stroke& outline) = 0;

  // UTF-8 on one line. Bytes that are not UTF-8 become U+FFFD and control characters spaces: names
  // of files can hold both. Several spaces become one, as in SVG.
  void Text(PicturePoint baseline, std::string_view text, const TextStyle& style = {});

  // What is drawn until EndGroup belongs together; an SVG keeps that as <g class="name">.
  virtual void BeginGroup(std::string_view name) = 0;
  virtual void EndGroup() = 0;

 protected:
  virtual void DrawText(PicturePoint baseline, const std::string& text, const TextStyle& style) = 0;
};

// Width in the "sans-serif" font of this machine.
[[nodiscard]] double TextWidth(std::string_view text, const TextStyle& style = {});

// `text`, or its beginning and "…" where it is wider than `width`.
[[nodiscard]] std::string ShortenText(std::string_view text, double width,
                                      const TextStyle& style = {});

// A picture that is not drawn yet, for EncodePicture or WritePicture.
struct Picture {
  PictureSize size;
  std::function<void(Canvas&)> draw;
};

enum class PictureFormat { kSvg, kPng };

// By the extension in any case.
// Errors  InvalidArgument, naming those that work.
[[nodiscard]] PictureFormat PictureFormatOf(const std::filesystem::path& path);

// The bytes of a file. The same drawing gives the same bytes on machines with the same fonts.
//
// SVG is written here and PNG by Cairo: Cairo's own SVG turns text into outlines, which nobody can
// search, select or read aloud, and numbers its elements on from the picture drawn before.
// Errors  InvalidArgument: an empty size, or one that a PNG cannot have; what `draw` throws.
[[nodiscard]] std::string EncodePicture(PictureFormat format, PictureSize size,
                                        const std::function<void(Canvas&)>& draw);

// The same into a file, by its extension.
// Errors  InvalidArgument; AlreadyExists, before `draw` is called; IoFailure.
void WritePicture(const std::filesystem::path& path, PictureSize size, Overwrite overwrite,
                  const std::function<void(Canvas&)>& draw);

}  // namespace kinebase
