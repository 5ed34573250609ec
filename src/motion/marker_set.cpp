// Reads marker sets from TOML and checks them whole.

#include "kinebase/motion/marker_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "toml++/toml.h"

namespace kinebase {

namespace internal {
std::string_view EmbeddedData_standard_joints();
std::string_view EmbeddedData_asf_joints();
std::string_view EmbeddedData_full_body();
}  // namespace internal

namespace {

constexpr int kVersion = 1;
constexpr std::string_view kFormat = "kinebase-marker-set";

constexpr std::array<std::pair<std::string_view, MarkerSet::Direction>, 3> kDirections = {{
    {"left", MarkerSet::Direction::kLeft},
    {"up", MarkerSet::Direction::kUp},
    {"forward", MarkerSet::Direction::kForward},
}};

class MarkerSetReader {
 public:
  explicit MarkerSetReader(const std::filesystem::path& file) : file_(file) {}

  MarkerSet Read(std::string_view text) {
    toml::table root;
    try {
      root = toml::parse(text, file_.string());
    } catch (const toml::parse_error& error) {
      throw Error(ErrorCode::kMalformedFile, std::string(error.description()),
                  {file_, error.source().begin.line});
    }
    CheckHeader(root);
    CheckKeys(root, {"format", "version", "name", "size", "markers", "axes", "rigid", "joint"});
    set_.name = Text(root, "name");
    ReadSize(root);
    ReadLabels(root);
    ReadAxes(root);
    ReadRigid(root);
    ReadJoints(root);
    return std::move(set_);
  }

 private:
  [[noreturn]] void Fail(const toml::node& where, const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, where.source().begin.line});
  }

  void CheckHeader(const toml::table& root) const {
    if (root["format"].value_or(std::string()) != kFormat) {
      Fail(root, fmt::format("is no marker set: it needs the line format = \"{}\"", kFormat));
    }
    const auto version = root["version"].value<std::int64_t>();
    if (!version || *version < 1) Fail(root, "'version' must be a whole number from 1");
    if (*version > kVersion) {
      Fail(root, fmt::format("has version {}; this program reads up to version {}: use a newer one",
                             *version, kVersion));
    }
  }

  void CheckKeys(const toml::table& table, std::initializer_list<std::string_view> known) const {
    for (const auto& [key, value] : table) {
      if (std::ranges::find(known, key.str()) == known.end()) {
        Fail(value, fmt::format("unknown key '{}'; known: {}", key.str(), fmt::join(known, ", ")));
      }
    }
  }

  std::string Text(const toml::table& table, std::string_view key) const {
    const auto value = table[key].value<std::string>();
    if (!value || value->empty()) Fail(table, fmt::format("'{}' must be a text", key));
    return *value;
  }

  double Number(const toml::node& where, const toml::node* value, std::string_view key) const {
    const auto number = value == nullptr ? std::nullopt : value->value<double>();
    if (!number || !std::isfinite(*number)) Fail(where, fmt::format("'{}' must be a number", key));
    return *number;
  }

  MarkerSet::Names Names(const toml::node& where, const toml::node* value,
                         std::string_view key) const {
    MarkerSet::Names names;
    const toml::array* list = value == nullptr ? nullptr : value->as_array();
    if (list != nullptr) {
      for (const toml::node& name : *list) {
        const auto text = name.value<std::string>();
        if (!text) Fail(name, fmt::format("'{}' holds something that is no name", key));
        names.push_back(*text);
      }
    }
    if (names.empty()) Fail(where, fmt::format("'{}' must be a list of marker names", key));
    return names;
  }

  const toml::table& Table(const toml::node& node, std::string_view key) const {
    const toml::table* table = node.as_table();
    if (table == nullptr) Fail(node, fmt::format("'{}' must be a table", key));
    return *table;
  }

  void ReadSize(const toml::table& root) {
    const toml::node* node = root.get("size");
    if (node == nullptr) return;
    const toml::table& size = Table(*node, "size");
    CheckKeys(size, {"from", "to", "cm"});
    set_.size_from = Names(size, size.get("from"), "from");
    set_.size_to = Names(size, size.get("to"), "to");
    set_.size_cm = Number(size, size.get("cm"), "cm");
    if (set_.size_cm <= 0) Fail(size, "'cm' must be positive");
  }

  void ReadLabels(const toml::table& root) {
    const toml::node* node = root.get("markers");
    if (node == nullptr) return;
    for (const auto& [name, labels] : Table(*node, "markers")) {
      set_.labels[std::string(name.str())] = Names(labels, &labels, name.str());
    }
  }

  void ReadAxes(const toml::table& root) {
    const toml::node* node = root.get("axes");
    if (node == nullptr) return;
    for (const auto& [name, pair] : Table(*node, "axes")) {
      set_.axes[std::string(name.str())] = ReadAxisPair(Table(pair, name.str()));
    }
  }

  void ReadRigid(const toml::table& root) {
    const toml::node* node = root.get("rigid");
    if (node == nullptr) return;
    for (const auto& [bone, markers] : Table(*node, "rigid")) {
      set_.rigid[std::string(bone.str())] = Names(markers, &markers, bone.str());
    }
  }

  // TOML tables are sorted by key; which axis is exact is told by their place in the file.
  MarkerSet::Axes ReadAxisPair(const toml::table& table) const {
    CheckKeys(table, {"left", "up", "forward"});
    std::vector<std::pair<toml::source_position, MarkerSet::Axis>> axes;
    for (const auto& [word, direction] : kDirections) {
      const toml::node* node = table.get(word);
      if (node == nullptr) continue;
      const toml::array* ends = node->as_array();
      if (ends == nullptr || ends->size() != 2) {
        Fail(*node, fmt::format("'{}' needs two lists of markers: where it starts and ends", word));
      }
      axes.emplace_back(node->source().begin,
                        MarkerSet::Axis{direction, Names(*node, ends->get(0), word),
                                        Names(*node, ends->get(1), word)});
    }
    if (axes.size() != 2) Fail(table, "needs two of 'left', 'up' and 'forward'");
    if (axes[1].first < axes[0].first) std::swap(axes[0], axes[1]);
    return {std::move(axes[0].second), std::move(axes[1].second)};
  }

  void ReadJoints(const toml::table& root) {
    const toml::array* joints = root["joint"].as_array();
    if (joints == nullptr) Fail(root, "has no [[joint]]");
    std::array<bool, kStandardJointCount> seen{};
    for (const toml::node& node : *joints) {
      MarkerSet::JointRow row = ReadJoint(Table(node, "joint"));
      seen[static_cast<std::size_t>(row.joint)] = true;
      set_.joints.push_back(std::move(row));
    }
    for (int j = 0; j < kStandardJointCount; ++j) {
      if (seen[static_cast<std::size_t>(j)]) continue;
      Fail(root, fmt::format("has no [[joint]] for '{}'", ToString(static_cast<StandardJoint>(j))));
    }
  }

  MarkerSet::JointRow ReadJoint(const toml::table& table) const {
    CheckKeys(table, {"name", "markers", "axes", "move_cm", "confidence"});
    const std::string name = Text(table, "name");
    const auto joint = ParseStandardJoint(name);
    if (!joint) Fail(table, fmt::format("'{}' is no standard joint", name));
    MarkerSet::JointRow row{.joint = *joint,
                            .markers = Names(table, table.get("markers"), "markers")};
    if (table.contains("confidence")) {
      row.confidence = Number(table, table.get("confidence"), "confidence");
      if (row.confidence < 0 || row.confidence > 1) {
        Fail(table, "'confidence' must lie between 0 and 1");
      }
    }
    if (!table.contains("axes") && !table.contains("move_cm")) return row;
    row.axes = Text(table, "axes");
    if (!set_.axes.contains(row.axes)) Fail(table, fmt::format("no axes named '{}'", row.axes));
    const toml::array* move = table["move_cm"].as_array();
    if (move == nullptr || move->size() != 3) {
      Fail(table, "'move_cm' needs three numbers: left, up, forward");
    }
    for (int i = 0; i < 3; ++i) row.move_cm[i] = Number(table, move->get(i), "move_cm");
    return row;
  }

  const std::filesystem::path& file_;
  MarkerSet set_;
};

}  // namespace

MarkerSet::Names MarkerSet::LabelsOf(const std::string& marker) const {
  const auto entry = labels.find(marker);
  return entry == labels.end() ? Names{marker} : entry->second;
}

MarkerSet ParseMarkerSet(std::string_view text, const std::filesystem::path& file) {
  return MarkerSetReader(file).Read(text);
}

MarkerSet ReadMarkerSet(const std::filesystem::path& path) {
  const MappedFile file(path);
  return ParseMarkerSet(file.text(), path);
}

std::span<const MarkerSet> BuiltInMarkerSets() {
  static const std::array kSets = {
      ParseMarkerSet(internal::EmbeddedData_standard_joints(), "standard_joints.toml"),
      ParseMarkerSet(internal::EmbeddedData_asf_joints(), "asf_joints.toml"),
      ParseMarkerSet(internal::EmbeddedData_full_body(), "full_body.toml"),
  };
  return kSets;
}

}  // namespace kinebase
