#include "kinebase/features/smoothing.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <vector>

namespace kinebase {
namespace {

// Sample i of a signal continued at both ends by its mirror image, border samples repeated.
double Padded(const std::vector<double>& v, int i) {
  const int n = static_cast<int>(v.size());
  while (i < 0 || i >= n) i = i < 0 ? -1 - i : 2 * n - 1 - i;
  return v[i];
}

// out(t) = mean of v(t+1−P) … v(t+w−P), P = ⌈w/2⌉, word for word.
std::vector<double> PlainBox(const std::vector<double>& v, int w) {
  const int p = (w + 1) / 2;
  std::vector<double> out;
  for (int t = 0; t < static_cast<int>(v.size()); ++t) {
    double sum = 0;
    for (int i = t + 1 - p; i <= t + w - p; ++i) sum += Padded(v, i);
    out.push_back(sum / w);
  }
  return out;
}

RC_GTEST_PROP(BoxFilter, IsTheMeanOfTheFormulaWhateverTheWidth, ()) {
  std::vector<double> signal;
  for (const int value : *rc::gen::container<std::vector<int>>(rc::gen::inRange(-1000, 1000))) {
    signal.push_back(value / 8.0);
  }
  const int width = *rc::gen::inRange(1, 80);
  const auto expected = PlainBox(signal, width);
  const auto out = BoxFilter(signal, width);
  RC_ASSERT(out.size() == expected.size());
  for (std::size_t t = 0; t < out.size(); ++t) RC_ASSERT(std::abs(out[t] - expected[t]) < 1e-9);
}

TEST(BoxFilter, RepeatsTheBorderSamples) {
  // Width 2: each sample with the one after it. Width 3: with both neighbours.
  EXPECT_EQ(BoxFilter(std::vector<double>{1, 2, 4}, 2), (std::vector<double>{1.5, 3, 4}));
  EXPECT_EQ(BoxFilter(std::vector<double>{3, 6, 12}, 3), (std::vector<double>{4, 7, 10}));
}

TEST(BoxFilter, TakesWindowsLongerThanTheSignal) {
  EXPECT_EQ(BoxFilter(std::vector<double>{5}, 30), (std::vector<double>{5}));
  EXPECT_EQ(BoxFilter(std::vector<double>{1, 3}, 4), (std::vector<double>{2, 2}));
  EXPECT_TRUE(BoxFilter(std::vector<double>{}, 4).empty());
}

TEST(BoxFilter, LosesOnlyTheWindowsThatHoldAMissingSample) {
  std::vector<double> signal(20, 1.0);
  signal[10] = std::nan("");
  const auto out = BoxFilter(signal, 4);
  for (int t = 0; t < 20; ++t) EXPECT_EQ(std::isnan(out[t]), t >= 8 && t <= 11) << t;
}

TEST(BoxWidth, RoundsUpAndIsAtLeastOne) {
  EXPECT_EQ(BoxWidth(250, 120), 30);
  EXPECT_EQ(BoxWidth(100, 120), 12);
  EXPECT_EQ(BoxWidth(100, 25), 3);
  EXPECT_EQ(BoxWidth(0, 120), 1);
  EXPECT_EQ(BoxWidth(1, 30), 1);
}

}  // namespace
}  // namespace kinebase
