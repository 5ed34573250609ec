#include "pictures/strip_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pictures/stick_figure.h"

namespace kinebase::internal {
namespace {

constexpr double kMostFigureHeight = 190;  // Pixels.
constexpr double kUsualPosesWidth = 1500;
constexpr double kLeastSlotWidth = 84;    // So that "frame 12345" fits below.
constexpr double kMostPixelsPerCm = 1.1;  // So that people who crouch are not drawn as giants.
constexpr double kSlotGap = 14;
constexpr double kLeastContentWidth = 520;  // The legend's line.
constexpr double kRowGap = 14;
constexpr double kFloorReach_cm = 60;  // Away from and towards the camera.
constexpr double kHeadroom = 6;        // Half a line's width and air.

// Smallest box around what is seen; starts with the origin.
struct Extent {
  double left = 0, right = 0, low = 0, high = 0;

  void Add(const Eigen::Vector3d& seen, double reach = 0) {
    if (!seen.allFinite()) return;
    left = std::min(left, seen.x() - reach);
    right = std::max(right, seen.x() + reach);
    low = std::min(low, seen.y() - reach);
    high = std::max(high, seen.y() + reach);
  }
};

Extent ExtentOf(const StripRow& row) {
  Extent extent;
  for (const StripPose& pose : row.poses) {
    for (const Eigen::Vector3d& joint : pose.joints) extent.Add(joint);
    if (const auto head = FindHead(pose.joints)) extent.Add(head->centre, head->radius_cm);
    for (const SeenTrail& trail : pose.trails) {
      for (const Eigen::Vector3d& place : trail.places) extent.Add(place);
    }
  }
  return extent;
}

double LowestJoint(const JointTrajectories& standard_joints) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& position : standard_joints.positions_cm) {
    if (position.allFinite()) lowest = std::min(lowest, position.y());
  }
  return std::isfinite(lowest) ? lowest : 0;
}

// Evenly spread, the first and the last included.
std::vector<int> ChooseFrames(int frames, int poses) {
  const int count = std::min(frames, poses);
  std::vector<int> chosen;
  for (int i = 0; i < count; ++i) {
    const double share = count == 1 ? 0 : static_cast<double>(i) / (count - 1);
    chosen.push_back(static_cast<int>(std::lround(share * (frames - 1))));
  }
  return chosen;
}

SeenTrail SeeTrail(const PoseCamera& camera, const JointTrajectories& standard_joints,
                   StandardJoint joint, std::pair<int, int> frames, double floor_cm) {
  SeenTrail trail{joint, {}};
  for (int frame = frames.first; frame <= frames.second; ++frame) {
    trail.places.push_back(
        SeeJoint(camera, standard_joints, frame, static_cast<int>(joint), floor_cm));
  }
  return trail;
}

StripRow SeeRow(const PoseStripRow& source, const PoseStripOptions& options) {
  const JointTrajectories& joints = source.standard_joints;
  const PoseCamera camera = MakeCamera(options.view, Heading(joints));
  const double floor_cm = LowestJoint(joints);
  StripRow row;
  row.source = &source;
  const std::vector<int> frames = ChooseFrames(joints.frame_count(), options.poses);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    StripPose pose{frames[i], SeePose(camera, joints, frames[i], floor_cm), {}};
    const std::pair<int, int> since = frames.size() == 1
                                          ? std::pair{0, joints.frame_count() - 1}
                                          : std::pair{frames[i == 0 ? 0 : i - 1], frames[i]};
    for (const StandardJoint joint : options.trails) {
      pose.trails.push_back(SeeTrail(camera, joints, joint, since, floor_cm));
    }
    row.poses.push_back(std::move(pose));
  }
  return row;
}

// The scale and the width of a slot that all rows share.
void ChooseScale(std::span<const Extent> extents, std::size_t most_poses, StripLayout& layout) {
  Extent all;
  for (const Extent& extent : extents) {
    all.left = std::min(all.left, extent.left);
    all.right = std::max(all.right, extent.right);
    all.low = std::min(all.low, extent.low);
    all.high = std::max(all.high, extent.high);
  }
  const double height_cm = std::max(all.high - all.low, 1.0);
  const double width_cm = std::max(all.right - all.left, 1.0);
  const double usual_slot =
      std::max(kUsualPosesWidth / static_cast<double>(most_poses), kLeastSlotWidth);
  layout.pixels_per_cm = std::min(
      {kMostFigureHeight / height_cm, (usual_slot - kSlotGap) / width_cm, kMostPixelsPerCm});
  layout.slot_width =
      std::max(std::ceil(width_cm * layout.pixels_per_cm + kSlotGap), kLeastSlotWidth);
  layout.slot_origin = layout.slot_width / 2 - layout.pixels_per_cm * (all.left + all.right) / 2;
  layout.poses_width = layout.slot_width * static_cast<double>(most_poses);
}

// How far up and down the floor reaches in the picture, for a body that stands in its middle.
double FloorReach(const PoseStripOptions& options) {
  if (!options.floor || options.view == PoseView::kTop) return 0;
  const PoseCamera camera = MakeCamera(options.view, Eigen::Vector3d::UnitZ());
  return kFloorReach_cm * std::abs(camera.up.dot(camera.toward));
}

void PlaceRow(const Extent& extent, double top, const PoseStripOptions& options,
              const StripLayout& layout, StripRow& row) {
  const double usual_reach = FloorReach(options);
  // A floor that is seen holds all that comes near.
  const double reach = usual_reach > 0 ? std::max(usual_reach, -extent.low) : 0;
  const double high = std::max(extent.high, reach) * layout.pixels_per_cm;
  const double low = std::min(extent.low, -reach) * layout.pixels_per_cm;
  row.top = top;
  row.floor_y = std::ceil(top + kRowTitle + kHeadroom + high);
  row.labels_top = std::ceil(row.floor_y - low + kHeadroom);
  const double width = layout.slot_width * static_cast<double>(row.poses.size());
  row.floor = options.view == PoseView::kTop
                  ? PictureBox{kStripMargin, row.floor_y - high, width, high - low}
                  : PictureBox{kStripMargin, row.floor_y - reach * layout.pixels_per_cm, width,
                               2 * reach * layout.pixels_per_cm};
}

}  // namespace

StripLayout LayOutStrip(std::span<const PoseStripRow> rows, const PoseStripOptions& options) {
  StripLayout layout;
  std::vector<Extent> extents;
  std::size_t most_poses = 1;
  for (const PoseStripRow& source : rows) {
    layout.rows.push_back(SeeRow(source, options));
    extents.push_back(ExtentOf(layout.rows.back()));
    most_poses = std::max(most_poses, layout.rows.back().poses.size());
  }
  ChooseScale(extents, most_poses, layout);

  double top = kStripMargin + kStripHeader;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    StripRow& row = layout.rows[i];
    PlaceRow(extents[i], top, options, layout, row);
    top = row.labels_top + kRowLabels + kRowGap;
  }
  layout.size = {2 * kStripMargin + std::max(layout.poses_width, kLeastContentWidth),
                 top - kRowGap + kStripMargin};
  return layout;
}

}  // namespace kinebase::internal
