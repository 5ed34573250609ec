#include "kinebase/motion/rig_mapping.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <unordered_map>
#include <utility>

#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "motion/rig_topology.h"

namespace kinebase {

namespace internal {
std::string_view EmbeddedData_rigs();
}

namespace {

using enum StandardJoint;

constexpr double kNamed = 1;
constexpr double kNamedNearby = 0.75;
constexpr double kByTopology = 0.7;
constexpr double kNearest = 0.5;
// The clavicles of the standard skeleton lie at the neck, so there the nearest is nearly the one.
constexpr double kClavicleAtNeck = 0.9;

constexpr double kFewestNames = 0.6;  // Share of a table's names that must be there.
constexpr std::size_t kShortestPrefix = 3;

std::size_t At(StandardJoint joint) { return static_cast<std::size_t>(joint); }

// "L_Up Leg" and "lupleg" are one name.
std::string Normalized(std::string_view name) {
  std::string result = ToLower(name);
  std::erase_if(result, [](char c) { return c >= 0 && std::isalnum(c) == 0; });
  return result;
}

// What all names but the root's begin with, up to a separator: "Bip01 ", "Character1_".
std::string_view CommonPrefix(std::span<const Joint> joints) {
  if (joints.size() < 3) return {};
  std::string_view prefix = BareJointName(joints[1].bone_name);
  for (const Joint& joint : joints.subspan(2)) {
    const std::string_view name = BareJointName(joint.bone_name);
    const auto differs = std::ranges::mismatch(prefix, name);
    prefix = prefix.substr(0, static_cast<std::size_t>(differs.in1 - prefix.begin()));
  }
  prefix = prefix.substr(0, prefix.find_last_of(" _-.") + 1);
  return prefix.size() < kShortestPrefix ? std::string_view{} : prefix;
}

using JointsByName = std::unordered_map<std::string, int>;

JointsByName IndexNames(std::span<const Joint> joints) {
  const std::string_view prefix = CommonPrefix(joints);
  JointsByName index;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    std::string_view name = BareJointName(joints[i].bone_name);
    if (i > 0) name.remove_prefix(prefix.size());
    index.try_emplace(Normalized(name), static_cast<int>(i));
  }
  // The root is also found by its own name; as a bone it may be called otherwise.
  if (!joints.empty()) {
    std::string_view name = BareJointName(joints[0].name);
    if (name.starts_with(prefix)) name.remove_prefix(prefix.size());
    index.try_emplace(Normalized(name), 0);
  }
  return index;
}

std::vector<std::string_view> Split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(separator), text.size());
    if (end > 0) parts.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

// A joint that was found for a standard joint.
struct Found {
  int joint = -1;
  JointMatch match = JointMatch::kMissing;
  double confidence = 0;
};
using Assignment = std::array<Found, kStandardJointCount>;

// A cell of the table: names of which the first that is there counts; "~" before one: about there;
// ">" behind it: the tip below that joint.
Found FindCell(std::string_view cell, std::span<const Joint> joints, const JointsByName& names) {
  for (std::string_view name : Split(cell, '|')) {
    const bool nearby = name.starts_with('~');
    const bool tip = name.ends_with('>');
    if (nearby) name.remove_prefix(1);
    if (tip) name.remove_suffix(1);
    const auto found = names.find(Normalized(name));
    if (found == names.end()) continue;
    if (!tip) return {found->second, JointMatch::kTable, nearby ? kNamedNearby : kNamed};
    const int end = internal::FarthestTip(joints, found->second);
    if (end < 0) return {found->second, JointMatch::kNearest, kNearest};
    return {end, JointMatch::kTable, nearby ? kNamedNearby : kNamed};
  }
  return {};
}

struct TableMatch {
  std::string rig;
  Assignment joints;
  double share = 0;  // Of the table's names that are there.
};

TableMatch TryTable(const CsvTable& table, std::size_t column, std::span<const Joint> joints,
                    const JointsByName& names) {
  TableMatch match{.rig = table.columns[column]};
  int wanted = 0;
  int there = 0;
  for (const auto& row : table.rows) {
    if (const auto standard = ParseStandardJoint(row[0])) {
      const Found found = FindCell(row[column], joints, names);
      match.joints[At(*standard)] = found;
      ++wanted;
      there += found.joint >= 0 ? 1 : 0;
      continue;
    }
    // "also": joints by which one rig is told from others with the same names.
    for (const std::string_view name : Split(row[column], ';')) {
      ++wanted;
      there += names.contains(Normalized(name)) ? 1 : 0;
    }
  }
  const bool has_legs =
      std::ranges::all_of(std::initializer_list<StandardJoint>{kLhip, kRhip, kLknee, kRknee},
                          [&](StandardJoint joint) { return match.joints[At(joint)].joint >= 0; });
  match.share = has_legs ? static_cast<double>(there) / wanted : 0;
  return match;
}

TableMatch BestTable(std::span<const Joint> joints) {
  static const CsvTable table = ParseCsv(internal::EmbeddedData_rigs(), "rigs.csv");
  const JointsByName names = IndexNames(joints);
  TableMatch best;
  for (std::size_t column = 1; column < table.columns.size(); ++column) {
    TableMatch match = TryTable(table, column, joints, names);
    if (match.share >= kFewestNames && match.share > best.share) best = std::move(match);
  }
  return best;
}

// Which joints can stand in for one that is not there, the better first.
std::vector<StandardJoint> Neighbours(StandardJoint joint) {
  switch (joint) {
    case kBelly:
      return {kChest, kRoot};
    case kChest:
      return {kBelly, kNeck};
    case kNeck:
      return {kLclavicle, kChest};
    case kHead:
      return {kHeadtop, kNeck};
    case kHeadtop:
      return {kHead};
    case kLclavicle:
    case kRclavicle:
      return {kNeck};
    case kLankle:
      return {kLtoes};
    case kRankle:
      return {kRtoes};
    case kLtoes:
      return {kLankle};
    case kRtoes:
      return {kRankle};
    case kLwrist:
      return {kLfingers};
    case kRwrist:
      return {kRfingers};
    case kLfingers:
      return {kLwrist};
    case kRfingers:
      return {kRwrist};
    default:
      return {};
  }
}

// From those that were found themselves only, or one joint would stand for half the body.
void TakeNearest(Assignment& assignment) {
  const Assignment found = assignment;
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    if (found[At(joint)].joint >= 0) continue;
    for (const StandardJoint neighbour : Neighbours(joint)) {
      const Found& near = found[At(neighbour)];
      if (near.joint < 0) continue;
      const bool is_clavicle = joint == kLclavicle || joint == kRclavicle;
      assignment[At(joint)] = {near.joint, JointMatch::kNearest,
                               near.confidence * (is_clavicle ? kClavicleAtNeck : kNearest)};
      break;
    }
  }
}

// The joint whose rotation a standard joint has: the bone that leads on from it, towards `next`
// where that lies below; -1 for tips.
int RotationJoint(std::span<const Joint> joints, int trajectory_joint, int next) {
  for (int i = next; i > trajectory_joint; i = joints[static_cast<std::size_t>(i)].parent) {
    if (joints[static_cast<std::size_t>(i)].parent == trajectory_joint) return i;
  }
  const auto child = std::ranges::find(joints, trajectory_joint, &Joint::parent);
  return child == joints.end() ? -1 : static_cast<int>(child - joints.begin());
}

int NextJoint(const Assignment& assignment, StandardJoint joint) {
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto child = static_cast<StandardJoint>(j);
    if (StandardParent(child) == joint &&
        assignment[At(child)].joint > assignment[At(joint)].joint) {
      return assignment[At(child)].joint;
    }
  }
  return -1;
}

// What the table leaves open, by topology, else the nearest.
RigMapping Complete(TableMatch table, std::span<const Joint> joints) {
  Assignment& assignment = table.joints;
  const auto by_topology = internal::MapByTopology(joints);
  for (std::size_t j = 0; j < assignment.size(); ++j) {
    if (assignment[j].joint >= 0 || by_topology[j] < 0) continue;
    assignment[j] = {by_topology[j], JointMatch::kTopology, kByTopology};
  }
  TakeNearest(assignment);
  if (assignment[At(kRoot)].joint < 0 && !joints.empty()) {
    assignment[At(kRoot)] = {0, JointMatch::kNearest, kNearest};
  }

  RigMapping mapping{.rig = table.share > 0 ? table.rig : ""};
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    const Found& found = assignment[At(joint)];
    JointSource source{.joint = joint, .match = found.match, .confidence = found.confidence};
    if (found.joint >= 0) {
      const Joint& place = joints[static_cast<std::size_t>(found.joint)];
      source.source = found.joint == 0 ? place.name : place.bone_name;
      // The root's rotation is that of the whole figure, as in the table of ASF.
      mapping.name_map[At(joint)] = {
          .rotation_joint = found.joint == 0
                                ? 0
                                : RotationJoint(joints, found.joint, NextJoint(assignment, joint)),
          .trajectory_joint = found.joint};
    }
    mapping.sources.push_back(std::move(source));
  }
  return mapping;
}

}  // namespace

std::string_view BareJointName(std::string_view name) {
  const std::size_t colon = name.find_last_of(':');
  return colon == std::string_view::npos || colon + 1 == name.size() ? name
                                                                     : name.substr(colon + 1);
}

RigMapping MapRig(std::span<const Joint> joints) { return Complete(BestTable(joints), joints); }

RigMapping MapRigByTopology(std::span<const Joint> joints) { return Complete({}, joints); }

}  // namespace kinebase
