#include "kinebase/pictures/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "kinebase/core/error.h"
#include "pictures/png_canvas.h"
#include "pictures/svg_canvas.h"
#include "pictures/text.h"

namespace kinebase {
namespace {

template <typename SomeCanvas>
std::string Encode(PictureSize size, const std::function<void(Canvas&)>& draw) {
  SomeCanvas canvas(size);
  draw(canvas);
  return std::move(canvas).Finish();
}

std::uint8_t MixChannel(std::uint8_t from, std::uint8_t to, double share) {
  return static_cast<std::uint8_t>(std::lround(from + share * (to - from)));
}

}  // namespace

Color Mix(const Color& from, const Color& to, double share) {
  return {MixChannel(from.red, to.red, share), MixChannel(from.green, to.green, share),
          MixChannel(from.blue, to.blue, share), from.alpha + share * (to.alpha - from.alpha)};
}

void Canvas::Text(PicturePoint baseline, std::string_view text, const TextStyle& style) {
  if (!text.empty()) DrawText(baseline, internal::CleanText(text), style);
}

PictureFormat PictureFormatOf(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".svg") return PictureFormat::kSvg;
  if (extension == ".png") return PictureFormat::kPng;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("pictures are written as .svg or .png, not {}",
                          extension.empty() ? "without an extension" : "as " + extension),
              {path});
}

std::string EncodePicture(PictureFormat format, PictureSize size,
                          const std::function<void(Canvas&)>& draw) {
  size = {std::ceil(size.width), std::ceil(size.height)};
  const bool possible = size.width >= 1 && size.height >= 1;  // False for NaN, too.
  if (!possible || !std::isfinite(size.width + size.height)) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a picture cannot be {} × {} pixels", size.width, size.height));
  }
  return format == PictureFormat::kSvg ? Encode<internal::SvgCanvas>(size, draw)
                                       : Encode<internal::PngCanvas>(size, draw);
}

void WritePicture(const std::filesystem::path& path, PictureSize size, Overwrite overwrite,
                  const std::function<void(Canvas&)>& draw) {
  const PictureFormat format = PictureFormatOf(path);
  CheckWritable(path, overwrite);
  WriteFile(path, EncodePicture(format, size, draw), overwrite);
}

}  // namespace kinebase
