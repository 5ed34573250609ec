// A body has two pairs of like limbs on a trunk, and a head between the upper pair.
//
// A joint where several long branches part is a fork; a branch without a further fork is a limb.
// The two most alike limbs of a fork are a pair. The pair nearer to the root are the legs.

#include "motion/rig_topology.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/rig_mapping.h"

namespace kinebase::internal {
namespace {

using enum StandardJoint;

// Shares of the longest way from the root to a tip. A head and neck are about a fifth of the way
// from pelvis to fingertips, fingers an eighth; what is left below the chest two thirds, below the
// hand an eighth.
constexpr double kShortestBranch = 0.15;
constexpr double kShortestBelowFork = 0.4;
constexpr std::size_t kMostBranches = 16;  // No body; all pairs of them are looked at.
constexpr double kLikeness = 0.7;          // Of the lengths of a pair: the shorter over the longer.
constexpr double kSamePlace = 1e-3;        // Share of the longest way: bones of length 0.

struct Limb {
  int fork = 0;
  std::vector<int> path;  // From the first joint after the fork to the tip.
  double length = 0;
};

struct Pair {
  Limb left;
  Limb right;
  double likeness = 0;
};

// The tree with what lies below each joint, in the neutral pose.
class Tree {
 public:
  explicit Tree(std::span<const Joint> joints) : joints_(joints) {
    const std::size_t count = joints.size();
    children_.resize(count);
    reach_.resize(count);
    depth_.resize(count);
    position_.resize(count, Eigen::Vector3d::Zero());
    for (std::size_t i = 1; i < count; ++i) {
      const auto parent = static_cast<std::size_t>(joints[i].parent);
      children_[parent].push_back(static_cast<int>(i));
      depth_[i] = depth_[parent] + joints[i].offset_cm.norm();
      position_[i] = position_[parent] + joints[i].offset_cm;
    }
    for (std::size_t i = count; i-- > 1;) {
      auto& reach = reach_[static_cast<std::size_t>(joints[i].parent)];
      reach = std::max(reach, Length(static_cast<int>(i)));
    }
  }

  const std::vector<int>& children(int joint) const { return children_[Index(joint)]; }
  const Eigen::Vector3d& position(int joint) const { return position_[Index(joint)]; }
  double depth(int joint) const { return depth_[Index(joint)]; }  // Along the bones.
  double size() const { return reach_[0]; }
  std::string_view name(int joint) const { return joints_[Index(joint)].bone_name; }
  int parent(int joint) const { return joints_[Index(joint)].parent; }

  // Along the bones from the joint before to the farthest tip.
  double Length(int joint) const {
    return joints_[Index(joint)].offset_cm.norm() + reach_[Index(joint)];
  }

  std::vector<int> Branches(int joint) const {
    std::vector<int> branches;
    if (reach_[Index(joint)] < kShortestBelowFork * size()) return branches;
    for (const int child : children(joint)) {
      if (Length(child) >= kShortestBranch * size()) branches.push_back(child);
    }
    if (branches.size() > kMostBranches) branches.clear();
    return branches;
  }

  int LongestChild(int joint) const {
    const auto& all = children(joint);
    return *std::ranges::max_element(all, {}, [&](int child) { return Length(child); });
  }

 private:
  static std::size_t Index(int joint) { return static_cast<std::size_t>(joint); }

  std::span<const Joint> joints_;
  std::vector<std::vector<int>> children_;
  std::vector<double> reach_;
  std::vector<double> depth_;
  std::vector<Eigen::Vector3d> position_;
};

std::vector<Limb> FindLimbs(const Tree& tree) {
  std::vector<Limb> limbs;
  std::vector<std::pair<int, int>> open;  // Fork or root, and a joint below it to go on from.
  const auto open_branches = [&](int fork) {
    for (const int branch : tree.Branches(fork)) open.emplace_back(fork, branch);
  };
  int first_fork = 0;
  while (tree.Branches(first_fork).size() < 2 && !tree.children(first_fork).empty()) {
    first_fork = tree.LongestChild(first_fork);
  }
  open_branches(first_fork);
  while (!open.empty()) {
    const auto [fork, branch] = open.back();
    open.pop_back();
    Limb limb{.fork = fork, .path = {branch}, .length = tree.Length(branch)};
    while (!tree.children(limb.path.back()).empty()) {
      if (tree.Branches(limb.path.back()).size() >= 2) break;
      limb.path.push_back(tree.LongestChild(limb.path.back()));
    }
    if (tree.children(limb.path.back()).empty()) {
      limbs.push_back(std::move(limb));
    } else {
      open_branches(limb.path.back());
    }
  }
  return limbs;
}

// The most alike limbs of each fork.
std::vector<Pair> FindPairs(const std::vector<Limb>& limbs) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < limbs.size(); ++i) {
    for (std::size_t j = i + 1; j < limbs.size(); ++j) {
      const Limb& a = limbs[i];
      const Limb& b = limbs[j];
      if (a.fork != b.fork) continue;
      double likeness = std::min(a.length, b.length) / std::max(a.length, b.length);
      if (likeness < kLikeness) continue;
      if (a.path.size() == b.path.size()) likeness += 1;
      const auto rival =
          std::ranges::find(pairs, a.fork, [](const Pair& p) { return p.left.fork; });
      if (rival == pairs.end()) {
        pairs.push_back({a, b, likeness});
      } else if (likeness > rival->likeness) {
        *rival = {a, b, likeness};
      }
    }
  }
  return pairs;
}

// -1 left, 1 right, 0 unknown.
int SideInName(std::string_view name) {
  const std::string_view bare = BareJointName(name);
  const std::string lower = ToLower(bare);
  if (lower.find("left") != std::string::npos) return -1;
  if (lower.find("right") != std::string::npos) return 1;
  const auto side = [](char c) { return c == 'l' || c == 'L' ? -1 : c == 'r' || c == 'R' ? 1 : 0; };
  const auto parts = [](char c) { return c == '_' || c == ' ' || c == '.' || c == '-'; };
  const std::size_t size = bare.size();
  if (size >= 2 && parts(bare[size - 2])) return side(bare[size - 1]);
  if (size >= 2 && side(bare[0]) != 0 && (parts(bare[1]) || std::isupper(bare[1]) != 0)) {
    return side(bare[0]);
  }
  // "Bip01 L Thigh"
  for (std::size_t i = 1; i + 1 < size; ++i) {
    if (parts(bare[i - 1]) && parts(bare[i + 1]) && side(bare[i]) != 0) return side(bare[i]);
  }
  return 0;
}

int SideOf(const Tree& tree, const Limb& limb) {
  int sum = 0;
  for (const int joint : limb.path) sum += SideInName(tree.name(joint));
  return sum;
}

Eigen::Vector3d Middle(const Tree& tree, const Limb& limb) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int joint : limb.path) sum += tree.position(joint);
  return sum / static_cast<double>(limb.path.size());
}

// A limb without bones of length 0: where several joints lie in one place, the last.
std::vector<int> Places(const Tree& tree, const Limb& limb) {
  std::vector<int> places;
  for (std::size_t i = 0; i < limb.path.size(); ++i) {
    const bool last = i + 1 == limb.path.size();
    if (!last &&
        tree.depth(limb.path[i + 1]) - tree.depth(limb.path[i]) < kSamePlace * tree.size()) {
      continue;
    }
    places.push_back(limb.path[i]);
  }
  return places;
}

// Of four or more places of a limb: where the two longest bones in a row begin, meet and end.
struct LimbJoints {
  int before = -1;  // What comes before, if it is not the first.
  int begin = -1;
  int middle = -1;
  int end = -1;
  int tip = -1;
};

LimbJoints SplitLimb(const Tree& tree, const Limb& limb) {
  const std::vector<int> places = Places(tree, limb);
  LimbJoints joints;
  if (places.size() < 3) return joints;
  const auto reach = [&](std::size_t i) {
    return tree.depth(places[i + 2]) - tree.depth(places[i]);
  };
  // A bone that begins in the very fork, the neck or the pelvis, is a collar bone or a hip bone.
  const double from_fork = tree.depth(places[0]) - tree.depth(limb.fork);
  const std::size_t first = places.size() > 3 && from_fork < kSamePlace * tree.size() ? 1 : 0;
  std::size_t longest = first;
  for (std::size_t i = first + 1; i + 2 < places.size(); ++i) {
    if (reach(i) > reach(longest)) longest = i;
  }
  if (longest > 0) joints.before = places[longest - 1];
  joints.begin = places[longest];
  joints.middle = places[longest + 1];
  joints.end = places[longest + 2];
  if (places.back() != joints.end) joints.tip = places.back();
  return joints;
}

class TopologyMapper {
 public:
  explicit TopologyMapper(std::span<const Joint> joints) : tree_(joints) { map_.fill(-1); }

  std::array<int, kStandardJointCount> Map() {
    const std::vector<Limb> limbs = FindLimbs(tree_);
    std::vector<Pair> pairs = FindPairs(limbs);
    std::ranges::sort(pairs, {}, [&](const Pair& p) { return tree_.depth(p.left.fork); });
    if (pairs.empty()) return map_;
    Pair& legs = pairs.front();
    FindDirections(legs, pairs.size() > 1 ? pairs.back().left.fork : -1);
    OrderSides(legs);
    Set(kRoot, legs.left.fork);
    SetLeg(legs.left, kLhip);
    SetLeg(legs.right, kRhip);
    if (pairs.size() < 2) return map_;
    Pair& arms = pairs.back();
    OrderSides(arms);
    SetArm(arms.left, kLclavicle);
    SetArm(arms.right, kRclavicle);
    SetTrunk(legs.left.fork, arms.left.fork, FindHead(limbs, legs, arms));
    return map_;
  }

 private:
  void Set(StandardJoint standard, int joint) { map_[static_cast<std::size_t>(standard)] = joint; }
  static StandardJoint After(StandardJoint joint, int steps) {
    return static_cast<StandardJoint>(static_cast<int>(joint) + steps);
  }

  // Up along the trunk, forward where the toes point, in the neutral pose.
  void FindDirections(const Pair& legs, int chest) {
    const Eigen::Vector3d pelvis = tree_.position(legs.left.fork);
    const Eigen::Vector3d feet =
        (tree_.position(legs.left.path.back()) + tree_.position(legs.right.path.back())) / 2;
    up_ = ((chest >= 0 ? tree_.position(chest) : pelvis) - feet).normalized();
    Eigen::Vector3d forward = Eigen::Vector3d::Zero();
    for (const Limb* leg : {&legs.left, &legs.right}) {
      const LimbJoints joints = SplitLimb(tree_, *leg);
      if (joints.tip < 0) continue;
      forward += tree_.position(joints.tip) - tree_.position(joints.end);
    }
    forward -= up_ * up_.dot(forward);
    constexpr double kNoticeable = 0.02;
    if (forward.norm() < kNoticeable * tree_.size()) {
      // Without feet: the usual direction of figures that stand along Y or Z.
      forward = std::abs(up_.z()) > std::abs(up_.y()) ? Eigen::Vector3d(0, -1, 0)
                                                      : Eigen::Vector3d(0, 0, 1);
    }
    left_ = up_.cross(forward);
  }

  void OrderSides(Pair& pair) const {
    const int by_name = SideOf(tree_, pair.right) - SideOf(tree_, pair.left);
    const double by_place =
        left_.dot(Middle(tree_, pair.left)) - left_.dot(Middle(tree_, pair.right));
    if (by_name < 0 || (by_name == 0 && by_place < 0)) std::swap(pair.left, pair.right);
  }

  void SetLeg(const Limb& limb, StandardJoint hip) {
    const LimbJoints joints = SplitLimb(tree_, limb);
    Set(hip, joints.begin);
    Set(After(hip, 1), joints.middle);
    Set(After(hip, 2), joints.end);
    Set(After(hip, 3), joints.tip);
  }

  void SetArm(const Limb& limb, StandardJoint clavicle) {
    const LimbJoints joints = SplitLimb(tree_, limb);
    Set(clavicle, joints.before >= 0 ? joints.before : limb.fork);
    Set(After(clavicle, 1), joints.begin);
    Set(After(clavicle, 2), joints.middle);
    Set(After(clavicle, 3), joints.end);
    Set(After(clavicle, 4), joints.tip);
  }

  // The longest limb that is neither an arm nor hangs where the legs do.
  static std::optional<Limb> FindHead(const std::vector<Limb>& limbs, const Pair& legs,
                                      const Pair& arms) {
    std::optional<Limb> head;
    for (const Limb& limb : limbs) {
      const bool is_arm = limb.path == arms.left.path || limb.path == arms.right.path;
      if (is_arm || limb.fork == legs.left.fork) continue;
      if (!head || limb.length > head->length) head = limb;
    }
    return head;
  }

  void SetTrunk(int pelvis, int chest, const std::optional<Limb>& head) {
    int neck = chest;
    if (head) {
      std::vector<int> places = Places(tree_, *head);
      Set(kHeadtop, places.back());
      if (places.size() >= 2) Set(kHead, places[places.size() - 2]);
      if (places.size() >= 3) neck = places.front();
    }
    Set(kNeck, neck);
    std::vector<int> spine;  // Between pelvis and neck.
    for (int joint = tree_.parent(neck); joint > pelvis; joint = tree_.parent(joint)) {
      spine.push_back(joint);
    }
    // Lower, upper and thoracic spine of the standard skeleton are about of one length.
    const double begin = tree_.depth(pelvis);
    const double length = tree_.depth(neck) - begin;
    const auto nearest = [&](double share) {
      return *std::ranges::min_element(spine, {}, [&](int joint) {
        return std::abs(tree_.depth(joint) - begin - share * length);
      });
    };
    if (spine.empty()) return;
    Set(kBelly, nearest(1.0 / 3));
    Set(kChest, nearest(2.0 / 3));
  }

  Tree tree_;
  std::array<int, kStandardJointCount> map_{};
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitY();
  Eigen::Vector3d left_ = Eigen::Vector3d::UnitX();
};

}  // namespace

std::array<int, kStandardJointCount> MapByTopology(std::span<const Joint> joints) {
  return TopologyMapper(joints).Map();
}

int FarthestTip(std::span<const Joint> joints, int joint) {
  // Children come behind their parents, so one pass from `joint` on sees the whole subtree.
  std::vector<double> depth(joints.size(), -1);
  depth[static_cast<std::size_t>(joint)] = 0;
  int farthest = joint;
  for (std::size_t i = static_cast<std::size_t>(joint) + 1; i < joints.size(); ++i) {
    const double before = depth[static_cast<std::size_t>(joints[i].parent)];
    if (before < 0) continue;
    depth[i] = before + joints[i].offset_cm.norm();
    if (depth[i] > depth[static_cast<std::size_t>(farthest)]) farthest = static_cast<int>(i);
  }
  return farthest == joint ? -1 : farthest;
}

}  // namespace kinebase::internal
