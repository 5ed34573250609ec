// The row of GLB: a skeleton's motion as a glTF scene.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/formats/glb.h"
#include "motion/file_formats.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

constexpr double kMetresPerCm = .01;
constexpr std::string_view kTip = "_end";

GlbVector Metres(const Eigen::Vector3d& cm) {
  const Eigen::Vector3f metres = (cm * kMetresPerCm).cast<float>();
  return {metres.x(), metres.y(), metres.z()};
}

GlbQuaternion ToGlb(const Eigen::Quaterniond& q) {
  const Eigen::Quaternionf unit = q.normalized().cast<float>();
  return {unit.x(), unit.y(), unit.z(), unit.w()};
}

// Rotations of one joint over time; of q and -q, which are the same rotation, the one nearer to the
// frame before: some programs blend without looking.
std::vector<GlbQuaternion> RotationsOf(const Motion& motion, int joint) {
  std::vector<GlbQuaternion> result;
  result.reserve(static_cast<std::size_t>(motion.frame_count));
  Eigen::Quaterniond before = Eigen::Quaterniond::Identity();
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    Eigen::Quaterniond q = motion.rotation(frame, joint);
    if (joint == 0) q = motion.skeleton->root_orientation() * q;
    if (q.dot(before) < 0) q.coeffs() = -q.coeffs();
    before = q;
    result.push_back(ToGlb(q));
  }
  return result;
}

template <typename T>
bool IsConstant(const std::vector<T>& values) {
  for (const T& value : values) {
    if (value != values.front()) return false;
  }
  return true;
}

// What does not change is said once, as the node's own.
template <typename T>
void Settle(std::vector<T>& values, T& own) {
  if (values.empty()) return;
  own = values.front();
  if (IsConstant(values)) values.clear();
}

class SceneBuilder {
 public:
  explicit SceneBuilder(const Motion& motion) : motion_(motion) {}

  GlbScene Build(const std::string& name) {
    scene_.name = name;
    scene_.rate_hz = motion_.rate_hz;
    scene_.first_frame = motion_.first_frame;
    for (int frame = 0; frame < motion_.frame_count; ++frame) {
      scene_.times_s.push_back(static_cast<float>(frame / motion_.rate_hz));
    }
    // Nodes of joints come first, so that they have the joints' indices.
    for (int joint = 0; joint < motion_.joint_count(); ++joint) AddNode(joint);
    for (int joint = 1; joint < motion_.joint_count(); ++joint) {
      if (motion_.skeleton->children(joint).empty()) AddTip(joint);
    }
    return std::move(scene_);
  }

 private:
  [[nodiscard]] const Joint& JointAt(int joint) const {
    return motion_.skeleton->joints()[static_cast<std::size_t>(joint)];
  }

  // Where a bone ends in each frame, from its start and in its own space; empty if that is always
  // the same.
  [[nodiscard]] std::vector<GlbVector> EndsOf(int joint) const {
    std::vector<GlbVector> ends;
    if (joint == 0 || motion_.extra_offsets_cm.empty()) return ends;
    const auto joints = static_cast<std::size_t>(motion_.joint_count());
    for (auto i = static_cast<std::size_t>(joint); i < motion_.extra_offsets_cm.size();
         i += joints) {
      ends.push_back(Metres(JointAt(joint).offset_cm + motion_.extra_offsets_cm[i]));
    }
    if (IsConstant(ends) && !ends.empty() && ends.front() == Metres(JointAt(joint).offset_cm)) {
      ends.clear();
    }
    return ends;
  }

  // A joint's node stands where its bone begins, as the bone's rotation turns about there: at the
  // end of the parent's.
  void AddNode(int joint) {
    const Joint& bone = JointAt(joint);
    GlbNode node{.name = bone.bone_name, .parent = bone.parent};
    if (joint == 0) {
      for (const auto& position : motion_.root_position_cm) {
        node.translations.push_back(Metres(position));
      }
    } else {
      node.translation = Metres(EndOf(bone.parent));
      node.translations = EndsOf(bone.parent);
      node.bone = Metres(bone.offset_cm);
    }
    node.rotations = RotationsOf(motion_, joint);
    Settle(node.translations, node.translation);
    Settle(node.rotations, node.rotation);
    scene_.nodes.push_back(std::move(node));
  }

  // Where the last bone of a chain ends.
  void AddTip(int joint) {
    GlbNode tip{.name = JointAt(joint).bone_name + std::string(kTip),
                .parent = joint,
                .translation = Metres(EndOf(joint)),
                .translations = EndsOf(joint)};
    Settle(tip.translations, tip.translation);
    scene_.nodes.push_back(std::move(tip));
  }

  // The root's place is its node's own.
  [[nodiscard]] Eigen::Vector3d EndOf(int joint) const {
    return joint == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : JointAt(joint).offset_cm;
  }

  const Motion& motion_;
  GlbScene scene_;
};

void CheckTimes(const Motion& motion, const std::filesystem::path& path) {
  const double last_s = motion.duration_s();
  const float step = std::nextafter(static_cast<float>(last_s), 1e30F) - static_cast<float>(last_s);
  if (static_cast<double>(step) * 2 < 1 / motion.rate_hz) return;
  throw Error(ErrorCode::kMismatch,
              fmt::format("{:.0f} s at {:g} Hz are more than the times of glTF can tell apart; cut "
                          "the recording or lower its rate first",
                          last_s, motion.rate_hz),
              {path});
}

}  // namespace

void SaveGlb(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics) {
  RequireSkeleton(recording, "GLB", path);
  const bool other_unit = !options.units.empty() && CentimetresIn(options.units) != 100.;
  if (options.up_axis.value_or(UpAxis::kY) != UpAxis::kY || other_unit) {
    throw Error(ErrorCode::kInvalidArgument,
                "GLB has Y up and lengths in metres by its specification; write it without --up "
                "and --units",
                {path});
  }
  ReportRecordLoss(recording, "GLB", diagnostics);
  CheckTimes(recording.motion, path);
  CheckWritable(path, options.overwrite);
  const std::string bytes = FormatGlb(SceneBuilder(recording.motion).Build(path.stem().string()));
  diagnostics.push_back(
      {Severity::kInfo, "degrees of freedom and their limits have no place in a GLB file"});
  WriteFile(path, bytes, options.overwrite);
}

}  // namespace kinebase::internal
