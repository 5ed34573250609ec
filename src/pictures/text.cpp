#include "pictures/text.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace kinebase {
namespace internal {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD.

bool IsContinuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0) == 0x80; }

// Length of the UTF-8 sequence at the beginning of `text` (RFC 3629, Sect. 4); 0 if there is none.
std::size_t SequenceLength(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!IsContinuation(text[i])) return 0;
  }
  const auto second = static_cast<unsigned char>(text[1]);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second >= 0xA0;
  const bool too_large = lead == 0xF4 && second >= 0x90;
  const bool noncharacter =
      text.substr(0, 3) == "\xEF\xBF\xBE" || text.substr(0, 3) == "\xEF\xBF\xBF";
  return overlong || surrogate || too_large || noncharacter ? 0 : length;
}

}  // namespace

std::string CleanText(std::string_view text) {
  std::string clean;
  bool space = false;  // Not written until something follows.
  while (!text.empty()) {
    const std::size_t length = SequenceLength(text);
    if (length == 1 && (text[0] <= 0x20 || text[0] == 0x7F)) {
      space = !clean.empty();
    } else {
      if (space) clean += ' ';
      space = false;
      clean += length == 0 ? kReplacement : text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return clean;
}

void SelectFont(cairo_t* context, const TextStyle& style) {
  const std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> options(
      cairo_font_options_create(), &cairo_font_options_destroy);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context, options.get());
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                         style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, style.size);
}

double CleanTextWidth(const std::string& clean, const TextStyle& style) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1), &cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   &cairo_destroy);
  SelectFont(context.get(), style);
  cairo_text_extents_t extents{};
  cairo_text_extents(context.get(), clean.c_str(), &extents);
  return extents.x_advance;
}

}  // namespace internal

double TextWidth(std::string_view text, const TextStyle& style) {
  return internal::CleanTextWidth(internal::CleanText(text), style);
}

std::string ShortenText(std::string_view text, double width, const TextStyle& style) {
  std::string clean = internal::CleanText(text);
  if (internal::CleanTextWidth(clean, style) <= width) return clean;
  std::vector<std::size_t> starts;  // Of the characters, so that none is cut in two.
  for (std::size_t i = 0; i < clean.size(); ++i) {
    if (!internal::IsContinuation(clean[i])) starts.push_back(i);
  }
  const auto beginning = [&](std::size_t characters) {
    std::string shortened = clean.substr(0, starts[characters]);
    while (!shortened.empty() && shortened.back() == ' ') shortened.pop_back();
    return shortened + "…";
  };
  std::size_t fits = 0;
  std::size_t too_long = starts.size();
  while (fits + 1 < too_long) {
    const std::size_t middle = (fits + too_long) / 2;
    (internal::CleanTextWidth(beginning(middle), style) <= width ? fits : too_long) = middle;
  }
  return beginning(fits);
}

}  // namespace kinebase
