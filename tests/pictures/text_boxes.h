// Whether texts of a picture are in each other's way, or leave it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kinebase/pictures/canvas.h"
#include "pictures/svg_reader.h"

namespace kinebase::test {

// As SVG viewers set it: textLength wide, about its font size high, a fifth of it below the line.
inline PictureBox BoxOfText(const SvgElement& text) {
  const double width = text.Number("textLength");
  const double size = text.Number("font-size");
  double left = text.Number("x");
  const auto anchor = text.attributes.find("text-anchor");
  if (anchor != text.attributes.end()) left -= anchor->second == "middle" ? width / 2 : width;
  return {left, text.Number("y") - 0.75 * size, width, 0.95 * size};
}

inline bool Overlap(const PictureBox& a, const PictureBox& b) {
  return std::max(a.left, b.left) < std::min(a.left + a.width, b.left + b.width) &&
         std::max(a.top, b.top) < std::min(a.top + a.height, b.top + b.height);
}

inline void ExpectTextsApart(const SvgReader& svg) {
  const std::vector<SvgElement> texts = svg.Named("text");
  const SvgElement whole = svg.Named("svg").at(0);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const PictureBox box = BoxOfText(texts[i]);
    EXPECT_GE(box.left, 0) << texts[i].text;
    EXPECT_GE(box.top, 0) << texts[i].text;
    EXPECT_LE(box.left + box.width, whole.Number("width")) << texts[i].text;
    EXPECT_LE(box.top + box.height, whole.Number("height")) << texts[i].text;
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(Overlap(box, BoxOfText(texts[k]))) << texts[i].text << " on " << texts[k].text;
    }
  }
}

}  // namespace kinebase::test
