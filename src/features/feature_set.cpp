// Reads feature sets from TOML and checks them whole.

#include "kinebase/features/feature_set.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/vocabulary.h"
#include "kinebase/motion/motion.h"
#include "toml++/toml.h"

namespace kinebase {

namespace internal {
std::string_view EmbeddedData_bonn();
std::string_view EmbeddedData_paper();
}  // namespace internal

namespace {

constexpr int kVersion = 1;
constexpr std::string_view kFormat = "kinebase-feature-set";

enum class Quantity { kLength, kSpeed, kAngle };

// What a term type is called in a file, how many joints it takes and what its value measures.
struct TermTypeRow {
  std::string_view name;
  TermType type;
  int joint_count;  // −1: any number.
  Quantity quantity;
  bool has_window;
};

constexpr std::array kTermTypes = {
    TermTypeRow{"plane", TermType::kPlane, 4, Quantity::kLength, false},
    TermTypeRow{"normal_plane", TermType::kNormalPlane, 4, Quantity::kLength, false},
    TermTypeRow{"angle", TermType::kAngle, 4, Quantity::kAngle, false},
    TermTypeRow{"angle_with_up", TermType::kAngleWithUp, 2, Quantity::kAngle, false},
    TermTypeRow{"normal_move", TermType::kNormalMove, 4, Quantity::kSpeed, true},
    TermTypeRow{"plane_move", TermType::kPlaneMove, 4, Quantity::kSpeed, true},
    TermTypeRow{"fast", TermType::kFast, 1, Quantity::kSpeed, true},
    TermTypeRow{"approach", TermType::kApproach, 4, Quantity::kSpeed, true},
    TermTypeRow{"height", TermType::kHeight, 1, Quantity::kLength, false},
    TermTypeRow{"height_extent", TermType::kHeightExtent, 0, Quantity::kLength, false},
    TermTypeRow{"ground_extent", TermType::kGroundExtent, -1, Quantity::kLength, false},
};

constexpr std::array<std::pair<std::string_view, ThresholdTest>, 5> kTests = {{
    {"above", ThresholdTest::kAbove},
    {"at_least", ThresholdTest::kAtLeast},
    {"below", ThresholdTest::kBelow},
    {"at_most", ThresholdTest::kAtMost},
    {"inside", ThresholdTest::kInside},
}};

constexpr std::array<std::pair<std::string_view, TermCombination>, 2> kCombinations = {{
    {"sum", TermCombination::kSum},
    {"smallest", TermCombination::kSmallest},
}};

// Whether every value that passes `strong` passes `weak` too, as hysteresis needs.
bool WeakContainsStrong(ThresholdTest test, const Threshold& strong, const Threshold& weak) {
  switch (test) {
    case ThresholdTest::kAbove:
    case ThresholdTest::kAtLeast:
      return weak.low <= strong.low;
    case ThresholdTest::kBelow:
    case ThresholdTest::kAtMost:
      return weak.low >= strong.low;
    case ThresholdTest::kInside:
      return weak.low <= strong.low && weak.high >= strong.high;
  }
  return false;
}

class FeatureSetReader {
 public:
  explicit FeatureSetReader(const std::filesystem::path& file) : file_(file) {}

  FeatureSet Read(std::string_view text) {
    toml::table root;
    try {
      root = toml::parse(text, file_.string());
    } catch (const toml::parse_error& error) {
      throw Error(ErrorCode::kMalformedFile, std::string(error.description()),
                  {file_, error.source().begin.line});
    }
    CheckHeader(root);
    CheckKeys(root, {"format", "version", "name", "description", "rate_hz", "lengths", "feature",
                     "phrases"});
    set_.name = Text(root, "name");
    set_.description = OptionalText(root, "description", "");
    set_.rate_hz = NumberOr(root, "rate_hz", 120);
    if (set_.rate_hz < kSmallestRateHz || set_.rate_hz > kLargestRateHz) {
      Fail(root,
           fmt::format("'rate_hz' must lie between {} and {}", kSmallestRateHz, kLargestRateHz));
    }
    ReadLengths(root);
    ReadFeatures(root);
    LinkMirrors();
    ReadWords(root);
    set_.hash = Hash();
    return std::move(set_);
  }

 private:
  [[noreturn]] void Fail(const toml::node& where, const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, where.source().begin.line});
  }

  void CheckHeader(const toml::table& root) const {
    if (root["format"].value_or(std::string()) != kFormat) {
      Fail(root, fmt::format("is no feature set: it needs the line format = \"{}\"", kFormat));
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

  std::string OptionalText(const toml::table& table, std::string_view key,
                           std::string_view otherwise) const {
    if (!table.contains(key)) return std::string(otherwise);
    const auto* text = table[key].as_string();
    if (text == nullptr) Fail(*table.get(key), fmt::format("'{}' must be a text", key));
    return text->get();
  }

  std::vector<std::string> Texts(const toml::table& table, std::string_view key) const {
    std::vector<std::string> texts;
    if (!table.contains(key)) return texts;
    const toml::array* array = table[key].as_array();
    if (array == nullptr) Fail(*table.get(key), fmt::format("'{}' must be a list of texts", key));
    for (const toml::node& node : *array) {
      const auto* text = node.as_string();
      if (text == nullptr) Fail(node, fmt::format("'{}' must be a list of texts", key));
      texts.push_back(text->get());
    }
    return texts;
  }

  bool Flag(const toml::table& table, std::string_view key) const {
    if (!table.contains(key)) return false;
    const auto* flag = table[key].as_boolean();
    if (flag == nullptr) Fail(*table.get(key), fmt::format("'{}' must be true or false", key));
    return flag->get();
  }

  double NumberOr(const toml::table& table, std::string_view key, double otherwise) const {
    if (!table.contains(key)) return otherwise;
    const auto value = table[key].value<double>();
    if (!value || !std::isfinite(*value) || table[key].is_boolean()) {
      Fail(*table.get(key), fmt::format("'{}' must be a number", key));
    }
    return *value;
  }

  StandardJoint Joint(const toml::node& node) const {
    const auto name = node.value<std::string>();
    const auto joint = name ? ParseStandardJoint(*name) : std::nullopt;
    if (joint) return *joint;
    std::string known;
    for (int i = 0; i < kStandardJointCount; ++i) {
      known.append(i == 0 ? "" : ", ").append(ToString(static_cast<StandardJoint>(i)));
    }
    Fail(node, fmt::format("{} is no joint of the standard skeleton; known: {}",
                           Quoted(name.value_or("")), known));
  }

  std::vector<StandardJoint> Joints(const toml::table& table, std::string_view key) const {
    std::vector<StandardJoint> joints;
    if (!table.contains(key)) return joints;
    const toml::array* array = table[key].as_array();
    if (array == nullptr) Fail(*table.get(key), fmt::format("'{}' must be a list of joints", key));
    for (const toml::node& node : *array) joints.push_back(Joint(node));
    return joints;
  }

  void ReadLengths(const toml::table& root) {
    if (!root.contains("lengths")) return;
    const toml::table* lengths = root["lengths"].as_table();
    if (lengths == nullptr) Fail(*root.get("lengths"), "[lengths] must be a table");
    for (const auto& [name, value] : *lengths) {
      const toml::array* segments = value.as_array();
      if (segments == nullptr || segments->empty()) {
        Fail(value, "a length is a list of pairs of joints: [[\"rshoulder\", \"relbow\"]]");
      }
      BodyLength length{.name = std::string(name.str())};
      if (length.name == "cm" || length.name == "deg" || length.name.ends_with("/s")) {
        Fail(value,
             fmt::format("'{}' is a unit already; a length needs another name", length.name));
      }
      for (const toml::node& segment : *segments) {
        const toml::array* pair = segment.as_array();
        if (pair == nullptr || pair->size() != 2) Fail(segment, "expected a pair of joints");
        length.segments.emplace_back(Joint(*pair->get(0)), Joint(*pair->get(1)));
      }
      set_.lengths.push_back(std::move(length));
    }
  }

  void ReadFeatures(const toml::table& root) {
    const toml::array* features = root["feature"].as_array();
    if (features == nullptr || features->empty()) Fail(root, "has no [[feature]]");
    if (features->size() > kMaxFeatures) {
      Fail(*features, fmt::format("{} features; at most {} fit a frame's word", features->size(),
                                  kMaxFeatures));
    }
    for (const toml::node& node : *features) {
      const toml::table* table = node.as_table();
      if (table == nullptr) Fail(node, "[[feature]] must be a table");
      ReadFeature(*table);
    }
  }

  void ReadFeature(const toml::table& table) {
    CheckKeys(table, {"id", "name", "synonyms", "opposites", "group", "mirror", "test", "strong",
                      "weak", "unit", "combine", "terms"});
    Feature feature{.id = Text(table, "id"),
                    .name = Text(table, "name"),
                    .group = OptionalText(table, "group", ""),
                    .synonyms = Texts(table, "synonyms"),
                    .opposites = Texts(table, "opposites")};
    if (set_.Find(feature.id)) Fail(table, fmt::format("a second feature '{}'", feature.id));
    feature.test = Choice(table, "test", kTests, "above");
    feature.combination = Choice(table, "combine", kCombinations, "sum");
    feature.strong = ReadThreshold(table, "strong", feature.test);
    feature.weak = ReadThreshold(table, "weak", feature.test);
    if (!WeakContainsStrong(feature.test, feature.strong, feature.weak)) {
      Fail(table,
           fmt::format("{}: every value that passes 'strong' must pass 'weak' too", feature.id));
    }
    const Quantity quantity = ReadTerms(table, feature);
    feature.length = ReadUnit(table, quantity);
    mirrors_.push_back(OptionalText(table, "mirror", feature.id));
    lines_.push_back(table.source().begin.line);
    set_.features.push_back(std::move(feature));
  }

  template <typename Value, std::size_t kCount>
  Value Choice(const toml::table& table, std::string_view key,
               const std::array<std::pair<std::string_view, Value>, kCount>& choices,
               std::string_view otherwise) const {
    const std::string text = OptionalText(table, key, otherwise);
    std::string known;
    for (const auto& [name, value] : choices) {
      if (name == text) return value;
      known.append(known.empty() ? "" : ", ").append(name);
    }
    Fail(*table.get(key), fmt::format("'{}' is {}; known: {}", key, Quoted(text), known));
  }

  Threshold ReadThreshold(const toml::table& table, std::string_view key,
                          ThresholdTest test) const {
    if (test == ThresholdTest::kInside) {
      const toml::array* range = table[key].as_array();
      const auto low =
          range != nullptr && range->size() == 2 ? range->get(0)->value<double>() : std::nullopt;
      const auto high = low ? range->get(1)->value<double>() : std::nullopt;
      if (!high || !(*low <= *high)) Fail(table, fmt::format("'{}' must be [low, high]", key));
      return {*low, *high};
    }
    if (!table.contains(key)) Fail(table, fmt::format("'{}' is missing", key));
    return {NumberOr(table, key, 0), 0};
  }

  // What the terms measure: all the same.
  Quantity ReadTerms(const toml::table& table, Feature& feature) const {
    const toml::array* terms = table["terms"].as_array();
    if (terms == nullptr || terms->empty()) {
      Fail(table, fmt::format("{}: 'terms' must be a list of at least one term", feature.id));
    }
    std::optional<Quantity> quantity;
    for (const toml::node& node : *terms) {
      const toml::table* term = node.as_table();
      if (term == nullptr) Fail(node, "a term is a table: { type = \"…\", joints = […] }");
      const TermTypeRow& row = ReadTerm(*term, feature);
      if (quantity && *quantity != row.quantity) {
        Fail(node, fmt::format("{}: its terms measure different things", feature.id));
      }
      quantity = row.quantity;
    }
    return *quantity;
  }

  const TermTypeRow& ReadTerm(const toml::table& table, Feature& feature) const {
    CheckKeys(table, {"type", "joints", "ignore", "window_ms", "absolute", "factor"});
    const std::string name = Text(table, "type");
    const auto row = std::ranges::find(kTermTypes, name, &TermTypeRow::name);
    if (row == kTermTypes.end()) {
      std::string known;
      for (const auto& type : kTermTypes) known.append(known.empty() ? "" : ", ").append(type.name);
      Fail(table, fmt::format("unknown term type {}; known: {}", Quoted(name), known));
    }
    FeatureTerm term{.type = row->type,
                     .joints = Joints(table, "joints"),
                     .ignored_joints = Joints(table, "ignore"),
                     .window_ms = NumberOr(table, "window_ms", 0),
                     .absolute = Flag(table, "absolute"),
                     .factor = NumberOr(table, "factor", 1)};
    if (row->joint_count >= 0 && static_cast<int>(term.joints.size()) != row->joint_count) {
      Fail(table, fmt::format("'{}' takes {} joints, found {}", name, row->joint_count,
                              term.joints.size()));
    }
    if (term.window_ms != 0 && !row->has_window) {
      Fail(table, fmt::format("'{}' has no velocity to smooth: no 'window_ms'", name));
    }
    constexpr double kLongestWindowMs = 60000;
    if (term.window_ms < 0 || term.window_ms > kLongestWindowMs) {
      Fail(table, fmt::format("'window_ms' must lie between 0 and {}", kLongestWindowMs));
    }
    if (!term.ignored_joints.empty() && term.type != TermType::kHeight) {
      Fail(table, "only 'height' has joints to ignore");
    }
    if (term.ignored_joints.size() >= kStandardJointCount) {
      Fail(table, "'ignore' leaves no joint to compare with");
    }
    feature.terms.push_back(std::move(term));
    return *row;
  }

  // "hl", "hl/s", "cm", "cm/s", "deg": the index of the length, −1 for absolute units.
  int ReadUnit(const toml::table& table, Quantity quantity) const {
    std::string unit = Text(table, "unit");
    const bool speed = unit.ends_with("/s");
    const bool angle = unit == "deg";
    if (speed != (quantity == Quantity::kSpeed) || angle != (quantity == Quantity::kAngle)) {
      Fail(table, fmt::format("unit '{}' does not fit what the terms measure: a length such as "
                              "'hl', a speed such as 'hl/s', or 'deg'",
                              unit));
    }
    if (speed) unit.resize(unit.size() - 2);
    if (angle || unit == "cm") return -1;
    const auto length = std::ranges::find(set_.lengths, unit, &BodyLength::name);
    if (length == set_.lengths.end()) {
      Fail(table, fmt::format("unit '{}' is not in [lengths]", unit));
    }
    return static_cast<int>(length - set_.lengths.begin());
  }

  // Partners must name each other, or rows would not come back after mirroring twice.
  void LinkMirrors() {
    for (std::size_t i = 0; i < mirrors_.size(); ++i) {
      const auto partner = set_.Find(mirrors_[i]);
      const Place place{file_, lines_[i]};
      if (!partner) {
        throw Error(
            ErrorCode::kMalformedFile,
            fmt::format("{}: mirror partner '{}' does not exist", set_.features[i].id, mirrors_[i]),
            place);
      }
      if (mirrors_[static_cast<std::size_t>(*partner)] != set_.features[i].id) {
        throw Error(ErrorCode::kMalformedFile,
                    fmt::format("{}: mirror partner '{}' does not name it in return",
                                set_.features[i].id, mirrors_[i]),
                    place);
      }
      set_.features[i].mirror = *partner;
    }
  }

  // Ids and names first: they are what the other words must not contradict.
  void ReadWords(const toml::table& root) {
    for (int i = 0; i < set_.feature_count(); ++i) {
      const Feature& feature = set_.features[static_cast<std::size_t>(i)];
      for (const std::string& text : {feature.id, feature.name}) {
        meanings_.try_emplace(NormalizedPhrase(text), std::vector{FeatureState{i, true}});
      }
    }
    for (int i = 0; i < set_.feature_count(); ++i) {
      const Feature& feature = set_.features[static_cast<std::size_t>(i)];
      const std::int64_t line = lines_[static_cast<std::size_t>(i)];
      for (const std::string& text : feature.synonyms) AddMeaning(text, {{i, true}}, line);
      for (const std::string& text : feature.opposites) AddMeaning(text, {{i, false}}, line);
    }
    ReadPhrases(root);
  }

  void ReadPhrases(const toml::table& root) {
    if (!root.contains("phrases")) return;
    const toml::table* phrases = root["phrases"].as_table();
    if (phrases == nullptr) Fail(*root.get("phrases"), "[phrases] must be a table");
    for (const auto& [text, value] : *phrases) {
      FeaturePhrase phrase{.text = std::string(text.str())};
      const toml::array* states = value.as_array();
      if (states == nullptr || states->empty()) {
        Fail(value, "a phrase is a list of features: [\"F3\", \"not F4\"]");
      }
      for (const toml::node& state : *states) phrase.states.push_back(ReadState(state));
      AddMeaning(phrase.text, phrase.states, value.source().begin.line);
      set_.phrases.push_back(std::move(phrase));
    }
  }

  // "F3" or "not F3".
  FeatureState ReadState(const toml::node& node) const {
    constexpr std::string_view kNot = "not ";
    const std::string text = node.value<std::string>().value_or("");
    const bool negated = text.starts_with(kNot);
    const std::string_view id = Trim(std::string_view(text).substr(negated ? kNot.size() : 0));
    const auto feature = set_.Find(id);
    if (!feature) {
      Fail(node,
           fmt::format("{} is neither the id of a feature nor 'not' and an id", Quoted(text)));
    }
    return {*feature, !negated};
  }

  void AddMeaning(const std::string& text, const std::vector<FeatureState>& states,
                  std::int64_t line) {
    const std::string words = NormalizedPhrase(text);
    if (words.empty()) {
      throw Error(ErrorCode::kMalformedFile, fmt::format("{} has no words", Quoted(text)),
                  {file_, line});
    }
    const auto [known, is_new] = meanings_.try_emplace(words, states);
    if (!is_new && known->second != states) {
      throw Error(
          ErrorCode::kMalformedFile,
          fmt::format("{} means two things: choose other words for one of them", Quoted(text)),
          {file_, line});
    }
  }

  // FNV-1a over everything that decides a bit, also after mirroring.
  std::uint64_t Hash() const {
    std::uint64_t hash = 0xCBF29CE484222325ULL;
    const auto add = [&](std::uint64_t value) {
      for (int byte = 0; byte < 8; ++byte) {
        hash = (hash ^ ((value >> (8 * byte)) & 0xFF)) * 0x100000001B3ULL;
      }
    };
    const auto add_number = [&](double value) {
      add(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value));  // −0 is 0.
    };
    const auto add_joints = [&](const std::vector<StandardJoint>& joints) {
      add(joints.size());
      for (const StandardJoint joint : joints) add(static_cast<std::uint64_t>(joint));
    };
    add_number(set_.rate_hz);
    for (const Feature& feature : set_.features) {
      add(feature.terms.size());
      for (const FeatureTerm& term : feature.terms) {
        add(static_cast<std::uint64_t>(term.type));
        add_joints(term.joints);
        add_joints(term.ignored_joints);
        add_number(term.window_ms);
        add(term.absolute ? 1 : 0);
        add_number(term.factor);
      }
      add(static_cast<std::uint64_t>(feature.combination));
      add(static_cast<std::uint64_t>(feature.test));
      for (const Threshold& threshold : {feature.strong, feature.weak}) {
        add_number(threshold.low);
        add_number(threshold.high);
      }
      add(static_cast<std::uint64_t>(feature.mirror));
      if (feature.length < 0) {
        add(0);
        continue;
      }
      const auto& segments = set_.lengths[static_cast<std::size_t>(feature.length)].segments;
      add(segments.size());
      for (const auto& [a, b] : segments) {
        add(static_cast<std::uint64_t>(a));
        add(static_cast<std::uint64_t>(b));
      }
    }
    return hash;
  }

  const std::filesystem::path& file_;
  FeatureSet set_;
  std::vector<std::string> mirrors_;                           // [feature] id of the partner.
  std::vector<std::int64_t> lines_;                            // [feature]
  std::map<std::string, std::vector<FeatureState>> meanings_;  // By normalised words.
};

}  // namespace

std::optional<int> FeatureSet::Find(std::string_view id) const {
  const auto found = std::ranges::find(features, id, &Feature::id);
  if (found == features.end()) return std::nullopt;
  return static_cast<int>(found - features.begin());
}

std::vector<FeatureGroup> FeatureSet::Groups() const {
  std::vector<FeatureGroup> groups;
  for (std::size_t row = 0; row < features.size(); ++row) {
    auto group = std::ranges::find(groups, features[row].group, &FeatureGroup::name);
    if (group == groups.end()) {
      group = groups.insert(group, {.name = features[row].group, .features = 0});
    }
    group->features |= std::uint64_t{1} << row;
  }
  return groups;
}

std::vector<int> FeatureSet::MirrorRows() const {
  std::vector<int> rows;
  rows.reserve(features.size());
  for (const Feature& feature : features) rows.push_back(feature.mirror);
  return rows;
}

FeatureSet ParseFeatureSet(std::string_view toml, const std::filesystem::path& file) {
  return FeatureSetReader(file).Read(toml);
}

std::vector<std::string> BuiltInFeatureSets() { return {"bonn", "paper"}; }

std::string_view BuiltInFeatureSetText(std::string_view name) {
  if (name == "bonn") return internal::EmbeddedData_bonn();
  if (name == "paper") return internal::EmbeddedData_paper();
  throw Error(ErrorCode::kNotFound,
              fmt::format("no built-in feature set {}; there are: {}", Quoted(name),
                          fmt::join(BuiltInFeatureSets(), ", ")));
}

FeatureSet LoadFeatureSet(std::string_view name_or_path) {
  const auto built_in = BuiltInFeatureSets();
  if (std::ranges::find(built_in, name_or_path) != built_in.end()) {
    return ParseFeatureSet(BuiltInFeatureSetText(name_or_path),
                           std::string(name_or_path) + ".toml");
  }
  const std::filesystem::path path(name_or_path);
  std::error_code unreachable;
  if (!std::filesystem::exists(path, unreachable)) {
    throw Error(ErrorCode::kNotFound,
                fmt::format("no feature set {}: neither a file nor one of the built-in {}",
                            Quoted(name_or_path), fmt::join(built_in, ", ")));
  }
  return ParseFeatureSet(MappedFile(path).text(), path);
}

}  // namespace kinebase
