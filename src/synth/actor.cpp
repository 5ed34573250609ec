// Made-up people: who they are and which bones they have.
//
// Proportions: Drillis, Contini, "Body Segment Parameters", New York University TR 1166-03 (1966),
// as fractions of the stature. Bones, DOFs and axes are those of HDM05's skeletons, so that the
// mapping to the standard joints holds.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "kinebase/core/error.h"
#include "kinebase/formats/asf.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/synth/synthetic_motion.h"
#include "synth/random.h"

namespace kinebase {
namespace {

using internal::HashText;
using internal::Random;

using Vector = std::array<double, 3>;

constexpr double kAsfLengthUnit = 0.45;  // v stands for v / 0.45 inches, as in HDM05.
constexpr double kCentimetresPerUnit = 2.54 / kAsfLengthUnit;

// Lengths as fractions of the stature.
struct Proportions {
  double ankle_height = 0.039;
  double shank = 0.246;
  double thigh = 0.245;
  double hip_half_width = 0.052;  // Joint centres.
  double pelvis_height = 0.050;   // Root above the hips.
  double spine_joint = 0.075;     // Each of three.
  double neck_joint = 0.0475;     // Each of two.
  double head = 0.100;
  double shoulder_half_width = 0.118;
  double shoulder_rise = 0.013;
  double upper_arm = 0.186;
  double forearm = 0.146;
  double hand = 0.055;
  double fingers = 0.045;
  double instep = 0.070;  // Ankle to ball of the foot, along the floor.
  double toes = 0.042;
};

// Legs, arms and shoulders of one person are long or short as a whole; the trunk takes up what the
// legs leave of the stature.
Proportions MakeProportions(const SyntheticActor& actor) {
  Random random({HashText(actor.name), HashText("proportions"),
                 static_cast<std::uint64_t>(std::llround(actor.stature_cm * 1000))});
  Proportions p;
  const double legs = random.Around(1, 0.015);
  p.shank *= legs * random.Around(1, 0.01);
  p.thigh *= legs * random.Around(1, 0.01);
  const double arms = random.Around(1, 0.015);
  p.upper_arm *= arms;
  p.forearm *= arms * random.Around(1, 0.01);
  const double breadth = random.Around(1, 0.03);
  p.shoulder_half_width *= breadth;
  p.hip_half_width *= breadth;
  p.instep *= random.Around(1, 0.02);
  const double trunk = 1 - p.ankle_height - p.shank - p.thigh - p.pelvis_height;
  const double usual = 3 * p.spine_joint + 2 * p.neck_joint + p.head;
  p.spine_joint *= trunk / usual;
  p.neck_joint *= trunk / usual;
  p.head *= trunk / usual;
  return p;
}

// Short enough for a file, fine enough (1e-6 cm) for everyone.
double Rounded(double value) { return std::round(value * 1e7) / 1e7; }

struct BoneRow {
  std::string_view name;
  std::string_view parent;
  Vector reach{};  // From the parent's end, in statures, in the neutral pose.
  Vector axis{};
  std::string_view dofs;  // "xyz": rx ry rz.
  std::array<std::array<double, 2>, 3> limits{};
};

// The neutral pose has the legs 20° apart, as HDM05's.
constexpr double kLegSpreadDeg = 20;

// The bones of the left leg (side 1) or the right (-1); names lack their first letter.
std::array<BoneRow, 5> LegRows(const Proportions& p, double side) {
  const double spread = side * kLegSpreadDeg;
  const double sine = std::sin(spread * std::numbers::pi / 180);
  const double cosine = std::cos(spread * std::numbers::pi / 180);
  return {{
      {"hipjoint", "root", {side * p.hip_half_width, -p.pelvis_height, 0}, {}, "", {}},
      {"femur",
       "hipjoint",
       {sine * p.thigh, -cosine * p.thigh, 0},
       {0, 0, spread},
       "xyz",
       {{{-160, 60}, {-80, 80}, {-80, 80}}}},
      {"tibia",
       "femur",
       {sine * p.shank, -cosine * p.shank, 0},
       {0, 0, spread},
       "x",
       {{{-10, 170}}}},
      {"foot",
       "tibia",
       {sine * p.ankle_height, -cosine * p.ankle_height, p.instep},
       {-90, 0, spread},
       "xz",
       {{{-45, 90}, {-70, 70}}}},
      {"toes", "foot", {0, 0, p.toes}, {-90, 0, spread}, "x", {{{-90, 45}}}},
  }};
}

std::array<BoneRow, 7> ArmRows(const Proportions& p, double side) {
  const Vector arm_axis = {180, -30 * side, -90 * side};
  const Vector hand_axis = {0, 90 * side, 90 * side};
  const double thumb = p.hand * std::numbers::sqrt2 / 2;
  return {{
      {"clavicle",
       "thorax",
       {side * p.shoulder_half_width, p.shoulder_rise, 0},
       {},
       "yz",
       {{{-40, 40}, {-50, 50}}}},
      {"humerus",
       "clavicle",
       {side * p.upper_arm, 0, 0},
       arm_axis,
       "xyz",
       {{{-180, 180}, {-90, 90}, {-180, 180}}}},
      // Two bones, so that the second can turn about the forearm's axis.
      {"radius", "humerus", {side * p.forearm * 2 / 3, 0, 0}, arm_axis, "x", {{{-10, 170}}}},
      {"wrist", "radius", {side * p.forearm / 3, 0, 0}, hand_axis, "y", {{{-180, 180}}}},
      {"hand", "wrist", {side * p.hand, 0, 0}, hand_axis, "xz", {{{-90, 90}, {-45, 45}}}},
      {"fingers", "hand", {side * p.fingers, 0, 0}, hand_axis, "x", {{{-10, 90}}}},
      {"thumb",
       "wrist",
       {side * thumb, 0, thumb},
       {-90, 45 * side, 0},
       "xz",
       {{{-45, 45}, {-45, 45}}}},
  }};
}

std::array<BoneRow, 3> SpineRows(const Proportions& p) {
  constexpr std::array<std::array<double, 2>, 3> kLimits = {{{-40, 45}, {-40, 40}, {-40, 40}}};
  return {{{"lowerback", "root", {0, p.spine_joint, 0}, {}, "xyz", kLimits},
           {"upperback", "lowerback", {0, p.spine_joint, 0}, {}, "xyz", kLimits},
           {"thorax", "upperback", {0, p.spine_joint, 0}, {}, "xyz", kLimits}}};
}

std::array<BoneRow, 3> NeckRows(const Proportions& p) {
  constexpr std::array<std::array<double, 2>, 3> kLimits = {{{-40, 45}, {-40, 40}, {-40, 40}}};
  return {{{"lowerneck", "thorax", {0, p.neck_joint, 0}, {}, "xyz", kLimits},
           {"upperneck", "lowerneck", {0, p.neck_joint, 0}, {}, "xyz", kLimits},
           {"head", "upperneck", {0, p.head, 0}, {}, "xyz", kLimits}}};
}

AsfDof RotationDof(char axis) {
  return axis == 'x' ? AsfDof::kRx : axis == 'y' ? AsfDof::kRy : AsfDof::kRz;
}

class AsfBuilder {
 public:
  AsfBuilder(const SyntheticActor& actor, AsfSkeleton& asf) : actor_(actor), asf_(asf) {}

  void Add(const BoneRow& row, std::string_view prefix = "") {
    const double length = std::hypot(row.reach[0], row.reach[1], row.reach[2]);
    AsfBone bone{.id = static_cast<std::int64_t>(asf_.bones.size()) + 1,
                 .name = std::string(prefix) + std::string(row.name)};
    for (std::size_t i = 0; i < 3; ++i) bone.direction[i] = Rounded(row.reach[i] / length);
    bone.length = Rounded(length * actor_.stature_cm / kCentimetresPerUnit);
    bone.axis = row.axis;
    for (std::size_t i = 0; i < row.dofs.size(); ++i) {
      bone.dofs.push_back(RotationDof(row.dofs[i]));
      bone.limits.push_back({row.limits[i][0], row.limits[i][1]});
    }
    const bool hangs_on_trunk = row.parent == "root" || row.parent == "thorax";
    AddChild(
        hangs_on_trunk ? std::string(row.parent) : std::string(prefix) + std::string(row.parent),
        bone.name);
    asf_.bones.push_back(std::move(bone));
  }

 private:
  void AddChild(const std::string& parent, const std::string& child) {
    const auto family = std::ranges::find(asf_.hierarchy, parent, &AsfSkeleton::Family::parent);
    if (family != asf_.hierarchy.end()) {
      family->children.push_back(child);
    } else {
      asf_.hierarchy.push_back({parent, {child}});
    }
  }

  const SyntheticActor& actor_;
  AsfSkeleton& asf_;
};

AsfSkeleton MakeAsf(const SyntheticActor& actor) {
  AsfSkeleton asf;
  asf.version = "1.10";
  asf.name = "SYN_" + actor.name;
  asf.mass_unit = 1;
  asf.length_unit = kAsfLengthUnit;
  asf.documentation = {
      "   A made-up skeleton by kinebase synth. It is synthetic: it belongs to nobody."};
  asf.root_order = {AsfDof::kTx, AsfDof::kTy, AsfDof::kTz, AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
  const Proportions proportions = MakeProportions(actor);
  AsfBuilder builder(actor, asf);
  for (const BoneRow& row : LegRows(proportions, 1)) builder.Add(row, "l");
  for (const BoneRow& row : LegRows(proportions, -1)) builder.Add(row, "r");
  for (const BoneRow& row : SpineRows(proportions)) builder.Add(row);
  for (const BoneRow& row : NeckRows(proportions)) builder.Add(row);
  for (const BoneRow& row : ArmRows(proportions, 1)) builder.Add(row, "l");
  for (const BoneRow& row : ArmRows(proportions, -1)) builder.Add(row, "r");
  return asf;
}

// 0 → "sa", 25 → "sz", 26 → "saa", …
std::string ActorName(int number) {
  std::string letters;
  for (int rest = number; rest >= 0; rest = rest / 26 - 1) {
    letters.insert(letters.begin(), static_cast<char>('a' + rest % 26));
  }
  return "s" + letters;
}

}  // namespace

SyntheticActor MakeSyntheticActor(int number, std::uint64_t seed) {
  if (number < 0) {
    throw Error(ErrorCode::kInvalidArgument,
                "actors are numbered from 0, not " + std::to_string(number));
  }
  Random random({seed, HashText("actor"), static_cast<std::uint64_t>(number)});
  SyntheticActor actor;
  actor.name = ActorName(number);
  actor.stature_cm = std::round(random.Uniform(155, 195) * 10) / 10;
  // Long legs swing slowly: tempo goes with 1 / √stature, as a pendulum's.
  actor.tempo = random.Around(1, 0.06) * std::sqrt(175 / actor.stature_cm);
  actor.amplitude = random.Uniform(0.92, 1.08);
  actor.noise_deg = random.Uniform(0.4, 1.4);
  actor.left_handed = random.Uniform(0, 1) < 0.2;
  return actor;
}

std::shared_ptr<const Skeleton> MakeSyntheticSkeleton(const SyntheticActor& actor) {
  if (!(actor.stature_cm > 0)) {
    throw Error(ErrorCode::kInvalidArgument,
                "actor '" + actor.name + "' has no stature; use MakeSyntheticActor");
  }
  Diagnostics diagnostics;
  return BuildSkeleton(MakeAsf(actor), {.length_reading = LengthReading::kDivideToInches},
                       diagnostics);
}

}  // namespace kinebase
