#include "support/mat_oracle.h"

#include <matio.h>

#include <memory>
#include <stdexcept>

namespace kinebase::test {
namespace {

matvar_t* Field(matvar_t* structure, const char* name, std::size_t index = 0) {
  matvar_t* field = Mat_VarGetStructFieldByName(structure, name, index);
  if (field == nullptr) throw std::runtime_error(std::string("no field ") + name);
  return field;
}

double Element(const matvar_t* variable, std::size_t i) {
  switch (variable->class_type) {
    case MAT_C_DOUBLE:
      return static_cast<const double*>(variable->data)[i];
    case MAT_C_SINGLE:
      return static_cast<const float*>(variable->data)[i];
    case MAT_C_INT8:
      return static_cast<const std::int8_t*>(variable->data)[i];
    case MAT_C_UINT8:
      return static_cast<const std::uint8_t*>(variable->data)[i];
    case MAT_C_INT16:
      return static_cast<const std::int16_t*>(variable->data)[i];
    case MAT_C_UINT16:
      return static_cast<const std::uint16_t*>(variable->data)[i];
    case MAT_C_INT32:
      return static_cast<const std::int32_t*>(variable->data)[i];
    case MAT_C_UINT32:
      return static_cast<const std::uint32_t*>(variable->data)[i];
    default:
      throw std::runtime_error("unexpected MATLAB class");
  }
}

Eigen::MatrixXd Matrix(const matvar_t* variable) {
  // An empty cell comes without dimensions or data.
  if (variable == nullptr || variable->rank < 2 || variable->dims == nullptr) return {};
  const auto rows = static_cast<Eigen::Index>(variable->dims[0]);
  const auto columns = static_cast<Eigen::Index>(variable->dims[1]);
  Eigen::MatrixXd matrix(rows, columns);
  for (Eigen::Index i = 0; i < matrix.size(); ++i) {
    matrix.data()[i] = Element(variable, static_cast<std::size_t>(i));
  }
  return matrix;
}

Eigen::VectorXd Vector(const matvar_t* variable) {
  const Eigen::MatrixXd matrix = Matrix(variable);
  return Eigen::Map<const Eigen::VectorXd>(matrix.data(), matrix.size());
}

std::vector<int> Integers(const matvar_t* variable) {
  std::vector<int> integers;
  for (const double value : Vector(variable)) integers.push_back(static_cast<int>(value));
  return integers;
}

std::string Text(const matvar_t* variable) {
  std::string text;
  const std::size_t count = variable->dims[0] * variable->dims[1];
  const bool wide = variable->data_type == MAT_T_UINT16 || variable->data_type == MAT_T_UTF16;
  for (std::size_t i = 0; i < count; ++i) {
    text += static_cast<char>(wide ? static_cast<const std::uint16_t*>(variable->data)[i]
                                   : static_cast<const std::uint8_t*>(variable->data)[i]);
  }
  return text;
}

std::vector<matvar_t*> Cells(const matvar_t* variable) {
  auto** cells = static_cast<matvar_t**>(variable->data);
  return {cells, cells + variable->dims[0] * variable->dims[1]};
}

std::vector<std::string> Texts(const matvar_t* variable) {
  std::vector<std::string> texts;
  if (variable->class_type != MAT_C_CELL) return texts;
  for (const matvar_t* cell : Cells(variable)) texts.push_back(Text(cell));
  return texts;
}

std::vector<Eigen::MatrixXd> Matrices(const matvar_t* variable) {
  std::vector<Eigen::MatrixXd> matrices;
  for (const matvar_t* cell : Cells(variable)) matrices.push_back(Matrix(cell));
  return matrices;
}

MatOracle::Node ReadNode(matvar_t* nodes, std::size_t index) {
  MatOracle::Node node;
  node.children = Integers(Field(nodes, "children", index));
  node.parent = Integers(Field(nodes, "parentID", index)).at(0);
  node.offset_inch = Vector(Field(nodes, "offset", index));
  node.direction = Vector(Field(nodes, "direction", index));
  node.length_inch = Vector(Field(nodes, "length", index))[0];
  node.axis_degrees = Vector(Field(nodes, "axis", index));
  node.dofs = Texts(Field(nodes, "DOF", index));
  node.rotation_order = Text(Field(nodes, "rotationOrder", index));
  node.limits_degrees = Matrix(Field(nodes, "limits", index));
  return node;
}

}  // namespace

MatOracle ReadMatOracle(const std::filesystem::path& path) {
  const std::unique_ptr<mat_t, decltype(&Mat_Close)> file(Mat_Open(path.c_str(), MAT_ACC_RDONLY),
                                                          &Mat_Close);
  if (!file) throw std::runtime_error("cannot open " + path.string());
  using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;
  const Variable skel(Mat_VarRead(file.get(), "skel"), &Mat_VarFree);
  const Variable mot(Mat_VarRead(file.get(), "mot"), &Mat_VarFree);
  if (!skel || !mot) throw std::runtime_error("no skel or mot in " + path.string());

  MatOracle oracle;
  oracle.joint_names = Texts(Field(skel.get(), "jointNames"));
  oracle.bone_names = Texts(Field(skel.get(), "boneNames"));
  for (const matvar_t* path_cell : Cells(Field(skel.get(), "paths"))) {
    oracle.paths.push_back(Integers(path_cell));
  }
  oracle.animated = Integers(Field(skel.get(), "animated"));
  oracle.unanimated = Integers(Field(skel.get(), "unanimated"));
  const std::vector<matvar_t*> map = Cells(Field(skel.get(), "nameMap"));  // 24 × 3, by columns.
  const std::size_t rows = map.size() / 3;
  for (std::size_t row = 0; row < rows; ++row) {
    oracle.name_map_rotation.push_back(Integers(map[rows + row]).at(0));
    oracle.name_map_trajectory.push_back(Integers(map[2 * rows + row]).at(0));
  }
  oracle.documentation = Texts(Field(skel.get(), "documentation"));
  matvar_t* nodes = Field(skel.get(), "nodes");
  for (std::size_t i = 0; i < oracle.joint_names.size(); ++i) {
    oracle.nodes.push_back(ReadNode(nodes, i));
  }
  oracle.sampling_rate = Vector(Field(mot.get(), "samplingRate"))[0];
  oracle.bounding_box_inch = Vector(Field(mot.get(), "boundingBox"));
  oracle.root_translation_inch = Matrix(Field(mot.get(), "rootTranslation"));
  oracle.trajectories_inch = Matrices(Field(mot.get(), "jointTrajectories"));
  oracle.quaternions = Matrices(Field(mot.get(), "rotationQuat"));
  oracle.euler_degrees = Matrices(Field(mot.get(), "rotationEuler"));
  return oracle;
}

}  // namespace kinebase::test
