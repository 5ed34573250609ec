// What the original HDM05 parser made of a clip: the `skel` and `mot` structures of a MATLAB v5
// file.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace kinebase::test {

struct MatOracle {
  std::vector<std::string> joint_names;
  std::vector<std::string> bone_names;
  std::vector<std::vector<int>> paths;  // 1-based, as in the file.
  std::vector<int> animated;
  std::vector<int> unanimated;
  std::vector<int> name_map_rotation;    // [24]; 0 = none.
  std::vector<int> name_map_trajectory;  // [24]
  std::vector<std::string> documentation;
  double sampling_rate = 0;
  Eigen::VectorXd bounding_box_inch;               // xmin xmax ymin ymax zmin zmax.
  Eigen::MatrixXd root_translation_inch;           // 3 × frames.
  std::vector<Eigen::MatrixXd> trajectories_inch;  // [joint] 3 × frames.
  std::vector<Eigen::MatrixXd> quaternions;        // [joint] 4 × frames (w, x, y, z), or empty.
  std::vector<Eigen::MatrixXd> euler_degrees;      // [joint] DOFs × frames, or empty.

  struct Node {
    std::vector<int> children;
    int parent = 0;
    Eigen::VectorXd offset_inch;
    Eigen::VectorXd direction;
    double length_inch = 0;
    Eigen::VectorXd axis_degrees;
    std::vector<std::string> dofs;
    std::string rotation_order;
    Eigen::MatrixXd limits_degrees;  // DOFs × 2, or empty.
  };
  std::vector<Node> nodes;
};

MatOracle ReadMatOracle(const std::filesystem::path& path);

}  // namespace kinebase::test
