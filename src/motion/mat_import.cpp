// The structures `skel` and `mot` as a recording.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/core/units.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/kinematics.h"
#include "motion/mat_structs.h"

namespace kinebase::internal {
namespace {

constexpr double kUnitLength = 1e-9;          // Beyond that directions and quaternions are mended.
constexpr double kNoticeableDistanceCm = .1;  // Of a stored trajectory from the rotations' joint.
constexpr int kDofKinds = 7;
constexpr std::size_t kRotationsPerStoredNumber = 8;

double AngleUnit(const MatStructReader& reader) {
  const bool radians =
      reader.Find("angleUnit") != nullptr && EqualsIgnoringCase(reader.Text("angleUnit"), "rad");
  return radians ? 1 : kRadiansPerDegree;
}

std::vector<Dof> TakeDofs(const MatStructReader& nodes, std::size_t index) {
  std::vector<Dof> dofs;
  for (const std::string& name : nodes.Texts("DOF", index)) {
    int dof = 0;
    while (dof < kDofKinds && !EqualsIgnoringCase(name, ToString(static_cast<AsfDof>(dof)))) ++dof;
    if (dof == kDofKinds) {
      nodes.Fail("DOF", index,
                 fmt::format("names {}; expected TX, TY, TZ, RX, RY, RZ or L", Quoted(name)));
    }
    dofs.push_back(static_cast<Dof>(dof));
  }
  return dofs;
}

std::vector<DofLimits> TakeLimits(const MatStructReader& nodes, std::size_t index,
                                  const std::vector<Dof>& dofs, double angle_unit, double unit_cm) {
  std::vector<DofLimits> limits;
  if (nodes.Find("limits", index) == nullptr) return limits;
  const std::vector<double> numbers = nodes.Numbers("limits", index);
  if (numbers.size() != dofs.size() * 2) return limits;  // As in an ASF: kept only if they fit.
  for (std::size_t d = 0; d < dofs.size(); ++d) {
    const double unit = IsRotation(dofs[d]) ? angle_unit : unit_cm;
    limits.push_back({numbers[d] * unit, numbers[dofs.size() + d] * unit});
  }
  return limits;
}

Joint TakeJoint(const MatStructReader& nodes, std::size_t index, double angle_unit,
                double unit_cm) {
  Joint joint;
  joint.bone_name = nodes.Text("boneName", index);
  joint.name = nodes.Text("jointName", index);
  const double parent = nodes.Number("parentID", index);
  if (!(parent >= 0 && parent <= static_cast<double>(index)) || parent != std::floor(parent)) {
    nodes.Fail("parentID", index,
               fmt::format("is {:g}; parents come first and count from 1, the "
                           "root has 0",
                           parent));
  }
  joint.parent = static_cast<int>(parent) - 1;
  if (index > 0) joint.offset_cm = nodes.Vector("offset", index) * unit_cm;
  joint.direction = nodes.Vector("direction", index);
  const double length = joint.direction.norm();
  if (length > 0 && std::abs(length - 1) > kUnitLength) joint.direction /= length;
  joint.length_cm = nodes.Number("length", index) * unit_cm;
  joint.axis_rad = nodes.Vector("axis", index) * angle_unit;
  const std::string order = nodes.Text("rotationOrder", index);
  const auto parsed = order.empty() ? EulerOrder::kXyz : ParseEulerOrder(order);
  if (!parsed) {
    nodes.Fail("rotationOrder", index,
               fmt::format("is {}; expected one such as XYZ", Quoted(order)));
  }
  joint.euler_order = *parsed;
  joint.dofs = TakeDofs(nodes, index);
  joint.limits = TakeLimits(nodes, index, joint.dofs, angle_unit, unit_cm);
  return joint;
}

// What may be missing comes back empty.
std::string TextOrNothing(const MatStructReader& reader, std::string_view field) {
  const MatArray* const found = reader.Find(field);
  return found != nullptr && found->type == MatClass::kChar ? found->Text() : "";
}

std::optional<double> NumberOrNothing(const MatStructReader& reader, std::string_view field) {
  const MatArray* const found = reader.Find(field);
  if (found == nullptr || found->numbers.size() != 1) return std::nullopt;
  return found->numbers.front();
}

SkeletonSource TakeSource(const MatStructReader& skel) {
  SkeletonSource source{.file_name = TextOrNothing(skel, "filename"),
                        .file_type = TextOrNothing(skel, "fileType"),
                        .name = TextOrNothing(skel, "name"),
                        .version = TextOrNothing(skel, "version"),
                        .mass_unit = NumberOrNothing(skel, "massUnit"),
                        .length_unit = NumberOrNothing(skel, "lengthUnit"),
                        .angle_is_degrees = AngleUnit(skel) != 1};
  if (skel.Find("documentation") != nullptr) source.documentation = skel.Texts("documentation");
  return source;
}

// A cell array with something for each joint.
const MatArray& NeedCells(const MatStructReader& mot, std::string_view field, std::size_t count) {
  const MatArray& cells = mot.Need(field);
  if (cells.type != MatClass::kCell || cells.elements.size() != count) {
    mot.Fail(field, 0, fmt::format("is no cell array of {} elements, one for each joint", count));
  }
  return cells;
}

// A cell or field as `rows` × `columns` numbers, by columns.
const std::vector<double>& NeedMatrix(const MatStructReader& mot, std::string_view field,
                                      const MatArray& array, std::size_t rows,
                                      std::size_t columns) {
  const bool fits = array.type <= MatClass::kUint32 && array.dims.size() == 2 &&
                    array.numbers.size() == rows * columns &&
                    static_cast<std::size_t>(array.dims[0]) == rows;
  if (!fits)
    mot.Fail(field, 0, fmt::format("holds no {} × {} numbers where it should", rows, columns));
  return array.numbers;
}

int FrameCount(const MatStructReader& mot) {
  const double frames = mot.Number("nframes");
  if (frames >= 0 && frames <= std::numeric_limits<int>::max() && frames == std::floor(frames)) {
    return static_cast<int>(frames);
  }
  mot.Fail("nframes", 0, fmt::format("is {:g}; expected a number of frames", frames));
}

std::vector<Eigen::Vector3d> TakeVectors(const std::vector<double>& numbers, double unit_cm) {
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    vectors.emplace_back(Eigen::Vector3d(numbers.data() + i) * unit_cm);
  }
  return vectors;
}

// The local rotation of a joint by its Euler angles, for files without quaternions.
Eigen::Quaterniond FromEuler(const Skeleton& skeleton, int index, const double* angles,
                             double angle_unit) {
  const Joint& joint = skeleton.joints()[static_cast<std::size_t>(index)];
  Eigen::Vector3d triple = Eigen::Vector3d::Zero();
  for (const Dof dof : joint.dofs) {
    if (IsRotation(dof)) triple[AxisOf(dof)] = *angles++ * angle_unit;
  }
  const Eigen::Quaterniond& axis = skeleton.axis(index);
  return axis * EulerToQuaternion(triple, joint.euler_order) * axis.conjugate();
}

class RotationReader {
 public:
  RotationReader(const MatStructReader& mot, const Skeleton& skeleton, int frames)
      : mot_(mot), skeleton_(skeleton), frames_(static_cast<std::size_t>(frames)) {
    const MatArray* const quaternions = mot.Find("rotationQuat");
    by_euler_ = quaternions == nullptr || quaternions->size() == 0;
    for (const std::string_view stored : {field(), std::string_view("jointTrajectories")}) {
      const MatArray* const cells = mot.Find(stored);
      if (cells == nullptr) continue;
      for (const MatArray& cell : cells->elements) stored_numbers_ += cell.numbers.size();
    }
  }

  std::vector<Eigen::Quaterniond> Read() const {
    const std::size_t joints = skeleton_.joints().size();
    const MatArray& cells = NeedCells(mot_, field(), joints);
    // Most joints of a recording turn or have a trajectory. Without that a small file could claim
    // frames and joints that fill a memory.
    if (frames_ * joints > kRotationsPerStoredNumber * stored_numbers_) {
      mot_.Fail(field(), 0,
                fmt::format("holds too few numbers for {} joints in {} frames", joints, frames_));
    }
    std::vector<Eigen::Quaterniond> rotations(frames_ * joints, Eigen::Quaterniond::Identity());
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const MatArray& cell = cells.elements[joint];
      if (cell.size() == 0) continue;  // It does not turn.
      const auto& numbers = NeedMatrix(mot_, field(), cell, RowsOf(joint), frames_);
      for (std::size_t frame = 0; frame < frames_; ++frame) {
        rotations[frame * joints + joint] = RotationAt(numbers, joint, frame);
      }
    }
    return rotations;
  }

 private:
  [[nodiscard]] std::string_view field() const {
    return by_euler_ ? "rotationEuler" : "rotationQuat";
  }

  [[nodiscard]] std::size_t RowsOf(std::size_t joint) const {
    if (!by_euler_) return 4;
    const auto& dofs = skeleton_.joints()[joint].dofs;
    return static_cast<std::size_t>(
        std::ranges::count_if(dofs, [](Dof dof) { return IsRotation(dof); }));
  }

  [[nodiscard]] Eigen::Quaterniond RotationAt(const std::vector<double>& numbers, std::size_t joint,
                                              std::size_t frame) const {
    const double* const column = numbers.data() + frame * RowsOf(joint);
    Eigen::Quaterniond q =
        by_euler_ ? FromEuler(skeleton_, static_cast<int>(joint), column, AngleUnit(mot_))
                  : Eigen::Quaterniond(column[0], column[1], column[2], column[3]);
    const double length = q.norm();
    if (!std::isfinite(length) || length < kUnitLength) {
      mot_.Fail(field(), 0,
                fmt::format("holds no rotation for joint {} in frame {} (counted "
                            "from 1)",
                            joint + 1, frame + 1));
    }
    if (std::abs(length - 1) > kUnitLength) q.coeffs() /= length;
    return q;
  }

  const MatStructReader& mot_;
  const Skeleton& skeleton_;
  std::size_t frames_;
  bool by_euler_ = false;
  std::size_t stored_numbers_ = 0;
};

bool Stretches(const Joint& joint) {
  return std::ranges::any_of(joint.dofs, [](Dof dof) { return !IsRotation(dof); });
}

// The stored trajectories, in our order; empty if there are none that fit.
std::vector<Eigen::Vector3d> StoredPlaces(const MatStructReader& mot, std::size_t joints,
                                          std::size_t frames, double unit_cm) {
  const MatArray* const cells = mot.Find("jointTrajectories");
  if (cells == nullptr || cells->elements.size() != joints) return {};
  std::vector<Eigen::Vector3d> places(frames * joints);
  for (std::size_t joint = 0; joint < joints; ++joint) {
    const MatArray& cell = cells->elements[joint];
    if (cell.type > MatClass::kUint32 || cell.numbers.size() != frames * 3) return {};
    for (std::size_t frame = 0; frame < frames; ++frame) {
      places[frame * joints + joint] = Eigen::Vector3d(cell.numbers.data() + frame * 3) * unit_cm;
    }
  }
  return places;
}

// Bones that translate or stretch have no field for it, but their trajectories tell.
void TakeExtraOffsets(const std::vector<Eigen::Vector3d>& places, Motion& motion) {
  const auto& joints = motion.skeleton->joints();
  if (places.empty() || std::none_of(joints.begin() + 1, joints.end(), Stretches)) return;
  motion.extra_offsets_cm.assign(places.size(), Eigen::Vector3d::Zero());
  std::vector<Eigen::Quaterniond> global(joints.size());
  for (std::size_t row = 0; row < places.size(); row += joints.size()) {
    global[0] = motion.skeleton->root_orientation() * motion.rotations[row];
    for (std::size_t j = 1; j < joints.size(); ++j) {
      const auto parent = static_cast<std::size_t>(joints[j].parent);
      global[j] = global[parent] * motion.rotations[row + j];
      if (!Stretches(joints[j])) continue;
      const Eigen::Vector3d bone = places[row + j] - places[row + parent];
      motion.extra_offsets_cm[row + j] = global[j].conjugate() * bone - joints[j].offset_cm;
    }
  }
}

void CompareWithStored(const std::vector<Eigen::Vector3d>& places, const Motion& motion,
                       Diagnostics& diagnostics) {
  if (places.empty()) return;
  const JointTrajectories joints = ForwardKinematics(motion);
  double largest = 0;
  std::size_t where = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double distance = (joints.positions_cm[i] - places[i]).norm();
    if (distance > largest || !std::isfinite(distance)) {
      largest = distance;
      where = i;
    }
    if (!std::isfinite(distance)) break;
  }
  if (largest <= kNoticeableDistanceCm) return;
  const auto count = static_cast<std::size_t>(motion.joint_count());
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("mot.jointTrajectories lies up to {:.1f} cm from where the rotations lead (bone "
                   "{} in frame {}); the rotations count",
                   largest, Quoted(motion.skeleton->joints()[where % count].bone_name),
                   where / count + 1)});
}

// Which joints stand for the standard ones; none if the structure does not tell.
std::optional<Skeleton::NameMap> TakeNameMap(const MatStructReader& skel) {
  const MatArray* const cells = skel.Find("nameMap");
  if (cells == nullptr || cells->type != MatClass::kCell || cells->dims.size() != 2 ||
      cells->dims[1] != 3 || cells->size() == 0) {
    return std::nullopt;
  }
  const std::size_t rows = cells->size() / 3;
  const auto joint_count = static_cast<double>(skel.Need("nodes").size());
  const auto index = [&](std::size_t cell) {
    const auto& numbers = cells->elements[cell].numbers;
    const double number = numbers.size() == 1 ? numbers.front() : 0;
    if (!(number >= 0 && number <= joint_count)) {
      skel.Fail("nameMap", 0,
                fmt::format("holds the index {:g}; there are {:g} nodes", number, joint_count));
    }
    return static_cast<int>(number) - 1;
  };
  Skeleton::NameMap map{};
  for (std::size_t row = 0; row < rows; ++row) {
    const auto joint = ParseStandardJoint(cells->elements[row].Text());
    if (!joint) continue;
    map[static_cast<std::size_t>(*joint)] = {index(rows + row), index(2 * rows + row)};
  }
  return map;
}

}  // namespace

bool HasRotations(const MatStructReader& skel, const MatStructReader& mot) {
  const auto is_filled = [](const MatArray* array) {
    return array != nullptr && array->size() > 0;
  };
  return is_filled(skel.Find("nodes")) &&
         (is_filled(mot.Find("rotationQuat")) || is_filled(mot.Find("rotationEuler")));
}

double RateOf(const MatStructReader& mot) {
  const auto rate = NumberOrNothing(mot, "samplingRate");
  const auto time = NumberOrNothing(mot, "frameTime");
  for (const double rate_hz : {rate.value_or(0), 1 / time.value_or(0)}) {
    if (rate_hz >= kSmallestRateHz && rate_hz <= kLargestRateHz) return rate_hz;
  }
  return 0;
}

std::shared_ptr<const Skeleton> TakeSkel(const MatStructReader& skel, double unit_cm) {
  const MatStructReader nodes = skel.Struct("nodes");
  const double angle_unit = AngleUnit(skel);
  std::vector<Joint> joints;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    joints.push_back(TakeJoint(nodes, i, angle_unit, unit_cm));
  }
  const bool has_orientation = skel.Find("rootRotationalOffsetEuler") != nullptr;
  const Eigen::Vector3d orientation =
      has_orientation ? Eigen::Vector3d(skel.Vector("rootRotationalOffsetEuler") * angle_unit)
                      : Eigen::Vector3d::Zero();
  try {
    return std::make_shared<Skeleton>(std::move(joints), TakeSource(skel),
                                      nodes.Vector("offset", 0) * unit_cm, orientation,
                                      TakeNameMap(skel));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::kInvalidArgument) throw;
    throw Error(ErrorCode::kMalformedFile, "skel.nodes make no skeleton: " + error.message(),
                {skel.file()});
  }
}

Motion TakeMot(const MatStructReader& mot, std::shared_ptr<const Skeleton> skeleton, double unit_cm,
               Diagnostics& diagnostics) {
  Motion motion{.skeleton = std::move(skeleton), .frame_count = FrameCount(mot)};
  const auto frames = static_cast<std::size_t>(motion.frame_count);
  motion.rotations = RotationReader(mot, *motion.skeleton, motion.frame_count).Read();
  motion.root_position_cm = TakeVectors(
      NeedMatrix(mot, "rootTranslation", mot.Need("rootTranslation"), 3, frames), unit_cm);
  for (auto& position : motion.root_position_cm) {
    if (!position.allFinite()) mot.Fail("rootTranslation", 0, "holds something that is no number");
    position += motion.skeleton->root_position_cm();
  }
  const auto places = StoredPlaces(mot, motion.skeleton->joints().size(), frames, unit_cm);
  TakeExtraOffsets(places, motion);
  CompareWithStored(places, motion, diagnostics);
  return motion;
}

MarkerCloud TakeTrajectories(const MatStructReader& mot, double unit_cm) {
  const MatArray& cells = mot.Need("jointTrajectories");
  const std::size_t count = cells.elements.size();
  if (count == 0) mot.Fail("jointTrajectories", 0, "is empty");
  MarkerCloud markers{.frame_count = FrameCount(mot)};
  const auto frames = static_cast<std::size_t>(markers.frame_count);
  const MatArray& map = NeedCells(mot, "nameMap", count * 3);
  std::vector<const double*> trajectories;
  for (std::size_t i = 0; i < count; ++i) {
    markers.labels.push_back(map.elements[i].Text());
    trajectories.push_back(
        NeedMatrix(mot, "jointTrajectories", cells.elements[i], 3, frames).data());
  }
  markers.positions_cm.reserve(frames * count);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (const double* const trajectory : trajectories) {
      const Eigen::Vector3d position = Eigen::Vector3d(trajectory + frame * 3) * unit_cm;
      const bool is_there = position.allFinite();
      markers.positions_cm.push_back(is_there ? position : MissingPosition());
      markers.states.push_back(is_there ? MarkerState::kMeasured : MarkerState::kMissing);
    }
  }
  return markers;
}

}  // namespace kinebase::internal
