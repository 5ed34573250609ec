// Writing template files.
#include <cmath>
#include <span>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/features/pose_stream.h"
#include "kinebase/templates/keyframes.h"
#include "kinebase/templates/template_file.h"
#include "nlohmann/json.hpp"
#include "templates/matrix_check.h"
#include "templates/template_checks.h"

namespace kinebase {
namespace {

using nlohmann::json;

void CheckWritten(const MotionTemplate& motion_template) {
  std::string problem = internal::ProblemOf(motion_template.matrix);
  if (!problem.empty()) problem = "matrix has " + problem;
  if (!internal::IsQuantisation(motion_template.quantisation)) {
    problem = fmt::format("quantisation threshold {}; expected 0 up to, not including, 0.5",
                          motion_template.quantisation);
  }
  if (motion_template.tau && !internal::IsThreshold(*motion_template.tau)) {
    problem = fmt::format("tau {}; expected a number of at least 0", *motion_template.tau);
  }
  if (motion_template.contrast && problem.empty()) {
    problem = internal::ProblemOf(*motion_template.contrast, motion_template.matrix);
  }
  if (motion_template.calibration && problem.empty()) {
    problem = internal::ProblemOf(*motion_template.calibration);
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
  for (const TemplateMark& mark : motion_template.marks) {
    if (mark.first_frame < 1 || mark.last_frame < mark.first_frame) {
      problem = fmt::format("mark of '{}' has frames {} to {}; expected 1 or more", mark.file,
                            mark.first_frame, mark.last_frame);
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

std::string FormatMarks(const std::vector<TemplateMark>& marks) {
  std::string out = "[";
  for (std::size_t i = 0; i < marks.size(); ++i) {
    out += fmt::format(
        "{}\n    {{\"file\": {}, \"first_frame\": {}, \"last_frame\": {}, \"verdict\": \"{}\"}}",
        i > 0 ? "," : "", JsonString(marks[i].file), marks[i].first_frame, marks[i].last_frame,
        ToString(marks[i].verdict));
  }
  return out + "\n  ]";
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
  const auto rows = [](const std::vector<float>& numbers) {
    return FormatRows(std::span(numbers), kPoseValues, "      ");
  };
  std::string out =
      fmt::format("{{\n      \"spread\": [{}],\n      \"mean\": {},\n      \"weight\": {}",
                  fmt::join(model.spread, ", "), rows(model.mean), rows(model.weight));
  if (!model.lookalikes.empty()) {
    out += fmt::format(",\n      \"lookalikes\": {}", rows(model.lookalikes));
  }
  return out + "\n    }";
}

std::string FormatBackground(const Background& background) {
  const auto list = [](const std::vector<double>& numbers) {
    std::string out;
    AppendNumbers(out, numbers);
    return out;
  };
  return fmt::format("{{\n      \"ones\": {},\n      \"mean\": {},\n      \"variance\": {}\n    }}",
                     list(background.ones), list(background.places.mean),
                     list(background.places.variance));
}

std::string FormatContrast(const Contrast& contrast, const TemplateMatrix& matrix) {
  std::string out = fmt::format("{{\n    \"entry_weights\": {},\n    \"places\": {}",
                                FormatRows(std::span(contrast.entry_weights),
                                           static_cast<std::size_t>(matrix.feature_count), "    "),
                                FormatPoseModel(contrast.places));
  if (contrast.background) {
    out += fmt::format(",\n    \"background\": {}", FormatBackground(*contrast.background));
  }
  return out + "\n  }";
}

int VersionFor(const MotionTemplate& motion_template) {
  const std::optional<Contrast>& contrast = motion_template.contrast;
  if (contrast && !contrast->places.lookalikes.empty()) return internal::kVersionWithLookalikes;
  if (!motion_template.marks.empty() || (contrast && contrast->background)) {
    return internal::kVersionWithMarks;
  }
  const bool is_plain =
      !contrast && !motion_template.calibration && motion_template.keyframes.empty();
  return is_plain ? 1 : internal::kVersionWithKeyframes;
}

}  // namespace

std::string FormatTemplate(const MotionTemplate& motion_template) {
  CheckWritten(motion_template);
  std::string out = "{\n";
  const auto add = [&out](std::string_view key, std::string_view value) {
    out += fmt::format("{}  \"{}\": {}", out.size() > 2 ? ",\n" : "", key, value);
  };
  add("format", fmt::format("\"{}\"", internal::kTemplateFormat));
  add("version", std::to_string(VersionFor(motion_template)));
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
  if (!motion_template.marks.empty()) add("marks", FormatMarks(motion_template.marks));
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
