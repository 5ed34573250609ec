// Writes GLB through tinygltf; the only file that includes its header, which is heavy.
//
// All binary data stand in one buffer: for every array of numbers a stretch of it ("buffer view")
// and a description ("accessor"). Everything is a float of 4 bytes, so nothing needs padding.

#include "kinebase/formats/glb.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <sstream>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr std::size_t kLargestFile = std::numeric_limits<std::uint32_t>::max();
constexpr double kBoneThickness = 0.1;  // Of its length; looks like a bone in every viewer.
constexpr double kWidestPlace = 0.2;    // Where along the bone it is widest.
constexpr double kShortestBone = 1e-5;  // m; what is shorter cannot be seen.
constexpr std::array<double, 4> kBoneColour = {0.75, 0.72, 0.65, 1};

GlbVector Add(const GlbVector& a, const GlbVector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
GlbVector Scaled(const GlbVector& a, double scale) {
  const auto by = static_cast<float>(scale);
  return {a[0] * by, a[1] * by, a[2] * by};
}
GlbVector Cross(const GlbVector& a, const GlbVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double Length(const GlbVector& a) { return std::hypot(a[0], a[1], a[2]); }
GlbVector Unit(const GlbVector& a) { return Scaled(a, 1 / Length(a)); }

// The corners of an octahedron from the origin to `bone`, three for each of its eight faces.
std::vector<GlbVector> Octahedron(const GlbVector& bone) {
  // Some direction across: the axis that the bone is least along.
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (std::abs(bone[i]) < std::abs(bone[least])) least = i;
  }
  GlbVector axis{};
  axis[least] = 1;
  const double radius = kBoneThickness * Length(bone) / 2;
  const GlbVector u = Scaled(Unit(Cross(bone, axis)), radius);
  const GlbVector v = Scaled(Unit(Cross(bone, u)), radius);
  const GlbVector middle = Scaled(bone, kWidestPlace);
  const std::array<GlbVector, 4> ring = {Add(middle, u), Add(middle, v), Add(middle, Scaled(u, -1)),
                                         Add(middle, Scaled(v, -1))};
  std::vector<GlbVector> corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const GlbVector& a = ring[i];
    const GlbVector& b = ring[(i + 1) % 4];
    corners.insert(corners.end(), {GlbVector{}, b, a});
    corners.insert(corners.end(), {bone, a, b});
  }
  return corners;
}

// Across each face, outwards: corners go round counter-clockwise as seen from outside.
std::vector<GlbVector> Normals(const std::vector<GlbVector>& corners) {
  std::vector<GlbVector> normals;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    const GlbVector& from = corners[i];
    const GlbVector a = Add(corners[i + 1], Scaled(from, -1));
    const GlbVector b = Add(corners[i + 2], Scaled(from, -1));
    normals.insert(normals.end(), 3, Unit(Cross(Unit(a), Unit(b))));
  }
  return normals;
}

class SceneWriter {
 public:
  explicit SceneWriter(const GlbScene& scene) : scene_(scene) {
    model_.asset.version = "2.0";
    model_.asset.generator = "Kinebase";
    model_.buffers.resize(1);
    model_.defaultScene = 0;
  }

  std::string Write() {
    AddMaterial();
    for (const GlbNode& node : scene_.nodes) AddNode(node);
    model_.scenes.resize(1);
    model_.scenes[0].name = scene_.name;
    model_.scenes[0].nodes = {0};
    if (!scene_.times_s.empty()) AddAnimation();
    std::ostringstream out;
    tinygltf::TinyGLTF gltf;
    if (!gltf.WriteGltfSceneToStream(&model_, out, /*prettyPrint=*/false, /*writeBinary=*/true)) {
      throw Error(ErrorCode::kIoFailure, "the scene could not be written as GLB");
    }
    return std::move(out).str();
  }

 private:
  void AddMaterial() {
    tinygltf::Material material;
    material.name = "bone";
    material.pbrMetallicRoughness.baseColorFactor = {kBoneColour.begin(), kBoneColour.end()};
    material.pbrMetallicRoughness.metallicFactor = 0;
    material.pbrMetallicRoughness.roughnessFactor = 0.9;
    model_.materials.push_back(std::move(material));
  }

  // Appends numbers to the buffer; returns the accessor that describes them.
  template <typename Item>
  int AddNumbers(std::span<const Item> items, int type, int target = 0) {
    auto& data = model_.buffers[0].data;
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = items.size_bytes();
    view.target = target;
    data.resize(data.size() + items.size_bytes());
    std::memcpy(data.data() + view.byteOffset, items.data(), items.size_bytes());
    tinygltf::Accessor accessor;
    accessor.bufferView = static_cast<int>(model_.bufferViews.size());
    accessor.componentType = TINYGLTF_COMPONENT_TYPE_FLOAT;
    accessor.count = items.size();
    accessor.type = type;
    model_.bufferViews.push_back(std::move(view));
    model_.accessors.push_back(std::move(accessor));
    return static_cast<int>(model_.accessors.size()) - 1;
  }

  void AddNode(const GlbNode& node) {
    const auto index = static_cast<int>(model_.nodes.size());
    tinygltf::Node result;
    result.name = node.name;
    result.translation = {node.translation.begin(), node.translation.end()};
    result.rotation = {node.rotation.begin(), node.rotation.end()};
    if (Length(node.bone) >= kShortestBone) result.mesh = AddBone(node);
    model_.nodes.push_back(std::move(result));
    if (node.parent >= 0)
      model_.nodes[static_cast<std::size_t>(node.parent)].children.push_back(index);
  }

  int AddBone(const GlbNode& node) {
    const std::vector<GlbVector> corners = Octahedron(node.bone);
    const std::vector<GlbVector> normals = Normals(corners);
    tinygltf::Primitive primitive;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.material = 0;
    const int positions =
        AddNumbers(std::span(corners), TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    AddRange(positions, corners);
    primitive.attributes["POSITION"] = positions;
    primitive.attributes["NORMAL"] =
        AddNumbers(std::span(normals), TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
    tinygltf::Mesh mesh;
    mesh.name = node.name;
    mesh.primitives.push_back(std::move(primitive));
    model_.meshes.push_back(std::move(mesh));
    return static_cast<int>(model_.meshes.size()) - 1;
  }

  // The smallest and the largest of each coordinate, which positions must have.
  void AddRange(int accessor, const std::vector<GlbVector>& corners) {
    auto& range = model_.accessors[static_cast<std::size_t>(accessor)];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::ranges::minmax(
          corners, {}, [axis](const GlbVector& corner) { return corner[axis]; });
      range.minValues.push_back(low[axis]);
      range.maxValues.push_back(high[axis]);
    }
  }

  void AddAnimation() {
    tinygltf::Animation animation;
    animation.name = scene_.name;
    const int times = AddNumbers(std::span(scene_.times_s), TINYGLTF_TYPE_SCALAR);
    auto& range = model_.accessors[static_cast<std::size_t>(times)];
    range.minValues = {scene_.times_s.front()};
    range.maxValues = {scene_.times_s.back()};
    const auto add = [&](int node, const char* path, int values) {
      tinygltf::AnimationSampler sampler;
      sampler.input = times;
      sampler.output = values;
      sampler.interpolation = "LINEAR";
      tinygltf::AnimationChannel channel;
      channel.sampler = static_cast<int>(animation.samplers.size());
      channel.target_node = node;
      channel.target_path = path;
      animation.samplers.push_back(std::move(sampler));
      animation.channels.push_back(std::move(channel));
    };
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const GlbNode& node = scene_.nodes[i];
      const auto index = static_cast<int>(i);
      if (!node.translations.empty()) {
        add(index, "translation", AddNumbers(std::span(node.translations), TINYGLTF_TYPE_VEC3));
      }
      if (!node.rotations.empty()) {
        add(index, "rotation", AddNumbers(std::span(node.rotations), TINYGLTF_TYPE_VEC4));
      }
    }
    animation.extras = tinygltf::Value(tinygltf::Value::Object{
        {"rate_hz", tinygltf::Value(scene_.rate_hz)},
        {"first_frame", tinygltf::Value(static_cast<double>(scene_.first_frame))}});
    if (!animation.channels.empty()) model_.animations.push_back(std::move(animation));
  }

  const GlbScene& scene_;
  tinygltf::Model model_;
};

void Check(const GlbScene& scene) {
  const auto fail = [](const std::string& message, ErrorCode code = ErrorCode::kInvalidArgument) {
    throw Error(code, message);
  };
  if (scene.nodes.empty()) fail("a scene needs a node");
  std::size_t values = scene.times_s.size();
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const GlbNode& node = scene.nodes[i];
    const bool is_root = node.parent == -1;
    if (is_root != (i == 0) || node.parent < -1 || node.parent >= static_cast<int>(i)) {
      fail(fmt::format("node {} must come after its parent, and only the first has none",
                       Quoted(node.name)));
    }
    for (const std::size_t count : {node.translations.size(), node.rotations.size()}) {
      if (count != 0 && count != scene.times_s.size()) {
        fail(fmt::format("node {} has {} values for {} times", Quoted(node.name), count,
                         scene.times_s.size()));
      }
    }
    values += node.translations.size() * 3 + node.rotations.size() * 4;
  }
  if (std::ranges::adjacent_find(scene.times_s, std::ranges::greater_equal{}) !=
      scene.times_s.end()) {
    fail("the times must grow from one to the next");
  }
  // Descriptions and meshes need far less than a hundredth of that.
  if (values > kLargestFile / sizeof(float) / 100 * 99) {
    fail("the recording needs more than the 4 GiB of a GLB file; cut it or lower its rate first",
         ErrorCode::kMismatch);
  }
}

}  // namespace

std::string FormatGlb(const GlbScene& scene) {
  Check(scene);
  return SceneWriter(scene).Write();
}

}  // namespace kinebase
