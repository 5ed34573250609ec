// Reading template files; docs/template-file.md describes every field.
#include "kinebase/templates/template_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/templates/keyframes.h"
#include "nlohmann/json.hpp"
#include "templates/matrix_check.h"
#include "templates/template_checks.h"

namespace kinebase {
namespace {

using nlohmann::json;

// A value for a message, not longer than a line can bear.
std::string ShownValue(const json& value) {
  // What is inside may be of any size and depth.
  if (value.is_structured()) return value.is_array() ? "a list" : "an object";
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

// One object of the file, with its place for messages: "clips[2].file".
class ObjectReader {
 public:
  ObjectReader(const json& object, std::string path, const std::filesystem::path& file)
      : object_(object), path_(std::move(path)), file_(file) {
    if (!object_.is_object()) Fail(path_.empty() ? "the file" : path_, object_, "an object");
  }

  [[noreturn]] static void FailWith(const std::string& message, const std::filesystem::path& file) {
    throw Error(ErrorCode::kMalformedFile, message, {.file = file});
  }

  // A misspelt field would otherwise be lost without a word.
  void AllowOnly(std::initializer_list<std::string_view> names) const {
    for (const auto& [key, value] : object_.items()) {
      if (std::ranges::find(names, key) == names.end()) {
        FailWith(fmt::format("unknown field {}; expected one of {}", Quoted(NameOf(key)),
                             fmt::join(names, ", ")),
                 file_);
      }
    }
  }

  [[nodiscard]] bool Has(std::string_view key) const { return object_.contains(key); }

  [[nodiscard]] std::string String(std::string_view key) const {
    const json& value = At(key);
    if (!value.is_string()) Fail(NameOf(key), value, "a string");
    return value.get<std::string>();
  }

  [[nodiscard]] double Number(std::string_view key) const {
    const json& value = At(key);
    if (!value.is_number()) Fail(NameOf(key), value, "a number");
    return value.get<double>();
  }

  [[nodiscard]] std::int64_t Integer(std::string_view key, std::int64_t least,
                                     std::int64_t most) const {
    const json& value = At(key);
    const std::string expected = most == std::numeric_limits<std::int64_t>::max()
                                     ? fmt::format("a whole number of at least {}", least)
                                     : fmt::format("a whole number from {} to {}", least, most);
    if (!value.is_number_integer()) Fail(NameOf(key), value, expected);
    const bool too_large =
        value.is_number_unsigned() && value.get<std::uint64_t>() > static_cast<std::uint64_t>(most);
    const std::int64_t number = too_large ? most : value.get<std::int64_t>();
    if (too_large || number < least || number > most) Fail(NameOf(key), value, expected);
    return number;
  }

  [[nodiscard]] const json& Array(std::string_view key) const {
    const json& value = At(key);
    if (!value.is_array()) Fail(NameOf(key), value, "a list");
    return value;
  }

  [[nodiscard]] ObjectReader Object(std::string_view key) const {
    return {At(key), NameOf(key), file_};
  }

  [[nodiscard]] bool IsNull(std::string_view key) const { return At(key).is_null(); }

  [[noreturn]] void FailAt(std::string_view key, std::string_view expected) const {
    Fail(NameOf(key), At(key), expected);
  }

  [[nodiscard]] std::string NameOf(std::string_view key) const {
    return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
  }

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  [[nodiscard]] const json& At(std::string_view key) const {
    const auto field = object_.find(key);
    if (field == object_.end()) FailWith(fmt::format("field '{}' is missing", NameOf(key)), file_);
    return *field;
  }

  [[noreturn]] void Fail(std::string_view name, const json& value,
                         std::string_view expected) const {
    FailWith(fmt::format("{} is {}; expected {}", name, ShownValue(value), expected), file_);
  }

  const json& object_;
  std::string path_;
  const std::filesystem::path& file_;
};

json ParseJson(std::string_view text, const std::filesystem::path& file) {
  try {
    return json::parse(text);
  } catch (const json::parse_error& error) {
    // The library counts bytes from 1 and names the one after the trouble.
    const std::int64_t byte = static_cast<std::int64_t>(error.byte) - 1;
    throw Error(ErrorCode::kMalformedFile, "not JSON: the file is damaged or of another kind",
                {.file = file, .line = 0, .byte = std::max<std::int64_t>(byte, 0)});
  } catch (const json::out_of_range&) {
    throw Error(ErrorCode::kMalformedFile, "a number is too large for a double", {.file = file});
  }
}

// The version.
std::int64_t ReadHeader(const ObjectReader& root) {
  if (root.String("format") != internal::kTemplateFormat) {
    root.FailAt("format",
                fmt::format("\"{}\"; this is no template file", internal::kTemplateFormat));
  }
  const std::int64_t version = root.Integer("version", 1, std::numeric_limits<std::int64_t>::max());
  if (version > internal::kTemplateVersion) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("template file of version {}, this program reads up to version {}; "
                            "open it with a newer Kinebase",
                            version, internal::kTemplateVersion),
                {.file = root.file()});
  }
  return version;
}

Profile ReadProfile(const ObjectReader& root, std::string_view key) {
  const std::optional<Profile> profile = ParseProfile(root.String(key));
  if (!profile) root.FailAt(key, "\"bonn\" or \"paper\"");
  return *profile;
}

std::uint64_t ReadHash(const ObjectReader& feature_set) {
  const std::string text = feature_set.String("hash");
  std::uint64_t hash = 0;
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, hash, 16);
  if (text.size() != 16 || result.ec != std::errc() || result.ptr != end) {
    feature_set.FailAt("hash", "16 hexadecimal digits");
  }
  return hash;
}

std::vector<TemplateClip> ReadClips(const ObjectReader& root) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  std::vector<TemplateClip> clips;
  for (const json& element : root.Array("clips")) {
    const ObjectReader object(element, fmt::format("clips[{}]", clips.size()), root.file());
    object.AllowOnly({"file", "first_frame", "last_frame"});
    TemplateClip& clip = clips.emplace_back();
    clip.file = object.String("file");
    clip.first_frame = object.Integer("first_frame", 0, kMost);
    clip.last_frame = object.Integer("last_frame", 0, kMost);
    const bool whole = clip.first_frame == 0 && clip.last_frame == 0;
    if (!whole && (clip.first_frame == 0 || clip.last_frame < clip.first_frame)) {
      object.FailAt("last_frame", fmt::format("a frame not before first_frame ({}); both 0 mean "
                                              "the whole file",
                                              clip.first_frame));
    }
  }
  return clips;
}

std::vector<TemplateMark> ReadMarks(const ObjectReader& root) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  std::vector<TemplateMark> marks;
  for (const json& element : root.Array("marks")) {
    const ObjectReader object(element, fmt::format("marks[{}]", marks.size()), root.file());
    object.AllowOnly({"file", "first_frame", "last_frame", "verdict"});
    TemplateMark& mark = marks.emplace_back();
    mark.file = object.String("file");
    mark.first_frame = object.Integer("first_frame", 1, kMost);
    mark.last_frame = object.Integer("last_frame", mark.first_frame, kMost);
    const std::optional<Verdict> verdict = ParseVerdict(object.String("verdict"));
    if (!verdict) object.FailAt("verdict", "\"right\" or \"wrong\"");
    mark.verdict = *verdict;
  }
  return marks;
}

std::vector<double> ReadValues(const json& list, std::string_view name, const ObjectReader& root) {
  std::vector<double> values;
  values.reserve(list.size());
  for (const json& element : list) {
    if (!element.is_number()) {
      ObjectReader::FailWith(
          fmt::format("{}[{}] is {}; expected a number", name, values.size(), ShownValue(element)),
          root.file());
    }
    values.push_back(element.get<double>());
  }
  return values;
}

TemplateMatrix ReadMatrix(const ObjectReader& root) {
  const ObjectReader object = root.Object("matrix");
  object.AllowOnly({"rate_hz", "feature_count", "weights", "columns"});
  TemplateMatrix matrix;
  matrix.rate_hz = object.Number("rate_hz");
  matrix.feature_count = static_cast<int>(object.Integer("feature_count", 1, kMaxFeatures));
  matrix.weights = ReadValues(object.Array("weights"), "matrix.weights", root);
  const json& columns = object.Array("columns");
  if (columns.size() != matrix.weights.size()) {
    ObjectReader::FailWith(
        fmt::format("matrix.columns has {} columns, matrix.weights has {}; expected as many",
                    columns.size(), matrix.weights.size()),
        root.file());
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string name = fmt::format("matrix.columns[{}]", c);
    if (!columns[c].is_array() ||
        columns[c].size() != static_cast<std::size_t>(matrix.feature_count)) {
      ObjectReader::FailWith(fmt::format("{} is {}; expected a list of {} numbers", name,
                                         ShownValue(columns[c]), matrix.feature_count),
                             root.file());
    }
    const std::vector<double> values = ReadValues(columns[c], name, root);
    matrix.values.insert(matrix.values.end(), values.begin(), values.end());
  }
  if (const std::string problem = internal::ProblemOf(matrix); !problem.empty()) {
    ObjectReader::FailWith("matrix has " + problem, root.file());
  }
  return matrix;
}

// Features as people count them, from 1; as bits.
std::uint64_t ReadFeatures(const ObjectReader& object, std::string_view key) {
  std::uint64_t bits = 0;
  for (const json& element : object.Array(key)) {
    const bool is_row = element.is_number_unsigned() && element.get<std::uint64_t>() >= 1 &&
                        element.get<std::uint64_t>() <= kMaxFeatures;
    if (!is_row) {
      ObjectReader::FailWith(fmt::format("{} has {}; expected features from 1 to {}",
                                         object.NameOf(key), ShownValue(element), kMaxFeatures),
                             object.file());
    }
    bits |= std::uint64_t{1} << (element.get<std::uint64_t>() - 1);
  }
  return bits;
}

Keyframe ReadKeyframe(const ObjectReader& object) {
  object.AllowOnly({"column", "ones", "zeros", "misses", "stiffness"});
  Keyframe keyframe;
  constexpr int kMost = std::numeric_limits<int>::max();
  keyframe.column = static_cast<int>(object.Integer("column", 0, kMost));
  keyframe.ones = ReadFeatures(object, "ones");
  const std::uint64_t zeros = ReadFeatures(object, "zeros");
  if ((keyframe.ones & zeros) != 0) object.FailAt("zeros", "features that are not in ones too");
  keyframe.tested = keyframe.ones | zeros;
  keyframe.misses = static_cast<int>(object.Integer("misses", 0, kMaxFeatures));
  if (!object.IsNull("stiffness")) keyframe.stiffness = object.Number("stiffness");
  return keyframe;
}

std::vector<Keyframe> ReadKeyframes(const ObjectReader& root, const TemplateMatrix& matrix) {
  std::vector<Keyframe> keyframes;
  for (const json& element : root.Array("keyframes")) {
    keyframes.push_back(
        ReadKeyframe({element, fmt::format("keyframes[{}]", keyframes.size()), root.file()}));
  }
  const std::string problem =
      ProblemOfKeyframes(keyframes, matrix.column_count(), matrix.feature_count);
  if (!problem.empty()) ObjectReader::FailWith(problem, root.file());
  return keyframes;
}

// Rows of equal length, one for each column of the matrix.
template <typename T>
std::vector<T> ReadRows(const ObjectReader& object, std::string_view key, int rows, int length) {
  std::vector<T> numbers;
  const json& list = object.Array(key);
  if (list.size() != static_cast<std::size_t>(rows)) {
    object.FailAt(key, fmt::format("a list for each of the {} columns", rows));
  }
  for (std::size_t row = 0; row < list.size(); ++row) {
    const std::string name = fmt::format("{}[{}]", object.NameOf(key), row);
    if (!list[row].is_array() || list[row].size() != static_cast<std::size_t>(length)) {
      ObjectReader::FailWith(fmt::format("{} is {}; expected a list of {} numbers", name,
                                         ShownValue(list[row]), length),
                             object.file());
    }
    for (const double value : ReadValues(list[row], name, object)) {
      numbers.push_back(static_cast<T>(value));
    }
  }
  return numbers;
}

PoseModel ReadPoseModel(const ObjectReader& object, int columns) {
  object.AllowOnly({"spread", "mean", "weight", "lookalikes"});
  PoseModel model{.mean = ReadRows<float>(object, "mean", columns, kPoseValues),
                  .weight = ReadRows<float>(object, "weight", columns, kPoseValues)};
  for (const double value : ReadValues(object.Array("spread"), object.NameOf("spread"), object)) {
    model.spread.push_back(static_cast<float>(value));
  }
  if (model.spread.size() != kPoseValues) {
    object.FailAt("spread", fmt::format("a list of {} numbers", kPoseValues));
  }
  if (object.Has("lookalikes")) {
    model.lookalikes = ReadRows<float>(object, "lookalikes", columns, kPoseValues);
  }
  return model;
}

Background ReadBackground(const ObjectReader& object) {
  object.AllowOnly({"ones", "mean", "variance"});
  const auto list = [&](std::string_view key) {
    return ReadValues(object.Array(key), object.NameOf(key), object);
  };
  return {.ones = list("ones"), .places = {.mean = list("mean"), .variance = list("variance")}};
}

Contrast ReadContrast(const ObjectReader& object, const TemplateMatrix& matrix) {
  object.AllowOnly({"entry_weights", "places", "background"});
  const int columns = matrix.column_count();
  Contrast contrast{
      .entry_weights = ReadRows<double>(object, "entry_weights", columns, matrix.feature_count),
      .places = ReadPoseModel(object.Object("places"), columns)};
  if (object.Has("background")) contrast.background = ReadBackground(object.Object("background"));
  return contrast;
}

Calibration ReadCalibration(const ObjectReader& object) {
  object.AllowOnly({"slope", "offset"});
  return {.slope = object.Number("slope"), .offset = object.Number("offset")};
}

// What came with a later version than the file's has no place in it.
void CheckVersion(const ObjectReader& root, std::string_view key, std::int64_t version, int first) {
  if (version >= first) return;
  ObjectReader::FailWith(
      fmt::format("{} in a file of version {}; they came with {}", key, version, first),
      root.file());
}

MotionTemplate ReadFields(const ObjectReader& root, std::int64_t version) {
  root.AllowOnly({"format", "version", "name", "learning", "matching", "feature_set", "clips",
                  "origin", "rounds", "quantisation", "tau", "tau_origin", "keyframes", "marks",
                  "matrix", "contrast", "calibration"});
  MotionTemplate result;
  result.name = root.String("name");
  result.learning = ReadProfile(root, "learning");
  result.matching = ReadProfile(root, "matching");
  const ObjectReader feature_set = root.Object("feature_set");
  feature_set.AllowOnly({"name", "hash"});
  result.feature_set = feature_set.String("name");
  result.feature_set_hash = ReadHash(feature_set);
  result.clips = ReadClips(root);
  if (root.Has("origin")) result.origin = root.String("origin");
  result.rounds = static_cast<int>(root.Integer("rounds", 0, std::numeric_limits<int>::max()));
  result.quantisation = root.Number("quantisation");
  if (!internal::IsQuantisation(result.quantisation)) {
    root.FailAt("quantisation", "0 up to, not including, 0.5");
  }
  if (!root.IsNull("tau")) {
    result.tau = root.Number("tau");
    if (!internal::IsThreshold(*result.tau)) root.FailAt("tau", "a number of at least 0, or null");
  }
  result.tau_origin = root.String("tau_origin");
  result.matrix = ReadMatrix(root);
  if (root.Has("contrast")) {
    result.contrast = ReadContrast(root.Object("contrast"), result.matrix);
    if (!result.contrast->places.lookalikes.empty()) {
      CheckVersion(root, "lookalikes", version, internal::kVersionWithLookalikes);
    }
    const std::string problem = internal::ProblemOf(*result.contrast, result.matrix);
    if (!problem.empty()) ObjectReader::FailWith("contrast has " + problem, root.file());
  }
  if (root.Has("calibration")) {
    result.calibration = ReadCalibration(root.Object("calibration"));
  }
  if (root.Has("keyframes")) {
    CheckVersion(root, "keyframes", version, internal::kVersionWithKeyframes);
    result.keyframes = ReadKeyframes(root, result.matrix);
  }
  if (root.Has("marks")) {
    CheckVersion(root, "marks", version, internal::kVersionWithMarks);
    result.marks = ReadMarks(root);
  }
  return result;
}

}  // namespace

MotionTemplate ParseTemplate(std::string_view json_text, const std::filesystem::path& file) {
  const json document = ParseJson(json_text, file);
  const ObjectReader root(document, "", file);
  return ReadFields(root, ReadHeader(root));
}

MotionTemplate ReadTemplate(const std::filesystem::path& path) {
  const MappedFile file(path);
  return ParseTemplate(file.text(), path);
}

}  // namespace kinebase
