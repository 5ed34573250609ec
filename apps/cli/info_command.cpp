// kinebase info: what is in a file, and what is odd about it.

#include <memory>
#include <set>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/file_contents.h"
#include "cli/other_files.h"
#include "fmt/format.h"
#include "kinebase/core/parallel.h"
#include "kinebase/library/takes.h"
#include "kinebase/motion/kinematics.h"

namespace kinebase::cli {
namespace {

struct InfoOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> paths;
};

// One file, or why it could not be read.
struct FileInfo {
  std::filesystem::path path;
  std::optional<Recording> recording;
  std::optional<OtherFile> other;  // Instead of a recording.
  BoundingBox box;
  std::vector<JointSource> joints;  // Where the standard joints are; empty if they are not.
  std::string why_no_joints;
  std::optional<Error> error;
};

// Files that the paths name; a path that names none stands for itself, with the reason.
std::vector<FileInfo> FindFiles(const std::vector<std::filesystem::path>& paths) {
  std::vector<FileInfo> files;
  std::set<std::filesystem::path> seen;
  const auto add = [&](const std::filesystem::path& file) {
    std::error_code ignored;
    if (seen.insert(std::filesystem::weakly_canonical(file, ignored)).second) {
      files.push_back({.path = file});
    }
  };
  for (const std::filesystem::path& path : paths) {
    std::error_code unreachable;
    if (IsOtherFile(path) && !std::filesystem::is_directory(path, unreachable)) {
      add(path);
      continue;
    }
    try {
      for (const auto& file : FindMotionFiles(std::span(&path, 1))) add(file);
    } catch (const Error& error) {
      const bool is_unknown = std::filesystem::is_regular_file(path, unreachable);
      files.push_back({.path = path,
                       .error = is_unknown ? Error(error.code(),
                                                   fmt::format("{}; no motion, but known, too: {}",
                                                               error.message(), OtherEndings()),
                                                   error.place())
                                           : error});
    }
  }
  return files;
}

void Load(const LoadOptions& options, FileInfo& info) {
  if (IsOtherFile(info.path)) {
    info.other = ReadOtherFile(info.path, options);
    return;
  }
  const Recording& recording = info.recording.emplace(LoadRecording(info.path, options));
  info.box = recording.has_skeleton() ? ComputeBoundingBox(ForwardKinematics(recording.motion))
                                      : ComputeBoundingBox(recording.markers);
}

void Inspect(const LoadOptions& options, FileInfo& info) {
  try {
    Load(options, info);
  } catch (const Error& error) {
    info.error = error;
  } catch (const std::bad_alloc&) {
    info.error =
        Error(ErrorCode::kIoFailure, "needs more memory than there is", {.file = info.path});
  }
  if (info.error) info.recording.reset();
  if (!info.recording) return;
  try {
    info.joints = FindStandardJoints(*info.recording, info.recording->diagnostics);
  } catch (const Error& error) {
    info.why_no_joints = error.message();
  }
}

Json TextOrNull(const std::string& text) { return text.empty() ? Json() : Json(text); }

Json ToJson(const Diagnostics& diagnostics) {
  Json list = Json::array();
  for (const Diagnostic& diagnostic : diagnostics) {
    list.push_back({{"severity", ToString(diagnostic.severity)},
                    {"line", diagnostic.line > 0 ? Json(diagnostic.line) : Json()},
                    {"byte", diagnostic.byte >= 0 ? Json(diagnostic.byte) : Json()},
                    {"message", diagnostic.message}});
  }
  return list;
}

Json ToJson(const std::vector<JointSource>& joints) {
  Json list = Json::array();
  for (const JointSource& joint : joints) {
    list.push_back({{"joint", ToString(joint.joint)},
                    {"source", joint.source},
                    {"match", ToString(joint.match)},
                    {"confidence", joint.confidence}});
  }
  return list;
}

// The fields of a recording; those that another file does not have are null.
Json OtherAsJson(const FileInfo& info) {
  Json json = {{"path", info.path.string()}, {"format", info.other->format}};
  for (const char* const field :
       {"frames", "first_frame", "rate_hz", "duration_s", "joints", "markers", "units", "up_axis",
        "bounding_box_cm", "actor", "class", "take", "skeleton"}) {
    json[field] = nullptr;
  }
  json["contents"] = info.other->contents;
  json["standard_joints"] = Json::array();
  json["no_standard_joints"] = nullptr;
  json["diagnostics"] = ToJson(info.other->diagnostics);
  return json;
}

Json ToJson(const FileInfo& info) {
  if (info.other) return OtherAsJson(info);
  const Recording& recording = *info.recording;
  const auto corner = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  return {
      {"path", info.path.string()},
      {"format", recording.format},
      {"frames", recording.frame_count()},
      {"first_frame", recording.first_frame()},
      {"rate_hz", recording.rate_hz()},
      {"duration_s", recording.duration_s()},
      {"joints", recording.motion.joint_count()},
      {"markers", recording.markers.marker_count()},
      {"units", recording.units},
      {"up_axis", recording.up_axis},
      {"bounding_box_cm", {{"low", corner(info.box.low_cm)}, {"high", corner(info.box.high_cm)}}},
      {"actor", TextOrNull(recording.name.actor)},
      {"class", TextOrNull(recording.name.class_name)},
      {"take", TextOrNull(recording.name.take)},
      {"skeleton", TextOrNull(recording.skeleton_path.string())},
      {"contents", ContentsAsJson(recording)},
      {"standard_joints", ToJson(info.joints)},
      {"no_standard_joints", TextOrNull(info.why_no_joints)},
      {"diagnostics", ToJson(recording.diagnostics)}};
}

// "24 of 24; nearest instead: ltoes (LeftFoot)".
std::string DescribeJoints(const FileInfo& info) {
  if (!info.why_no_joints.empty()) return "cannot be searched: " + info.why_no_joints;
  std::string replaced;
  for (const JointSource& joint : info.joints) {
    if (joint.match != JointMatch::kNearest) continue;
    replaced += fmt::format("{}{} at {}", replaced.empty() ? "" : ", ", ToString(joint.joint),
                            joint.source);
  }
  const auto least = std::ranges::min_element(info.joints, {}, &JointSource::confidence);
  std::string text = "all found";
  if (least != info.joints.end()) {
    text += least->confidence == 1 ? ", certain"
                                   : fmt::format(", least sure {} ({:.2f})", ToString(least->joint),
                                                 least->confidence);
  }
  return replaced.empty() ? text : text + "; only near: " + replaced;
}

// Titles and what follows them, one below the other.
class Description {
 public:
  explicit Description(const std::filesystem::path& path)
      : text_(OnOneLine(path.string()) + '\n') {}

  void Line(std::string_view title, const std::string& value) {
    if (!value.empty()) text_ += fmt::format("  {:<10}{}\n", title, OnOneLine(value));
  }

  void Add(const Diagnostics& diagnostics) {
    for (const Diagnostic& diagnostic : diagnostics) {
      Line(ToString(diagnostic.severity),
           diagnostic.line > 0 ? fmt::format("line {}: {}", diagnostic.line, diagnostic.message)
                               : diagnostic.message);
    }
  }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string DescribeOther(const FileInfo& info) {
  Description description(info.path);
  description.Line("format", info.other->format);
  for (const auto& [title, value] : info.other->lines) description.Line(title, value);
  description.Add(info.other->diagnostics);
  return description.text();
}

std::string Describe(const FileInfo& info) {
  if (info.other) return DescribeOther(info);
  const Recording& recording = *info.recording;
  const Eigen::Vector3d size = info.box.high_cm - info.box.low_cm;
  Description description(info.path);
  const auto line = [&](std::string_view title, const std::string& value) {
    description.Line(title, value);
  };
  line("format", std::string(recording.format));
  line("frames",
       recording.first_frame() == 1
           ? std::to_string(recording.frame_count())
           : fmt::format("{}, numbered from {}", recording.frame_count(), recording.first_frame()));
  line("duration", fmt::format("{:.2f} s at {:g} Hz", recording.duration_s(), recording.rate_hz()));
  if (recording.has_skeleton()) {
    line("joints", std::to_string(recording.motion.joint_count()));
  } else {
    line("markers", DescribeMarkers(recording.markers));
  }
  line("units", fmt::format("{}, {} up", recording.units, recording.up_axis));
  line("extent",
       fmt::format("{:.0f} × {:.0f} × {:.0f} cm (x, y, z)", size.x(), size.y(), size.z()));
  line("actor", recording.name.actor);
  line("class", recording.name.class_name);
  line("take", recording.name.take);
  line("skeleton", recording.skeleton_path.string());
  for (const auto& [name, value] : DescribeContents(recording)) line(name, value);
  line("standard", DescribeJoints(info));
  description.Add(recording.diagnostics);
  return description.text();
}

// Many files, a line each.
std::string DescribeAll(const std::vector<FileInfo>& files) {
  TextTable table({"file", "format", "actor", "class", ">frames", ">Hz", ">s", ">joints",
                   ">markers", "searchable", ">odd"});
  const auto count = [](int number) { return number > 0 ? std::to_string(number) : ""; };
  const auto odd_in = [&](const Diagnostics& diagnostics) {
    return count(static_cast<int>(
        std::ranges::count(diagnostics, Severity::kWarning, &Diagnostic::severity)));
  };
  for (const FileInfo& info : files) {
    if (info.other) {
      table.Add({info.path.string(), info.other->format, "", "", "", "", "", "", "", "",
                 odd_in(info.other->diagnostics)});
    }
    if (!info.recording) continue;
    const Recording& recording = *info.recording;
    table.Add({info.path.string(), std::string(recording.format), recording.name.actor,
               recording.name.class_name, std::to_string(recording.frame_count()),
               fmt::format("{:g}", recording.rate_hz()),
               fmt::format("{:.2f}", recording.duration_s()), count(recording.motion.joint_count()),
               count(recording.markers.marker_count()), info.why_no_joints.empty() ? "yes" : "no",
               odd_in(recording.diagnostics)});
  }
  return table.ToString();
}

int Run(const InfoOptions& options) {
  std::vector<FileInfo> files = FindFiles(options.paths);
  std::vector<FileInfo*> to_read;
  for (FileInfo& info : files) {
    if (!info.error) to_read.push_back(&info);
  }
  ParallelFor(to_read.size(), options.common.threads, "reading", MakeProgress(options.common),
              [&](std::size_t i) { Inspect(options.common.load, *to_read[i]); });
  Json list = Json::array();
  Json failed = Json::array();
  for (const FileInfo& info : files) {
    if (!info.error) {
      if (options.common.json) list.push_back(ToJson(info));
      continue;
    }
    PrintError(info.error->what());
    failed.push_back({{"file", info.path.string()}, {"message", info.error->what()}});
  }
  if (failed.size() == files.size()) return kCouldNot;
  if (options.common.json) {
    Json result = {{"files", std::move(list)}};
    if (!failed.empty()) result["failed"] = failed;
    PrintJson(result);
  } else {
    Print(files.size() == 1 ? Describe(files.front()) : DescribeAll(files));
  }
  return failed.empty() ? kDone : kPartFailed;
}

}  // namespace

void AddInfoCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = program.add_subcommand("info", "What is in a file");
  command->add_option("PATH", options->paths, "Files of any format, or folders with motion files")
      ->required();
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer("Example:\n  kinebase info HDM_bd_squat1Reps_001_120.amc");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
