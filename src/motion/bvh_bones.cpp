// The joints of a BVH file as bones, and its channels as rotations and places.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/units.h"
#include "motion/bvh_figure.h"

namespace kinebase::internal {
namespace {

std::size_t At(int index) { return static_cast<std::size_t>(index); }

Dof ToDof(BvhChannel channel) { return static_cast<Dof>(channel); }

void AddDof(std::vector<Dof>& dofs, Dof dof) {
  if (std::ranges::find(dofs, dof) == dofs.end()) dofs.push_back(dof);
}

std::vector<BvhChannel> RotationsOf(const BvhJoint& joint) {
  std::vector<BvhChannel> rotations;
  std::ranges::copy_if(joint.channels, std::back_inserter(rotations),
                       [](BvhChannel channel) { return IsRotationChannel(channel); });
  return rotations;
}

// Channels turn about moving axes, left to right; an EulerOrder about fixed ones, so backwards.
// Missing axes come last; a repeated one (Z X Z) has no such order, and any can express it.
EulerOrder OrderOf(const BvhJoint& joint) {
  std::array<int, 3> axes{};
  std::size_t count = 0;
  const auto add = [&](int axis) {
    if (std::find(axes.begin(), axes.begin() + count, axis) == axes.begin() + count) {
      axes[count++] = axis;
    }
  };
  for (const BvhChannel channel : RotationsOf(joint)) add(AxisOfChannel(channel));
  for (const int axis : {2, 0, 1}) add(axis);
  std::string name;
  for (const int axis : {axes[2], axes[1], axes[0]}) name += static_cast<char>('X' + axis);
  return *ParseEulerOrder(name);
}

std::vector<Dof> RotationDofs(const BvhJoint& joint) {
  const std::vector<BvhChannel> rotations = RotationsOf(joint);
  std::vector<Dof> dofs;
  for (const BvhChannel channel : rotations) AddDof(dofs, ToDof(channel));
  if (rotations.size() > dofs.size()) {
    for (const Dof dof : {Dof::kRx, Dof::kRy, Dof::kRz}) AddDof(dofs, dof);
  }
  return dofs;
}

// Names without repetition; "root" is the root's own, in any case, as ASF has it.
class NameMaker {
 public:
  std::string Make(std::string name) {
    if (name.empty()) name = "joint";
    std::string candidate = name;
    for (int number = 2; taken_.contains(candidate) || IsRoot(candidate);) {
      // Names that repeat ten thousand times must not be tried ten thousand times each.
      int& next = next_number_[name];
      number = next = std::max(next + 1, number);
      candidate = fmt::format("{}_{}", name, number);
    }
    taken_.insert(candidate);
    return candidate;
  }

 private:
  static bool IsRoot(const std::string& name) {
    return name.size() == 4 && std::ranges::equal(name, std::string("root"),
                                                  [](char a, char b) { return (a | 0x20) == b; });
  }

  std::set<std::string> taken_;
  std::map<std::string, int> next_number_;
};

class BoneBuilder {
 public:
  BoneBuilder(const BvhMotion& bvh, RawFigure& figure) : bvh_(bvh), figure_(figure) {}

  void Build() {
    const int size = FirstFigureSize(bvh_);
    bone_of_.assign(At(size), 0);
    has_children_.assign(At(size), false);
    for (int i = 1; i < size; ++i) has_children_[At(bvh_.joints[At(i)].parent)] = true;
    AddRoot();
    for (int i = 0; i < size; ++i) {
      if (i > 0) AddJoint(i);
      AddTips(i);
    }
  }

 private:
  const BvhJoint& FileJoint(int index) const { return bvh_.joints[At(index)]; }

  void AddRoot() {
    const BvhJoint& file = FileJoint(0);
    Joint root{.name = file.name.empty() ? "root" : file.name, .bone_name = "root"};
    root.euler_order = OrderOf(file);
    for (const BvhChannel channel : file.channels) AddDof(root.dofs, ToDof(channel));
    // A root goes anywhere, whatever channels this file has.
    for (int dof = 0; dof < 6; ++dof) AddDof(root.dofs, static_cast<Dof>(dof));
    figure_.joints.push_back(std::move(root));
    figure_.bones.push_back({.place = 0, .rotation = 0});
  }

  void AddJoint(int index) {
    const BvhJoint& file = FileJoint(index);
    bone_of_[At(index)] = static_cast<int>(figure_.joints.size());
    AddBone(file.name, file.parent, file.offset);
    figure_.bones.back().place = index;
  }

  void AddTips(int index) {
    const BvhJoint& file = FileJoint(index);
    for (const auto& end_site : file.end_sites) AddBone(file.name + "_tip", index, end_site.offset);
    // A leaf's rotation would be lost without a bone that it turns.
    const bool is_bare_leaf = file.end_sites.empty() && !has_children_[At(index)];
    if (is_bare_leaf && index > 0) AddBone(file.name + "_tip", index, {});
  }

  // A bone that begins at a joint of the file and has its rotation.
  void AddBone(const std::string& name, int begin, const std::array<double, 3>& offset) {
    const int parent = bone_of_[At(begin)];
    Joint bone{.bone_name = names_.Make(name), .parent = parent};
    bone.name = figure_.joints[At(parent)].bone_name + "_@_" + bone.bone_name;
    bone.offset_cm = Eigen::Vector3d(offset.data());
    bone.length_cm = bone.offset_cm.norm();
    if (bone.length_cm > 0) bone.direction = bone.offset_cm / bone.length_cm;
    // The root's own rotation turns all that hangs on it.
    const int rotation = begin == 0 ? -1 : begin;
    if (rotation >= 0) {
      bone.euler_order = OrderOf(FileJoint(rotation));
      bone.dofs = RotationDofs(FileJoint(rotation));
    }
    figure_.joints.push_back(std::move(bone));
    figure_.bones.push_back({.rotation = rotation});
  }

  const BvhMotion& bvh_;
  RawFigure& figure_;
  NameMaker names_;
  std::vector<int> bone_of_;  // [joint of the file]
  std::vector<bool> has_children_;
};

// Values without gaps, as for AMC: what is missing is taken from the frame before, at the start
// from the first that has it; a value that no frame has is 0.
std::vector<double> FillMissing(const BvhMotion& bvh, Diagnostics& diagnostics) {
  std::vector<double> values = bvh.values;
  std::size_t missing = 0;
  for (std::size_t column = 0; column < bvh.column_count; ++column) {
    std::size_t known = column;
    while (known < values.size() && !std::isfinite(values[known])) known += bvh.column_count;
    double last = known < values.size() ? values[known] : 0;
    for (std::size_t i = column; i < values.size(); i += bvh.column_count) {
      if (!std::isfinite(values[i])) {
        values[i] = last;
        ++missing;
      }
      last = values[i];
    }
  }
  if (missing > 0) {
    diagnostics.push_back(
        {Severity::kWarning,
         fmt::format("{} missing values are replaced by those of the frame before, at the start by "
                     "the first that there are",
                     missing)});
  }
  return values;
}

Eigen::Quaterniond RotationIn(const BvhJoint& joint, const double* frame) {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    if (!IsRotationChannel(joint.channels[i])) continue;
    const double half = frame[joint.first_column + i] * kRadiansPerDegree / 2;
    Eigen::Quaterniond turn(std::cos(half), 0, 0, 0);
    turn.vec()[AxisOfChannel(joint.channels[i])] = std::sin(half);
    rotation = rotation * turn;
  }
  return rotation;
}

bool HasPositions(const BvhJoint& joint) {
  return !std::ranges::all_of(joint.channels, [](BvhChannel c) { return IsRotationChannel(c); });
}

// What position channels mean is not settled: some writers put the whole place from the parent
// there, others what is added to the offset. The reading whose values stay nearer to the joint's
// offset, or to zero, is the right one.
class PositionReading {
 public:
  explicit PositionReading(const std::vector<double>& values, std::size_t column_count)
      : values_(values), column_count_(column_count) {}

  void Weigh(const BvhJoint& joint, std::optional<int> only_axis = {}) {
    for (std::size_t i = 0; i < joint.channels.size(); ++i) {
      const BvhChannel channel = joint.channels[i];
      if (IsRotationChannel(channel) || (only_axis && AxisOfChannel(channel) != *only_axis))
        continue;
      const double offset = joint.offset[At(AxisOfChannel(channel))];
      for (std::size_t v = joint.first_column + i; v < values_.size(); v += column_count_) {
        from_offset_ += std::abs(values_[v] - offset);
        from_zero_ += std::abs(values_[v]);
      }
    }
  }

  [[nodiscard]] bool is_whole_place() const { return from_offset_ < from_zero_; }

 private:
  const std::vector<double>& values_;
  std::size_t column_count_;
  double from_offset_ = 0;
  double from_zero_ = 0;
};

// A joint's place from its parent.
Eigen::Vector3d PlaceIn(const BvhJoint& joint, const double* frame, bool is_whole_place) {
  Eigen::Vector3d place(joint.offset.data());
  if (is_whole_place) {
    for (const BvhChannel channel : joint.channels) {
      if (!IsRotationChannel(channel)) place[AxisOfChannel(channel)] = 0;
    }
  }
  for (std::size_t i = 0; i < joint.channels.size(); ++i) {
    if (IsRotationChannel(joint.channels[i])) continue;
    place[AxisOfChannel(joint.channels[i])] += frame[joint.first_column + i];
  }
  return place;
}

class FrameBuilder {
 public:
  FrameBuilder(const BvhMotion& bvh, RawFigure& figure, Diagnostics& diagnostics)
      : bvh_(bvh), figure_(figure), values_(FillMissing(bvh, diagnostics)) {
    ReadPositions(diagnostics);
  }

  void Build() {
    Motion& motion = figure_.motion;
    const std::size_t frames = bvh_.frame_count();
    const std::size_t bones = figure_.bones.size();
    motion.frame_count = static_cast<int>(frames);
    motion.rotations.resize(frames * bones);
    motion.root_position_cm.resize(frames);
    if (stretches_) motion.extra_offsets_cm.assign(frames * bones, Eigen::Vector3d::Zero());
    std::vector<Eigen::Quaterniond> turns(At(FirstFigureSize(bvh_)));
    for (std::size_t frame = 0; frame < frames; ++frame) {
      const double* row = values_.data() + frame * bvh_.column_count;
      for (std::size_t j = 0; j < turns.size(); ++j) turns[j] = RotationIn(bvh_.joints[j], row);
      motion.root_position_cm[frame] = PlaceIn(bvh_.joints[0], row, root_is_whole_);
      for (std::size_t b = 0; b < bones; ++b) {
        const BvhBone& bone = figure_.bones[b];
        motion.rotations[frame * bones + b] =
            bone.rotation < 0 ? Eigen::Quaterniond::Identity() : turns[At(bone.rotation)];
        if (!stretches_ || b == 0 || bone.place < 0) continue;
        const BvhJoint& joint = bvh_.joints[At(bone.place)];
        motion.extra_offsets_cm[frame * bones + b] =
            PlaceIn(joint, row, joints_are_whole_) - figure_.joints[b].offset_cm;
      }
    }
  }

 private:
  void ReadPositions(Diagnostics& diagnostics) {
    const BvhJoint& root = bvh_.joints[0];
    PositionReading of_root(values_, bvh_.column_count);
    // Sideways a figure may walk anywhere; its height tells.
    const bool has_height = root.offset[1] != 0 || root.offset[2] != 0;
    if (has_height) {
      of_root.Weigh(root, std::abs(root.offset[1]) >= std::abs(root.offset[2]) ? 1 : 2);
    } else {
      of_root.Weigh(root);
    }
    root_is_whole_ = of_root.is_whole_place();
    const bool root_matters = Eigen::Vector3d(root.offset.data()).norm() > 0;
    if (root_matters && HasPositions(root)) {
      Say(fmt::format("the root's position channels are read as {}", Meaning(root_is_whole_)),
          diagnostics);
    }
    ReadJointPositions(diagnostics);
  }

  void ReadJointPositions(Diagnostics& diagnostics) {
    PositionReading of_joints(values_, bvh_.column_count);
    std::vector<int> moving;
    for (std::size_t b = 1; b < figure_.bones.size(); ++b) {
      const int place = figure_.bones[b].place;
      if (place < 0 || !HasPositions(bvh_.joints[At(place)])) continue;
      of_joints.Weigh(bvh_.joints[At(place)]);
      moving.push_back(static_cast<int>(b));
    }
    if (moving.empty()) return;
    joints_are_whole_ = of_joints.is_whole_place();
    Say(fmt::format("{} joints have position channels, read as {}", moving.size(),
                    Meaning(joints_are_whole_)),
        diagnostics);
    stretches_ = std::ranges::any_of(moving, [&](int bone) { return Stretches(bone); });
    if (!stretches_) return;
    for (const int bone : moving) {
      std::vector<Dof> dofs;
      for (const BvhChannel channel : bvh_.joints[At(figure_.bones[At(bone)].place)].channels) {
        if (!IsRotationChannel(channel)) AddDof(dofs, ToDof(channel));
      }
      auto& all = figure_.joints[At(bone)].dofs;
      all.insert(all.begin(), dofs.begin(), dofs.end());
    }
  }

  // Whether a joint leaves its offset by more than its text was rounded.
  bool Stretches(int bone) const {
    constexpr double kRounding = 1e-7;
    const BvhJoint& joint = bvh_.joints[At(figure_.bones[At(bone)].place)];
    const Eigen::Vector3d& offset = figure_.joints[At(bone)].offset_cm;
    for (std::size_t row = 0; row < values_.size(); row += bvh_.column_count) {
      const Eigen::Vector3d place = PlaceIn(joint, values_.data() + row, joints_are_whole_);
      if ((place - offset).cwiseAbs().maxCoeff() > kRounding) return true;
    }
    return false;
  }

  static std::string_view Meaning(bool is_whole_place) {
    return is_whole_place ? "the whole place, in which the offset is contained"
                          : "what is added to the offset";
  }

  static void Say(std::string message, Diagnostics& diagnostics) {
    diagnostics.push_back({Severity::kInfo, std::move(message)});
  }

  const BvhMotion& bvh_;
  RawFigure& figure_;
  std::vector<double> values_;
  bool root_is_whole_ = false;
  bool joints_are_whole_ = false;
  bool stretches_ = false;
};

}  // namespace

int FirstFigureSize(const BvhMotion& bvh) {
  const auto next = std::find_if(bvh.joints.begin() + 1, bvh.joints.end(),
                                 [](const BvhJoint& joint) { return joint.parent < 0; });
  return static_cast<int>(next - bvh.joints.begin());
}

void BuildBones(const BvhMotion& bvh, RawFigure& figure) { BoneBuilder(bvh, figure).Build(); }

void BuildFrames(const BvhMotion& bvh, RawFigure& figure, Diagnostics& diagnostics) {
  FrameBuilder(bvh, figure, diagnostics).Build();
}

}  // namespace kinebase::internal
