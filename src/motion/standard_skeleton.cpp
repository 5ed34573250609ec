#include "kinebase/motion/standard_skeleton.h"

#include <algorithm>
#include <string>

namespace kinebase {
namespace {

constexpr std::array<std::string_view, kStandardJointCount> kNames = {
    "root",   "lhip",   "lknee",    "lankle",    "ltoes",     "rhip",    "rknee",     "rankle",
    "rtoes",  "belly",  "chest",    "neck",      "head",      "headtop", "lclavicle", "lshoulder",
    "lelbow", "lwrist", "lfingers", "rclavicle", "rshoulder", "relbow",  "rwrist",    "rfingers"};

// Parents in the order of kNames.
constexpr std::array<std::string_view, kStandardJointCount> kParents = {
    "",          "root",   "lhip",   "lknee", "lankle",    "root",      "rhip",   "rknee",
    "rankle",    "root",   "belly",  "chest", "neck",      "head",      "neck",   "lclavicle",
    "lshoulder", "lelbow", "lwrist", "neck",  "rclavicle", "rshoulder", "relbow", "rwrist"};

}  // namespace

std::string_view ToString(StandardJoint joint) { return kNames[static_cast<std::size_t>(joint)]; }

std::optional<StandardJoint> ParseStandardJoint(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<StandardJoint>(found - kNames.begin());
}

StandardJoint Mirrored(StandardJoint joint) {
  std::string name(ToString(joint));
  if (name == "root") return joint;  // Its r is no side.
  name[0] = name[0] == 'l' ? 'r' : name[0] == 'r' ? 'l' : name[0];
  return ParseStandardJoint(name).value_or(joint);
}

std::optional<StandardJoint> StandardParent(StandardJoint joint) {
  return ParseStandardJoint(kParents[static_cast<std::size_t>(joint)]);
}

}  // namespace kinebase
