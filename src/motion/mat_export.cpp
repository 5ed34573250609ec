// A recording as the structures `skel` and `mot`.

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/kinematics.h"
#include "motion/mat_structs.h"

namespace kinebase::internal {
namespace {

using Fields = std::vector<std::pair<std::string, MatArray>>;

// Indices of ours as MATLAB counts them.
MatArray Indices(const std::vector<int>& indices) {
  std::vector<double> numbers;
  numbers.reserve(indices.size());
  for (const int index : indices) numbers.push_back(index + 1);
  return MatColumn(std::move(numbers));
}

MatArray Vector(const Eigen::Vector3d& v) { return MatColumn({v.x(), v.y(), v.z()}); }

// Like MATLAB: [] where a cell or field holds nothing.
MatArray CellsOrEmpty(std::vector<MatArray> elements) {
  return elements.empty() ? MatArray() : MatCells(std::move(elements));
}

MatArray Texts(const std::vector<std::string>& texts) {
  std::vector<MatArray> cells;
  cells.reserve(texts.size());
  for (const std::string& text : texts) cells.push_back(MatText(text));
  return CellsOrEmpty(std::move(cells));
}

// What a joint's offset is inside its structure: the root's is where the figure stands.
Eigen::Vector3d OffsetOf(const Skeleton& skeleton, int joint) {
  return joint == 0 ? skeleton.root_position_cm()
                    : skeleton.joints()[static_cast<std::size_t>(joint)].offset_cm;
}

MatArray LimitsOf(const Joint& joint, double unit_cm) {
  std::vector<double> lows, highs;
  for (std::size_t d = 0; d < joint.limits.size(); ++d) {
    const double unit = IsRotation(joint.dofs[d]) ? kRadiansPerDegree : unit_cm;
    lows.push_back(joint.limits[d].low / unit);
    highs.push_back(joint.limits[d].high / unit);
  }
  lows.insert(lows.end(), highs.begin(), highs.end());
  return MatMatrix(joint.limits.size(), std::move(lows));
}

Fields NodeOf(const Skeleton& skeleton, int index, double unit_cm) {
  const Joint& joint = skeleton.joints()[static_cast<std::size_t>(index)];
  std::vector<std::string> dofs;
  dofs.reserve(joint.dofs.size());
  for (const Dof dof : joint.dofs) {
    const std::string_view name = ToString(static_cast<AsfDof>(dof));
    // As HDM05's ASF files write them: the root's in capitals, those of bones not.
    dofs.push_back(index == 0 ? std::string(name) : ToLower(name));
  }
  return {{"children", Indices(skeleton.children(index))},
          {"jointName", MatText(joint.name)},
          {"boneName", MatText(joint.bone_name)},
          {"ID", MatScalar(index + 1)},
          {"parentID", MatScalar(joint.parent + 1)},
          {"offset", Vector(OffsetOf(skeleton, index) / unit_cm)},
          {"direction", Vector(joint.direction)},
          {"length", MatScalar(joint.length_cm / unit_cm)},
          {"axis", Vector(joint.axis_rad / kRadiansPerDegree)},
          {"DOF", Texts(dofs)},
          {"rotationOrder", MatText(ToString(joint.euler_order))},
          {"limits", LimitsOf(joint, unit_cm)}};
}

MatArray NodesOf(const Skeleton& skeleton, double unit_cm) {
  MatArray nodes{.type = MatClass::kStruct, .dims = {skeleton.joint_count(), 1}};
  for (int i = 0; i < skeleton.joint_count(); ++i) {
    MatArray node = MatStruct(NodeOf(skeleton, i, unit_cm));
    nodes.fields = std::move(node.fields);
    std::ranges::move(node.elements, std::back_inserter(nodes.elements));
  }
  return nodes;
}

// Rows of (name, index of its rotation, index of its trajectory), by columns.
MatArray NameMap(const std::vector<std::string>& names, const std::vector<double>& rotations,
                 const std::vector<double>& trajectories) {
  MatArray map{.type = MatClass::kCell, .dims = {static_cast<std::int32_t>(names.size()), 3}};
  for (const std::string& name : names) map.elements.push_back(MatText(name));
  for (const double index : rotations) map.elements.push_back(MatScalar(index));
  for (const double index : trajectories) map.elements.push_back(MatScalar(index));
  return map;
}

MatArray NameMapOf(const Skeleton& skeleton) {
  std::vector<std::string> names;
  std::vector<double> rotations, trajectories;
  for (int j = 0; j < kStandardJointCount; ++j) {
    const NameMapEntry& entry = skeleton.name_map()[static_cast<std::size_t>(j)];
    names.emplace_back(ToString(static_cast<StandardJoint>(j)));
    rotations.push_back(entry.rotation_joint + 1);
    trajectories.push_back(entry.trajectory_joint + 1);
  }
  return NameMap(names, rotations, trajectories);
}

MatArray NameMapOf(const MarkerCloud& markers) {
  std::vector<double> indices(markers.labels.size());
  std::iota(indices.begin(), indices.end(), 1);
  return NameMap(markers.labels, std::vector<double>(indices.size(), 0), indices);
}

std::vector<std::string> JointNames(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints()) names.push_back(joint.name);
  return names;
}

std::vector<std::string> BoneNames(const Skeleton& skeleton) {
  std::vector<std::string> names;
  for (const Joint& joint : skeleton.joints()) names.push_back(joint.bone_name);
  return names;
}

// xmin xmax ymin ymax zmin zmax.
MatArray BoxOf(const BoundingBox& box, double unit_cm) {
  std::vector<double> numbers;
  for (int axis = 0; axis < 3; ++axis) {
    numbers.push_back(box.low_cm[axis] / unit_cm);
    numbers.push_back(box.high_cm[axis] / unit_cm);
  }
  return MatColumn(std::move(numbers));
}

// 3 × frames for each of `count` points that stand [frame × point].
MatArray TrajectoriesOf(const std::vector<Eigen::Vector3d>& positions_cm, std::size_t count,
                        double unit_cm) {
  std::vector<MatArray> cells;
  for (std::size_t point = 0; point < count; ++point) {
    std::vector<double> numbers;
    numbers.reserve(positions_cm.size() / count * 3);
    for (std::size_t i = point; i < positions_cm.size(); i += count) {
      for (const double value : positions_cm[i]) numbers.push_back(value / unit_cm);
    }
    cells.push_back(MatMatrix(3, std::move(numbers)));
  }
  return MatCells(std::move(cells));
}

MatArray RootTranslation(const Motion& motion, double unit_cm) {
  std::vector<double> numbers;
  numbers.reserve(motion.root_position_cm.size() * 3);
  for (const Eigen::Vector3d& position : motion.root_position_cm) {
    const Eigen::Vector3d translation = position - motion.skeleton->root_position_cm();
    for (const double value : translation) numbers.push_back(value / unit_cm);
  }
  return MatMatrix(3, std::move(numbers));
}

// Angles of the joint's rotational DOFs, in their order, × frames; [] without such DOFs.
MatArray EulerOf(const Motion& motion, int joint) {
  std::vector<int> axes;
  for (const Dof dof : motion.skeleton->joints()[static_cast<std::size_t>(joint)].dofs) {
    if (IsRotation(dof)) axes.push_back(AxisOf(dof));
  }
  if (axes.empty()) return {};
  std::vector<double> numbers;
  for (const Eigen::Vector3d& angles : EulerAngles(motion, joint)) {
    for (const int axis : axes) numbers.push_back(angles[axis] / kRadiansPerDegree);
  }
  return MatMatrix(axes.size(), std::move(numbers));
}

// 4 × frames; [] for a bone that cannot turn and does not.
MatArray QuaternionsOf(const Motion& motion, int joint) {
  std::vector<double> numbers;
  bool turns = !motion.skeleton->joints()[static_cast<std::size_t>(joint)].dofs.empty();
  for (int frame = 0; frame < motion.frame_count; ++frame) {
    const Eigen::Quaterniond& q = motion.rotation(frame, joint);
    turns = turns || !q.isApprox(Eigen::Quaterniond::Identity(), 0);
    numbers.insert(numbers.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  if (!turns) return {};
  return MatMatrix(4, std::move(numbers));
}

Fields MotOf(double rate_hz, int frames, MatArray trajectories, MatArray root_translation,
             MatArray euler, MatArray quaternions) {
  const auto count = static_cast<double>(trajectories.size());
  return {{"njoints", MatScalar(count)},
          {"nframes", MatScalar(frames)},
          {"frameTime", MatScalar(1 / rate_hz)},
          {"samplingRate", MatScalar(rate_hz)},
          {"jointTrajectories", std::move(trajectories)},
          {"rootTranslation", std::move(root_translation)},
          {"rotationEuler", std::move(euler)},
          {"rotationQuat", std::move(quaternions)}};
}

void AddFileFields(const BoundingBox& box, const std::string& file_name, double unit_cm,
                   Fields& fields) {
  fields.emplace_back("boundingBox", BoxOf(box, unit_cm));
  fields.emplace_back("filename", MatText(file_name));
  fields.emplace_back("documentation", MatText(""));
  fields.emplace_back("angleUnit", MatText("deg"));
}

}  // namespace

MatArray SkelOf(const Skeleton& skeleton, double unit_cm) {
  const SkeletonSource& source = skeleton.source();
  const Eigen::Quaterniond orientation = skeleton.root_orientation();
  std::vector<MatArray> paths;
  paths.reserve(skeleton.chains().size());
  for (const auto& chain : skeleton.chains()) paths.push_back(Indices(chain));
  return MatStruct(
      {{"njoints", MatScalar(skeleton.joint_count())},
       {"rootRotationalOffsetEuler", Vector(skeleton.root_orientation_rad() / kRadiansPerDegree)},
       {"rootRotationalOffsetQuat",
        MatColumn({orientation.w(), orientation.x(), orientation.y(), orientation.z()})},
       {"nodes", NodesOf(skeleton, unit_cm)},
       {"paths", MatCells(std::move(paths))},
       {"jointNames", Texts(JointNames(skeleton))},
       {"boneNames", Texts(BoneNames(skeleton))},
       {"nameMap", NameMapOf(skeleton)},
       {"animated", Indices(skeleton.animated())},
       {"unanimated", Indices(skeleton.unanimated())},
       {"filename", MatText(source.file_name)},
       {"version", MatText(source.version)},
       {"name", MatText(source.name)},
       {"massUnit", MatScalar(source.mass_unit.value_or(1))},
       {"lengthUnit", MatScalar(source.length_unit.value_or(1))},
       {"angleUnit", MatText("deg")},
       {"documentation", Texts(source.documentation)},
       {"fileType", MatText(source.file_type.empty() ? "ASF" : source.file_type)},
       {"skin", MatArray()}});
}

MatArray MotOf(const Motion& motion, const std::string& file_name, double unit_cm) {
  const Skeleton& skeleton = *motion.skeleton;
  const JointTrajectories trajectories = ForwardKinematics(motion);
  std::vector<MatArray> euler, quaternions;
  for (int joint = 0; joint < skeleton.joint_count(); ++joint) {
    euler.push_back(EulerOf(motion, joint));
    quaternions.push_back(QuaternionsOf(motion, joint));
  }
  Fields fields =
      MotOf(motion.rate_hz, motion.frame_count,
            TrajectoriesOf(trajectories.positions_cm, skeleton.joints().size(), unit_cm),
            RootTranslation(motion, unit_cm), MatCells(std::move(euler)),
            MatCells(std::move(quaternions)));
  fields.emplace_back("jointNames", Texts(JointNames(skeleton)));
  fields.emplace_back("boneNames", Texts(BoneNames(skeleton)));
  fields.emplace_back("nameMap", NameMapOf(skeleton));
  fields.emplace_back("animated", Indices(skeleton.animated()));
  fields.emplace_back("unanimated", Indices(skeleton.unanimated()));
  AddFileFields(ComputeBoundingBox(trajectories), file_name, unit_cm, fields);
  return MatStruct(std::move(fields));
}

MatArray SkelOf(const MarkerCloud& markers, const std::string& file_name) {
  std::vector<MatArray> paths;
  paths.reserve(markers.labels.size());
  for (int i = 0; i < markers.marker_count(); ++i) paths.push_back(Indices({i}));
  return MatStruct({{"njoints", MatScalar(markers.marker_count())},
                    {"rootRotationalOffsetEuler", MatColumn({0, 0, 0})},
                    {"rootRotationalOffsetQuat", MatColumn({1, 0, 0, 0})},
                    {"nodes", MatArray()},
                    {"paths", MatCells(std::move(paths))},
                    {"jointNames", MatArray()},
                    {"boneNames", MatArray()},
                    {"nameMap", NameMapOf(markers)},
                    {"animated", MatArray()},
                    {"unanimated", MatArray()},
                    {"filename", MatText(file_name)},
                    {"version", MatText("")},
                    {"name", MatText("")},
                    {"massUnit", MatScalar(1)},
                    {"lengthUnit", MatScalar(1)},
                    {"angleUnit", MatText("deg")},
                    {"documentation", MatText("")},
                    {"fileType", MatText("C3D")},
                    {"skin", MatArray()}});
}

MatArray MotOf(const MarkerCloud& markers, const std::string& file_name, double unit_cm) {
  Fields fields = MotOf(markers.rate_hz, markers.frame_count,
                        TrajectoriesOf(markers.positions_cm, markers.labels.size(), unit_cm),
                        MatArray(), MatArray(), MatArray());
  fields.emplace_back("jointNames", MatArray());
  fields.emplace_back("boneNames", MatArray());
  fields.emplace_back("nameMap", NameMapOf(markers));
  fields.emplace_back("animated", MatArray());
  fields.emplace_back("unanimated", MatArray());
  AddFileFields(ComputeBoundingBox(markers), file_name, unit_cm, fields);
  return MatStruct(std::move(fields));
}

}  // namespace kinebase::internal
