#include "kinebase/pictures/pose_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/pictures/canvas.h"
#include "pictures/stick_figure.h"
#include "pictures/strip_floor.h"
#include "pictures/strip_layout.h"

namespace kinebase {
namespace {

using internal::kStripMargin;

constexpr TextStyle kRowTitleStyle = {.size = 13, .bold = true};
constexpr TextStyle kNoteStyle = {.size = 10.5, .color = {95, 95, 95}};
constexpr TextStyle kFrameStyle = {.size = 10.5, .align = TextAlign::kCenter};
constexpr TextStyle kTimeStyle = {
    .size = 10, .color = {110, 110, 110}, .align = TextAlign::kCenter};

void CheckRows(std::span<const PoseStripRow> rows, const PoseStripOptions& options) {
  if (rows.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "there is no recording to draw; give at least one");
  }
  if (options.poses < 1) {
    throw Error(
        ErrorCode::kInvalidArgument,
        fmt::format("{} poses in a row cannot be drawn; ask for at least one", options.poses));
  }
  for (const PoseStripRow& row : rows) {
    const JointTrajectories& joints = row.standard_joints;
    if (joints.joint_count != kStandardJointCount ||
        joints.positions_cm.size() % kStandardJointCount != 0) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("recording \"{}\" has {} positions of {} joints; a strip is drawn "
                              "from the {} standard joints",
                              row.title, joints.positions_cm.size(), joints.joint_count,
                              kStandardJointCount));
    }
    if (joints.frame_count() == 0) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("recording \"{}\" has no frames to draw", row.title));
    }
  }
}

std::string ViewNote(const PoseStripOptions& options) {
  std::string note = fmt::format("{} view", ToString(options.view));
  const bool lattice = options.view == PoseView::kTop || options.view == PoseView::kThreeQuarter;
  if (options.floor && lattice) note += " · floor squares of 50 cm";
  if (!options.trails.empty()) note += " · trails:";
  for (const StandardJoint joint : options.trails) note += fmt::format(" {}", ToString(joint));
  return note;
}

void DrawHeader(Canvas& canvas, const PoseStripOptions& options, double width) {
  const double baseline = kStripMargin + 10;
  double x = kStripMargin;
  canvas.BeginGroup("legend");
  for (const auto& [color, label] : {std::pair{internal::kLeftColor, "left"},
                                     {internal::kRightColor, "right"},
                                     {internal::kMiddleColor, "middle"}}) {
    const std::array<PicturePoint, 2> sample = {PicturePoint{x + 1, baseline - 4},
                                                PicturePoint{x + 17, baseline - 4}};
    canvas.Line(sample, {.width = 3.2, .color = color});
    canvas.Text({x + 24, baseline}, label, kNoteStyle);
    x += 24 + std::ceil(TextWidth(label, kNoteStyle)) + 18;
  }
  TextStyle right = kNoteStyle;
  right.align = TextAlign::kRight;
  canvas.Text({width - kStripMargin, baseline},
              ShortenText(ViewNote(options), width - kStripMargin - x, kNoteStyle), right);
  canvas.EndGroup();
}

std::string Facts(const JointTrajectories& joints) {
  const int frames = joints.frame_count();
  std::string facts = fmt::format("{} frame{}", frames, frames == 1 ? "" : "s");
  if (joints.rate_hz > 0) {
    facts += fmt::format(" · {:.2f} s · {:g} Hz", frames / joints.rate_hz, joints.rate_hz);
  }
  return facts;
}

void DrawTitle(Canvas& canvas, const PoseStripRow& row, double top, double width) {
  const std::string facts = Facts(row.standard_joints);
  const double room = width - 2 * kStripMargin - TextWidth(facts, kNoteStyle) - 16;
  const std::string title = ShortenText(row.title, room, kRowTitleStyle);
  const double gap = title.empty() ? 0 : 12;
  canvas.Text({kStripMargin, top + 13}, title, kRowTitleStyle);
  canvas.Text({kStripMargin + TextWidth(title, kRowTitleStyle) + gap, top + 13}, facts, kNoteStyle);
}

// Fades towards the past; a gap where the joint is missing.
void DrawTrail(Canvas& canvas, const internal::SeenTrail& trail,
               const internal::FigurePlace& place) {
  const auto count = trail.places.size();
  for (std::size_t i = 1; i < count; ++i) {
    const Eigen::Vector3d& from = trail.places[i - 1];
    const Eigen::Vector3d& to = trail.places[i];
    if (!from.allFinite() || !to.allFinite()) continue;
    Color color = internal::SideColor(trail.joint);
    const double age = 1 - static_cast<double>(i) / static_cast<double>(count - 1);
    color = Mix(color, {255, 255, 255}, 0.8 * age);
    const std::array<PicturePoint, 2> line = {place(from), place(to)};
    canvas.Line(line, {.width = 1.8, .color = color});
  }
}

void DrawLabels(Canvas& canvas, const PoseStripRow& row, int frame, PicturePoint top_middle) {
  canvas.Text({top_middle.x, top_middle.y + 13}, fmt::format("frame {}", row.first_frame + frame),
              kFrameStyle);
  if (row.standard_joints.rate_hz > 0) {
    canvas.Text({top_middle.x, top_middle.y + 27},
                fmt::format("{:.2f} s", frame / row.standard_joints.rate_hz), kTimeStyle);
  }
}

void DrawRow(Canvas& canvas, const internal::StripRow& row, const internal::StripLayout& layout,
             const PoseStripOptions& options) {
  canvas.BeginGroup("row");
  DrawTitle(canvas, *row.source, row.top, layout.size.width);
  const auto place = [&](std::size_t slot) {
    const double left = kStripMargin + layout.slot_width * static_cast<double>(slot);
    return internal::FigurePlace{{left + layout.slot_origin, row.floor_y}, layout.pixels_per_cm};
  };
  if (options.floor) {
    internal::DrawFloor(canvas, options.view, place(0), row.floor);
  }
  for (std::size_t i = 0; i < row.poses.size(); ++i) {
    canvas.BeginGroup("slot");
    for (const internal::SeenTrail& trail : row.poses[i].trails) {
      DrawTrail(canvas, trail, place(i));
    }
    internal::DrawStickFigure(canvas, row.poses[i].joints, place(i));
    const double middle = kStripMargin + layout.slot_width * (static_cast<double>(i) + 0.5);
    DrawLabels(canvas, *row.source, row.poses[i].frame, {middle, row.labels_top});
    canvas.EndGroup();
  }
  canvas.EndGroup();
}

}  // namespace

void DrawPoseStrip(std::span<const PoseStripRow> rows, const std::filesystem::path& path,
                   Overwrite overwrite, const PoseStripOptions& options) {
  CheckRows(rows, options);
  const internal::StripLayout layout = internal::LayOutStrip(rows, options);
  WritePicture(path, layout.size, overwrite, [&](Canvas& canvas) {
    DrawHeader(canvas, options, layout.size.width);
    for (const internal::StripRow& row : layout.rows) DrawRow(canvas, row, layout, options);
  });
}

}  // namespace kinebase
