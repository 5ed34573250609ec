// Template files; docs/template-file.md describes every field.
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

namespace kinebase {
namespace {

using nlohmann::json;

constexpr std::string_view kFormat = "kinebase-template";
// Written is the first version that can hold what a template has, so that programs of its time can
// read it: 2 brought keyframes, contrasts and calibrations.
constexpr int kVersion = 2;

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
  if (root.String("format") != kFormat) {
    root.FailAt("format", fmt::format("\"{}\"; this is no template file", kFormat));
  }
  const std::int64_t version = root.Integer("version", 1, std::numeric_limits<std::int64_t>::max());
  if (version > kVersion) {
    throw Error(ErrorCode::kMismatch,
                fmt::format("template file of version {}, this program reads up to version {}; "
                            "open it with a newer Kinebase",
                            version, kVersion),
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

bool IsThreshold(double tau) { return std::isfinite(tau) && tau >= 0; }

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
  object.AllowOnly({"spread", "mean", "weight"});
  PoseModel model{.mean = ReadRows<float>(object, "mean", columns, kPoseValues),
                  .weight = ReadRows<float>(object, "weight", columns, kPoseValues)};
  for (const double value : ReadValues(object.Array("spread"), object.NameOf("spread"), object)) {
    model.spread.push_back(static_cast<float>(value));
  }
  if (model.spread.size() != kPoseValues) {
    object.FailAt("spread", fmt::format("a list of {} numbers", kPoseValues));
  }
  return model;
}

Contrast ReadContrast(const ObjectReader& object, const TemplateMatrix& matrix) {
  object.AllowOnly({"entry_weights", "places"});
  const int columns = matrix.column_count();
  return {.entry_weights = ReadRows<double>(object, "entry_weights", columns, matrix.feature_count),
          .places = ReadPoseModel(object.Object("places"), columns)};
}

Calibration ReadCalibration(const ObjectReader& object) {
  object.AllowOnly({"slope", "offset"});
  return {.slope = object.Number("slope"), .offset = object.Number("offset")};
}

template <typename T>
bool AreWeights(const std::vector<T>& weights) {
  return std::ranges::all_of(weights, [](T each) { return std::isfinite(each) && each >= 0; });
}

// What is wrong with it, as "a place without a mean"; empty if nothing is.
std::string ProblemOf(const PoseModel& model, int columns) {
  const std::size_t values = static_cast<std::size_t>(columns) * kPoseValues;
  if (model.mean.size() != values || model.weight.size() != values ||
      model.spread.size() != kPoseValues) {
    return "poses of another size than the matrix";
  }
  const bool is_finite =
      std::ranges::all_of(model.mean, [](float each) { return std::isfinite(each); });
  if (!is_finite || !AreWeights(model.weight) || !AreWeights(model.spread)) {
    return "poses with a number that is not finite, or a weight or spread below 0";
  }
  for (std::size_t i = 0; i < values; ++i) {
    if (model.weight[i] > 0 && model.spread[i % kPoseValues] == 0) {
      return "poses with a weight where the spread is 0";
    }
  }
  return {};
}

std::string ProblemOf(const Contrast& contrast, const TemplateMatrix& matrix) {
  if (contrast.entry_weights.size() != matrix.values.size()) {
    return "entry weights of another size than the matrix";
  }
  if (!AreWeights(contrast.entry_weights)) return "an entry weight that is not finite or below 0";
  return ProblemOf(contrast.places, matrix.column_count());
}

std::string ProblemOf(const Calibration& calibration) {
  const bool is_fine = std::isfinite(calibration.slope) && std::isfinite(calibration.offset);
  return is_fine ? "" : "a calibration that is not finite";
}

MotionTemplate ReadFields(const ObjectReader& root, std::int64_t version) {
  root.AllowOnly({"format", "version", "name", "learning", "matching", "feature_set", "clips",
                  "origin", "rounds", "quantisation", "tau", "tau_origin", "keyframes", "matrix",
                  "contrast", "calibration"});
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
    if (!IsThreshold(*result.tau)) root.FailAt("tau", "a number of at least 0, or null");
  }
  result.tau_origin = root.String("tau_origin");
  result.matrix = ReadMatrix(root);
  if (root.Has("contrast")) {
    result.contrast = ReadContrast(root.Object("contrast"), result.matrix);
    const std::string problem = ProblemOf(*result.contrast, result.matrix);
    if (!problem.empty()) ObjectReader::FailWith("contrast has " + problem, root.file());
  }
  if (root.Has("calibration")) {
    result.calibration = ReadCalibration(root.Object("calibration"));
  }
  if (root.Has("keyframes")) {
    if (version < kVersion) {
      ObjectReader::FailWith(
          fmt::format("keyframes in a file of version {}; they came with {}", version, kVersion),
          root.file());
    }
    result.keyframes = ReadKeyframes(root, result.matrix);
  }
  return result;
}

void CheckWritten(const MotionTemplate& motion_template) {
  std::string problem = internal::ProblemOf(motion_template.matrix);
  if (!problem.empty()) problem = "matrix has " + problem;
  if (!internal::IsQuantisation(motion_template.quantisation)) {
    problem = fmt::format("quantisation threshold {}; expected 0 up to, not including, 0.5",
                          motion_template.quantisation);
  }
  if (motion_template.tau && !IsThreshold(*motion_template.tau)) {
    problem = fmt::format("tau {}; expected a number of at least 0", *motion_template.tau);
  }
  if (motion_template.contrast && problem.empty()) {
    problem = ProblemOf(*motion_template.contrast, motion_template.matrix);
  }
  if (motion_template.calibration && problem.empty()) {
    problem = ProblemOf(*motion_template.calibration);
  }
  if (motion_template.rounds < 0) {
    problem = fmt::format("{} rounds; expected at least 0", motion_template.rounds);
  }
  const std::string keyframes =
      ProblemOfKeyframes(motion_template.keyframes, motion_template.matrix.column_count(),
                         motion_template.matrix.feature_count);
  if (!keyframes.empty()) problem = keyframes;
  for (const TemplateClip& clip : motion_template.clips) {
    const bool whole = clip.first_frame == 0 && clip.last_frame == 0;
    if (!whole && (clip.first_frame < 1 || clip.last_frame < clip.first_frame)) {
      problem = fmt::format("clip '{}' has frames {} to {}; expected 1 or more, or both 0",
                            clip.file, clip.first_frame, clip.last_frame);
    }
  }
  if (problem.empty()) return;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("template '{}' cannot be written: {}", motion_template.name, problem));
}

std::string JsonString(const std::string& text) {
  try {
    return json(text).dump();
  } catch (const json::type_error&) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("text {} is not UTF-8, so a template file cannot hold it; rename it",
                            Quoted(text)));
  }
}

void AppendNumbers(std::string& out, std::span<const double> numbers) {
  out += '[';
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0) out += ", ";
    // JSON readers take "-0" for an integer, which has no negative zero.
    if (numbers[i] == 0 && std::signbit(numbers[i])) {
      out += "-0.0";
    } else {
      AppendShortestText(out, numbers[i]);
    }
  }
  out += ']';
}

std::string FormatClips(const std::vector<TemplateClip>& clips) {
  std::string out = "[";
  for (std::size_t i = 0; i < clips.size(); ++i) {
    out += fmt::format("{}\n    {{\"file\": {}, \"first_frame\": {}, \"last_frame\": {}}}",
                       i > 0 ? "," : "", JsonString(clips[i].file), clips[i].first_frame,
                       clips[i].last_frame);
  }
  return out + (clips.empty() ? "]" : "\n  ]");
}

std::string FormatFeatures(std::uint64_t bits) {
  std::string out;
  for (int row = 0; row < kMaxFeatures; ++row) {
    if (((bits >> row) & 1U) != 0) out += fmt::format("{}{}", out.empty() ? "" : ", ", row + 1);
  }
  return '[' + out + ']';
}

std::string FormatKeyframes(const std::vector<Keyframe>& keyframes) {
  std::string out = "[";
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& keyframe = keyframes[i];
    out += fmt::format(
        "{}\n    {{\"column\": {}, \"ones\": {}, \"zeros\": {}, \"misses\": {}, "
        "\"stiffness\": {}}}",
        i > 0 ? "," : "", keyframe.column, FormatFeatures(keyframe.ones),
        FormatFeatures(keyframe.tested & ~keyframe.ones), keyframe.misses,
        keyframe.stiffness ? ToShortestText(*keyframe.stiffness) : "null");
  }
  return out + "\n  ]";
}

// One column a line, so that two templates can be compared by eye and by diff.
std::string FormatMatrix(const TemplateMatrix& matrix) {
  std::string out = fmt::format(
      "{{\n    \"rate_hz\": {},\n    \"feature_count\": {},\n    "
      "\"weights\": ",
      ToShortestText(matrix.rate_hz), matrix.feature_count);
  AppendNumbers(out, matrix.weights);
  out += ",\n    \"columns\": [";
  for (int c = 0; c < matrix.column_count(); ++c) {
    out += c > 0 ? ",\n      " : "\n      ";
    AppendNumbers(out, matrix.Column(c));
  }
  return out + "\n    ]\n  }";
}

// The same for any numbers, a row of them a line.
template <typename T>
std::string FormatRows(std::span<const T> numbers, std::size_t length, std::string_view indent) {
  std::string out = "[";
  for (std::size_t first = 0; first < numbers.size(); first += length) {
    out += fmt::format("{}\n{}  [{}]", first > 0 ? "," : "", indent,
                       fmt::join(numbers.subspan(first, length), ", "));
  }
  return out + fmt::format("\n{}]", indent);
}

std::string FormatPoseModel(const PoseModel& model) {
  return fmt::format(
      "{{\n      \"spread\": [{}],\n      \"mean\": {},\n      \"weight\": {}\n    }}",
      fmt::join(model.spread, ", "), FormatRows(std::span(model.mean), kPoseValues, "      "),
      FormatRows(std::span(model.weight), kPoseValues, "      "));
}

std::string FormatContrast(const Contrast& contrast, const TemplateMatrix& matrix) {
  return fmt::format("{{\n    \"entry_weights\": {},\n    \"places\": {}\n  }}",
                     FormatRows(std::span(contrast.entry_weights),
                                static_cast<std::size_t>(matrix.feature_count), "    "),
                     FormatPoseModel(contrast.places));
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

std::string FormatTemplate(const MotionTemplate& motion_template) {
  CheckWritten(motion_template);
  std::string out = "{\n";
  const auto add = [&out](std::string_view key, std::string_view value) {
    out += fmt::format("{}  \"{}\": {}", out.size() > 2 ? ",\n" : "", key, value);
  };
  add("format", fmt::format("\"{}\"", kFormat));
  const bool is_plain = !motion_template.contrast && !motion_template.calibration &&
                        motion_template.keyframes.empty();
  add("version", std::to_string(is_plain ? 1 : kVersion));
  add("name", JsonString(motion_template.name));
  add("learning", fmt::format("\"{}\"", ToString(motion_template.learning)));
  add("matching", fmt::format("\"{}\"", ToString(motion_template.matching)));
  add("feature_set",
      fmt::format("{{\"name\": {}, \"hash\": \"{:016x}\"}}",
                  JsonString(motion_template.feature_set), motion_template.feature_set_hash));
  add("clips", FormatClips(motion_template.clips));
  if (!motion_template.origin.empty()) add("origin", JsonString(motion_template.origin));
  add("rounds", std::to_string(motion_template.rounds));
  add("quantisation", ToShortestText(motion_template.quantisation));
  add("tau", motion_template.tau ? ToShortestText(*motion_template.tau) : "null");
  add("tau_origin", JsonString(motion_template.tau_origin));
  if (!motion_template.keyframes.empty())
    add("keyframes", FormatKeyframes(motion_template.keyframes));
  add("matrix", FormatMatrix(motion_template.matrix));
  if (motion_template.contrast) {
    add("contrast", FormatContrast(*motion_template.contrast, motion_template.matrix));
  }
  if (motion_template.calibration) {
    add("calibration", fmt::format("{{\"slope\": {}, \"offset\": {}}}",
                                   ToShortestText(motion_template.calibration->slope),
                                   ToShortestText(motion_template.calibration->offset)));
  }
  return out + "\n}\n";
}

void WriteTemplate(const MotionTemplate& motion_template, const std::filesystem::path& path,
                   Overwrite overwrite) {
  WriteFile(path, FormatTemplate(motion_template), overwrite);
}

}  // namespace kinebase
