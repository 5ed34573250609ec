#include "pictures/stick_figure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace kinebase::internal {
namespace {

constexpr Color kPaper = {255, 255, 255};
constexpr double kFarthestFade = 0.42;  // Share of white in the farthest limb.
constexpr double kUsualDepth_cm = 60;   // Flatter poses do not fade as far.
constexpr double kDotNearer_cm = 1.5;   // Joints lie on their bones,
constexpr double kHeadNearer_cm = 8;    // and the head covers the neck that carries it.

// A ball from head to headtop would be half as wide as a head: the joint "head" lies in the skull.
constexpr double kHeadRadius = 0.85;  // In distances from head to headtop.

struct Part {
  double depth_cm = 0;  // Towards the camera.
  std::function<void()> draw;
};

// Lighter the farther away, within one pose.
class DepthFade {
 public:
  explicit DepthFade(const SeenPose& pose) {
    double farthest = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& joint : pose) {
      if (!joint.allFinite()) continue;
      nearest_ = std::max(nearest_, joint.z());
      farthest = std::min(farthest, joint.z());
    }
    range_ = std::max(nearest_ - farthest, kUsualDepth_cm);
  }

  [[nodiscard]] Color operator()(const Color& color, double depth_cm) const {
    return Mix(color, kPaper, kFarthestFade * std::clamp((nearest_ - depth_cm) / range_, 0.0, 1.0));
  }

 private:
  double nearest_ = -std::numeric_limits<double>::infinity();
  double range_ = kUsualDepth_cm;
};

class Figure {
 public:
  Figure(Canvas& canvas, const SeenPose& pose, const FigurePlace& place)
      : canvas_(canvas),
        pose_(pose),
        place_(place),
        fade_(pose),
        bone_width_(std::clamp(3.2 * place.pixels_per_cm, 1.4, 3.6)) {}

  void Draw() {
    for (int i = 0; i < kStandardJointCount; ++i) {
      const auto joint = static_cast<StandardJoint>(i);
      AddBone(joint);
      AddDot(joint);
    }
    AddHead();
    std::ranges::stable_sort(parts_, {}, &Part::depth_cm);
    for (const Part& part : parts_) part.draw();
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& at(StandardJoint joint) const {
    return pose_[static_cast<int>(joint)];
  }

  void AddBone(StandardJoint joint) {
    const std::optional<StandardJoint> parent = StandardParent(joint);
    if (!parent || joint == StandardJoint::kHeadtop) return;
    const Eigen::Vector3d from = at(*parent);
    const Eigen::Vector3d to = at(joint);
    if (!from.allFinite() || !to.allFinite()) return;
    const double depth = (from.z() + to.z()) / 2;
    const Color color = fade_(SideColor(joint), depth);
    parts_.push_back({depth, [=, this] {
                        const std::array<PicturePoint, 2> line = {place_(from), place_(to)};
                        DrawRim(line[0], line[1]);
                        canvas_.Line(line, {.width = bone_width_, .color = color});
                      }});
  }

  // Paper along both sides of a bone shows which of two crossing limbs is in front; none near its
  // ends, where it would cut off the bones that meet it.
  void DrawRim(const PicturePoint& from, const PicturePoint& to) {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double spared = 2 * bone_width_;
    if (length <= 2 * spared) return;
    const double x = (to.x - from.x) * spared / length;
    const double y = (to.y - from.y) * spared / length;
    const std::array<PicturePoint, 2> middle = {PicturePoint{from.x + x, from.y + y},
                                                PicturePoint{to.x - x, to.y - y}};
    canvas_.Line(middle, {.width = bone_width_ + 2.4, .color = kPaper, .round_ends = false});
  }

  void AddDot(StandardJoint joint) {
    const Eigen::Vector3d centre = at(joint);
    if (!centre.allFinite() || joint == StandardJoint::kHeadtop) return;
    const Color color = fade_(Mix(SideColor(joint), {0, 0, 0}, 0.35), centre.z());
    parts_.push_back({centre.z() + kDotNearer_cm, [=, this] {
                        canvas_.Circle(place_(centre), bone_width_ * 0.68, color, {.width = 0});
                      }});
  }

  void AddHead() {
    const std::optional<SeenHead> head = FindHead(pose_);
    if (!head) return;
    const Color color = fade_(kMiddleColor, head->centre.z());
    parts_.push_back({head->centre.z() + kHeadNearer_cm, [=, this] {
                        canvas_.Circle(place_(head->centre), head->radius_cm * place_.pixels_per_cm,
                                       Mix(color, kPaper, 0.82),
                                       {.width = bone_width_ * 0.55, .color = color});
                      }});
  }

  Canvas& canvas_;
  const SeenPose& pose_;
  const FigurePlace& place_;
  DepthFade fade_;
  double bone_width_;
  std::vector<Part> parts_;
};

}  // namespace

Color SideColor(StandardJoint joint) {
  if (Mirrored(joint) == joint) return kMiddleColor;
  return ToString(joint).starts_with('l') ? kLeftColor : kRightColor;
}

std::optional<SeenHead> FindHead(const SeenPose& pose) {
  const Eigen::Vector3d& head = pose[static_cast<int>(StandardJoint::kHead)];
  const Eigen::Vector3d& top = pose[static_cast<int>(StandardJoint::kHeadtop)];
  if (!head.allFinite() || !top.allFinite()) return std::nullopt;
  return SeenHead{(head + top) / 2, kHeadRadius * (top - head).norm()};
}

void DrawStickFigure(Canvas& canvas, const SeenPose& pose, const FigurePlace& place) {
  canvas.BeginGroup("pose");
  Figure(canvas, pose, place).Draw();
  canvas.EndGroup();
}

}  // namespace kinebase::internal
