// A made-up standing person, 175 cm tall, whose joints can be named as any rig names them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/motion/skeleton.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase::test {

struct PersonJoint {
  std::string name;
  int parent = -1;
  Eigen::Vector3d place_cm;  // Y up, facing +z, so that left is +x.
};

struct Person {
  std::vector<PersonJoint> joints;                  // Parents first, depth first.
  std::array<int, kStandardJointCount> standard{};  // Which of them is which.
  [[nodiscard]] int at(StandardJoint joint) const { return standard[static_cast<int>(joint)]; }
};

inline Eigen::Vector3d PlaceOnPerson(StandardJoint joint) {
  static const std::map<StandardJoint, Eigen::Vector3d> places = {
      {StandardJoint::kRoot, {0, 95, 0}},       {StandardJoint::kLhip, {9, 90, 0}},
      {StandardJoint::kLknee, {9, 48, 2}},      {StandardJoint::kLankle, {9, 9, 0}},
      {StandardJoint::kLtoes, {9, 0, 18}},      {StandardJoint::kBelly, {0, 108, 0}},
      {StandardJoint::kChest, {0, 122, 0}},     {StandardJoint::kNeck, {0, 148, 0}},
      {StandardJoint::kHead, {0, 157, 2}},      {StandardJoint::kHeadtop, {0, 175, 2}},
      {StandardJoint::kLclavicle, {3, 145, 0}}, {StandardJoint::kLshoulder, {18, 145, 0}},
      {StandardJoint::kLelbow, {48, 145, 0}},   {StandardJoint::kLwrist, {74, 145, 0}},
      {StandardJoint::kLfingers, {92, 145, 0}},
  };
  const auto found = places.find(joint);
  if (found != places.end()) return found->second;
  const Eigen::Vector3d& other = places.at(Mirrored(joint));
  return {-other.x(), other.y(), other.z()};
}

// As rigs have it, the arms hang on the chest.
inline int ParentOnPerson(const Person& person, StandardJoint joint) {
  if (joint == StandardJoint::kRoot) return -1;
  if (joint == StandardJoint::kLclavicle || joint == StandardJoint::kRclavicle) {
    return person.at(StandardJoint::kChest);
  }
  return person.at(*StandardParent(joint));
}

// Joints named by `name_of(StandardJoint)`. A name "X>" is the tip below a joint X, which is made
// if no other has it.
template <typename NameOf>
Person MakePerson(const NameOf& name_of) {
  Person person;
  std::map<std::string, int> made;
  const auto add = [&](std::string name, int parent, const Eigen::Vector3d& place) {
    const auto index = static_cast<int>(person.joints.size());
    made.emplace(name, index);
    person.joints.push_back({std::move(name), parent, place});
    return index;
  };
  for (int j = 0; j < kStandardJointCount; ++j) {
    const auto joint = static_cast<StandardJoint>(j);
    const Eigen::Vector3d place = PlaceOnPerson(joint);
    int parent = ParentOnPerson(person, joint);
    std::string name = name_of(joint);
    if (name.ends_with('>')) {
      name.pop_back();
      const auto found = made.find(name);
      parent = found != made.end()
                   ? found->second
                   : add(name, parent, (place + person.joints[parent].place_cm) / 2);
      name += "_tip";
    }
    person.standard[j] = add(std::move(name), parent, place);
  }
  return person;
}

inline std::vector<Joint> JointsOf(const Person& person) {
  std::vector<Joint> joints;
  for (const PersonJoint& from : person.joints) {
    Joint joint{.name = from.name, .bone_name = from.name, .parent = from.parent};
    if (from.parent < 0) {
      joint.bone_name = "root";
    } else {
      joint.offset_cm = from.place_cm - person.joints[from.parent].place_cm;
      joint.length_cm = joint.offset_cm.norm();
    }
    joints.push_back(std::move(joint));
  }
  return joints;
}

// As BVH, two frames in the neutral pose. Lengths times `scale`; (x, y, z) as `axes` orders them.
inline std::string BvhOf(const Person& person, double scale = 1,
                         const std::array<int, 3>& axes = {0, 1, 2}) {
  std::string values;
  const auto vector = [&](const Eigen::Vector3d& cm) {
    const Eigen::Vector3d v = cm * scale;
    return fmt::format("{} {} {}", v[axes[0]], v[axes[1]], v[axes[2]]);
  };
  const auto write = [&](const auto& self, int index) -> std::string {
    const PersonJoint& joint = person.joints[index];
    const bool is_root = joint.parent < 0;
    std::string text = fmt::format("{} {}\n{{\n", is_root ? "ROOT" : "JOINT", joint.name);
    const Eigen::Vector3d start = is_root ? joint.place_cm : person.joints[joint.parent].place_cm;
    text += "OFFSET " + vector(joint.place_cm - start) + "\n";
    if (is_root) {
      text += "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
      values += vector(joint.place_cm) + " 0 0 0";
    } else {
      text += "CHANNELS 3 Zrotation Xrotation Yrotation\n";
      values += " 0 0 0";
    }
    bool has_child = false;
    for (int child = index + 1; child < static_cast<int>(person.joints.size()); ++child) {
      if (person.joints[child].parent != index) continue;
      has_child = true;
      text += self(self, child);
    }
    if (!has_child) text += "End Site\n{\nOFFSET 0 0 0\n}\n";
    return text + "}\n";
  };
  const std::string hierarchy = write(write, 0);
  return "HIERARCHY\n" + hierarchy + "MOTION\nFrames: 2\nFrame Time: 0.0083333\n" + values + "\n" +
         values + "\n";
}

}  // namespace kinebase::test
