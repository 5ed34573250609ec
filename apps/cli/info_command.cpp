// kinebase info: what is in a file, and what is odd about it.

#include <memory>

#include "cli/commands.h"
#include "cli/console.h"
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
  std::optional<LoadedMotion> loaded;
  BoundingBox box;
  std::optional<Error> error;
};

FileInfo Inspect(const std::filesystem::path& path, const LoadOptions& options) {
  FileInfo info{.path = path};
  try {
    info.loaded = LoadMotion(path, options);
    info.box = ComputeBoundingBox(ForwardKinematics(info.loaded->motion));
  } catch (const Error& error) {
    info.error = error;
  } catch (const std::bad_alloc&) {
    info.error = Error(ErrorCode::kIoFailure, "needs more memory than there is", {.file = path});
  }
  return info;
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

Json ToJson(const FileInfo& info) {
  const LoadedMotion& loaded = *info.loaded;
  const Motion& motion = loaded.motion;
  const auto corner = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  return {
      {"path", info.path.string()},
      {"format", loaded.format},
      {"frames", motion.frame_count},
      {"first_frame", motion.first_frame},
      {"rate_hz", motion.rate_hz},
      {"duration_s", motion.duration_s()},
      {"joints", motion.joint_count()},
      {"markers", 0},
      {"units", loaded.units},
      {"up_axis", loaded.up_axis},
      {"bounding_box_cm", {{"low", corner(info.box.low_cm)}, {"high", corner(info.box.high_cm)}}},
      {"actor", TextOrNull(loaded.name.actor)},
      {"class", TextOrNull(loaded.name.class_name)},
      {"take", TextOrNull(loaded.name.take)},
      {"skeleton", TextOrNull(loaded.skeleton_path.string())},
      {"diagnostics", ToJson(loaded.diagnostics)}};
}

std::string Describe(const FileInfo& info) {
  const LoadedMotion& loaded = *info.loaded;
  const Motion& motion = loaded.motion;
  const Eigen::Vector3d size = info.box.high_cm - info.box.low_cm;
  std::string text = OnOneLine(info.path.string()) + '\n';
  const auto line = [&](std::string_view name, const std::string& value) {
    if (!value.empty()) text += fmt::format("  {:<10}{}\n", name, OnOneLine(value));
  };
  line("format", std::string(loaded.format));
  line("frames", motion.first_frame == 1
                     ? std::to_string(motion.frame_count)
                     : fmt::format("{}, numbered from {}", motion.frame_count, motion.first_frame));
  line("duration", fmt::format("{:.2f} s at {:g} Hz", motion.duration_s(), motion.rate_hz));
  line("joints", std::to_string(motion.joint_count()));
  line("units", fmt::format("{}, {} up", loaded.units, loaded.up_axis));
  line("extent",
       fmt::format("{:.0f} × {:.0f} × {:.0f} cm (x, y, z)", size.x(), size.y(), size.z()));
  line("actor", loaded.name.actor);
  line("class", loaded.name.class_name);
  line("take", loaded.name.take);
  line("skeleton", loaded.skeleton_path.string());
  for (const Diagnostic& diagnostic : loaded.diagnostics) {
    line(ToString(diagnostic.severity),
         diagnostic.line > 0 ? fmt::format("line {}: {}", diagnostic.line, diagnostic.message)
                             : diagnostic.message);
  }
  return text;
}

// Many files, a line each.
std::string DescribeAll(const std::vector<FileInfo>& files) {
  TextTable table({"file", "actor", "class", ">frames", ">Hz", ">s", ">joints", ">odd"});
  for (const FileInfo& info : files) {
    if (!info.loaded) continue;
    const Motion& motion = info.loaded->motion;
    const auto odd =
        std::ranges::count(info.loaded->diagnostics, Severity::kWarning, &Diagnostic::severity);
    table.Add({info.path.string(), info.loaded->name.actor, info.loaded->name.class_name,
               std::to_string(motion.frame_count), fmt::format("{:g}", motion.rate_hz),
               fmt::format("{:.2f}", motion.duration_s()), std::to_string(motion.joint_count()),
               odd > 0 ? std::to_string(odd) : ""});
  }
  return table.ToString();
}

int Run(const InfoOptions& options) {
  const auto paths = FindMotionFiles(options.paths);
  std::vector<FileInfo> files(paths.size());
  ParallelFor(paths.size(), options.common.threads, "reading", MakeProgress(options.common),
              [&](std::size_t i) { files[i] = Inspect(paths[i], options.common.load); });
  Json list = Json::array();
  Json failed = Json::array();
  for (const FileInfo& info : files) {
    if (info.loaded) {
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
  CLI::App* command = program.add_subcommand("info", "What is in motion files");
  command->add_option("PATH", options->paths, "Files or folders")->required();
  AddOutputOptions(*command, options->common);
  AddThreadsOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer("Example:\n  kinebase info HDM_bd_squat1Reps_001_120.amc");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
