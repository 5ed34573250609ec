#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinebase/core/error.h"
#include "kinebase/pictures/evaluation_picture.h"
#include "pictures/plot.h"

namespace kinebase {
namespace {

using internal::kPlotMargin;

constexpr double kTitleHeight = 34;
constexpr double kHeadHeight = 34;  // Of the columns: what they are, and their numbers.
constexpr double kLeastCell = 18;
constexpr double kCellPadding = 8;
constexpr double kMostNameWidth = 260;
constexpr double kGap = 10;  // Between numbers, names, cells and totals.

constexpr TextStyle kName = {.size = 11};
constexpr TextStyle kNumber = {.size = 10, .color = {95, 95, 95}, .align = TextAlign::kRight};
constexpr TextStyle kHead = {.size = 10, .color = {95, 95, 95}, .align = TextAlign::kCenter};
constexpr TextStyle kCaption = {.size = 10, .color = {95, 95, 95}};
constexpr TextStyle kCount = {.size = 10, .align = TextAlign::kCenter};
constexpr Color kEmptyCell = {246, 246, 246};
constexpr Color kWhite = {255, 255, 255};

void Check(const ConfusionCounts& confusion) {
  const std::size_t count = confusion.classes.size();
  if (count == 0 || confusion.counts.size() != count) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a confusion of {} classes in {} rows; expected one or more, a row "
                            "each",
                            count, confusion.counts.size()));
  }
  for (const std::vector<std::int64_t>& row : confusion.counts) {
    const bool has_length = row.size() == confusion.counts.front().size() &&
                            (row.size() == count || row.size() == count + 1);
    if (has_length && std::ranges::all_of(row, [](std::int64_t each) { return each >= 0; })) {
      continue;
    }
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a row of {} counts for {} classes; expected as many or one more, none "
                            "below 0",
                            row.size(), count));
  }
}

std::int64_t Total(const std::vector<std::int64_t>& row) {
  return std::reduce(row.begin(), row.end(), std::int64_t{0});
}

// Where things stand, in pixels.
struct Layout {
  double number_right = 0;
  double name_left = 0;
  double name_width = 0;
  double cells_left = 0;
  double cells_top = kPlotMargin + kTitleHeight + kHeadHeight;
  double cell_width = kLeastCell;
  double cell_height = kLeastCell;
  double total_right = 0;
  double share_right = 0;
  PictureSize size;
};

std::string ColumnHead(const ConfusionCounts& confusion, std::size_t column) {
  return column < confusion.classes.size() ? std::to_string(column + 1) : "none";
}

Layout LayOut(const ConfusionCounts& confusion) {
  Layout layout;
  const auto rows = static_cast<double>(confusion.classes.size());
  const std::size_t columns = confusion.counts.front().size();
  double widest = 0;
  double widest_total = TextWidth(confusion.counted, kNumber);
  for (const std::vector<std::int64_t>& row : confusion.counts) {
    for (const std::int64_t count : row) {
      widest = std::max(widest, TextWidth(std::to_string(count), kCount));
    }
    widest_total = std::max(widest_total, TextWidth(std::to_string(Total(row)), kNumber));
  }
  for (std::size_t i = 0; i < columns; ++i) {
    widest = std::max(widest, TextWidth(ColumnHead(confusion, i), kHead));
  }
  for (const std::string& name : confusion.classes) {
    layout.name_width = std::max(layout.name_width, TextWidth(name, kName));
  }
  layout.name_width = std::min(std::ceil(layout.name_width), kMostNameWidth);
  layout.number_right =
      kPlotMargin + std::ceil(TextWidth(std::to_string(confusion.classes.size()), kNumber));
  layout.name_left = layout.number_right + kGap;
  layout.cells_left = layout.name_left + layout.name_width + kGap;
  layout.cell_width = std::max(kLeastCell, std::ceil(widest) + kCellPadding);
  layout.cell_height = std::max(kLeastCell, std::min(layout.cell_width, 26.0));
  const double cells_right = layout.cells_left + static_cast<double>(columns) * layout.cell_width;
  layout.total_right = cells_right + kGap + std::ceil(widest_total);
  layout.share_right = layout.total_right + kGap + std::ceil(TextWidth("right", kNumber));
  const double title_right =
      kPlotMargin + std::ceil(TextWidth(confusion.title, internal::kPictureTitleStyle));
  layout.size = {std::max(layout.share_right, title_right) + kPlotMargin,
                 layout.cells_top + rows * layout.cell_height + kPlotMargin};
  return layout;
}

void DrawHead(Canvas& canvas, const ConfusionCounts& confusion, const Layout& layout) {
  canvas.BeginGroup("head");
  canvas.Text({kPlotMargin, kPlotMargin + 14}, confusion.title, internal::kPictureTitleStyle);
  const double baseline = layout.cells_top - 6;
  canvas.Text({layout.name_left, baseline}, "shown", kCaption);
  canvas.Text({layout.cells_left, baseline - 15}, "taken for", kCaption);
  for (std::size_t i = 0; i < confusion.counts.front().size(); ++i) {
    canvas.Text({layout.cells_left + (static_cast<double>(i) + 0.5) * layout.cell_width, baseline},
                ColumnHead(confusion, i), kHead);
  }
  canvas.Text({layout.total_right, baseline}, confusion.counted, kNumber);
  canvas.Text({layout.share_right, baseline}, "right", kNumber);
  canvas.EndGroup();
}

// A single one among many must still be seen.
Color CellColor(double share, bool right) {
  if (share == 0) return kEmptyCell;
  return Mix(kWhite, right ? internal::kBlue : internal::kVermilion, 0.2 + 0.8 * share);
}

void DrawRow(Canvas& canvas, const ConfusionCounts& confusion, const Layout& layout,
             std::size_t row) {
  const std::vector<std::int64_t>& counts = confusion.counts[row];
  const auto total = static_cast<double>(Total(counts));
  const double top = layout.cells_top + static_cast<double>(row) * layout.cell_height;
  const double baseline = top + layout.cell_height / 2 + 3.5;
  canvas.BeginGroup("row");
  canvas.Text({layout.number_right, baseline}, std::to_string(row + 1), kNumber);
  canvas.Text({layout.name_left, baseline},
              ShortenText(confusion.classes[row], layout.name_width, kName), kName);
  for (std::size_t column = 0; column < counts.size(); ++column) {
    const double share = total > 0 ? static_cast<double>(counts[column]) / total : 0;
    const double left = layout.cells_left + static_cast<double>(column) * layout.cell_width;
    canvas.Rectangle({left, top, layout.cell_width - 1, layout.cell_height - 1},
                     CellColor(share, row == column));
    if (counts[column] == 0) continue;
    TextStyle style = kCount;
    if (share > 0.45) style.color = kWhite;
    canvas.Text({left + (layout.cell_width - 1) / 2, baseline}, std::to_string(counts[column]),
                style);
  }
  canvas.Text({layout.total_right, baseline}, std::to_string(Total(counts)), kNumber);
  if (total > 0) {
    canvas.Text({layout.share_right, baseline},
                fmt::format("{:.2f}", static_cast<double>(counts[row]) / total), kNumber);
  }
  canvas.EndGroup();
}

}  // namespace

Picture ConfusionPicture(ConfusionCounts confusion) {
  Check(confusion);
  const Layout layout = LayOut(confusion);
  return {layout.size, [confusion = std::move(confusion), layout](Canvas& canvas) {
            DrawHead(canvas, confusion, layout);
            for (std::size_t row = 0; row < confusion.classes.size(); ++row) {
              DrawRow(canvas, confusion, layout, row);
            }
          }};
}

}  // namespace kinebase
