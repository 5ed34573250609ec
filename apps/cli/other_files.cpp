#include "cli/other_files.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"
#include "kinebase/formats/mnm.h"
#include "kinebase/formats/sto.h"
#include "kinebase/motion/asf_amc_motion.h"
#include "kinebase/motion/csm_motion.h"
#include "kinebase/motion/kinematics.h"
#include "kinebase/motion/standard_skeleton.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

std::string WhyNotSearchable(const Skeleton& skeleton) {
  try {
    CheckStandardJoints(skeleton);
    return {};
  } catch (const Error& error) {
    return error.message();
  }
}

std::string DescribeHeight(const Skeleton& skeleton) {
  const std::vector<Eigen::Vector3d> pose = NeutralPose(skeleton);
  const auto [low, high] =
      std::ranges::minmax(pose, {}, [](const Eigen::Vector3d& place) { return place.y(); });
  return fmt::format("{:.0f} cm from lowest to highest joint", high.y() - low.y());
}

OtherFile ReadSkeleton(const fs::path& file, const LoadOptions& options) {
  const AsfSkeleton asf = ReadAsf(file);
  OtherFile info{.format = "ASF", .diagnostics = asf.diagnostics};
  const LengthReading reading = ChooseLengthReading(asf, options.length_reading, info.diagnostics);
  const auto skeleton = BuildSkeleton(asf, {.length_reading = reading}, info.diagnostics);
  std::size_t dofs = asf.root_order.size();
  for (const AsfBone& bone : asf.bones) dofs += bone.dofs.size();
  const auto moving =
      std::ranges::count_if(asf.bones, [](const AsfBone& bone) { return !bone.dofs.empty(); });
  const std::string why_not = WhyNotSearchable(*skeleton);
  info.lines = {{"name", asf.name},
                {"joints", fmt::format("{}, {} of the bones move; {} degrees of freedom",
                                       skeleton->joint_count(), moving, dofs)},
                {"height", DescribeHeight(*skeleton)},
                {"units", fmt::format("{:g} cm, {}", CentimetresPerUnit(asf, reading),
                                      asf.angle_is_degrees ? "degrees" : "radians")},
                {"says", std::string(Trim(fmt::format("{}", fmt::join(asf.documentation, " "))))},
                {"standard", why_not.empty() ? "all found" : "cannot be searched: " + why_not}};
  Json bones = Json::array();
  for (const AsfBone& bone : asf.bones) bones.push_back(bone.name);
  info.contents = {{"name", asf.name},
                   {"bones", std::move(bones)},
                   {"degrees_of_freedom", dofs},
                   {"cm_per_unit", CentimetresPerUnit(asf, reading)},
                   {"documentation", asf.documentation},
                   {"no_standard_joints", why_not.empty() ? Json() : Json(why_not)}};
  return info;
}

OtherFile ReadNames(const fs::path& file, const LoadOptions& options) {
  const MarkerNames names = ReadMnm(file, {.strict = options.strict});
  OtherFile info{.format = "MNM", .diagnostics = names.diagnostics};
  std::vector<std::string> presets;
  std::vector<std::string> pairs;
  Json rows = Json::array();
  for (const MarkerNames::Row& row : names.rows) {
    presets.push_back(row.preset);
    pairs.push_back(row.preset + " = " + row.custom);
    rows.push_back({{"preset", row.preset}, {"custom", row.custom}});
  }
  const Diagnostics missing = CheckPreset(presets);
  info.diagnostics.insert(info.diagnostics.end(), missing.begin(), missing.end());
  info.lines = {{"names", fmt::format("{}: {}", pairs.size(), fmt::join(pairs, ", "))}};
  info.contents = {{"names", std::move(rows)}};
  return info;
}

// Rows that stand evenly over time.
void DescribeTimes(const std::vector<double>& times_s, OtherFile& info) {
  if (times_s.empty()) return;
  const double length_s = times_s.back() - times_s.front();
  info.lines.emplace_back("time",
                          fmt::format("{:.3f} to {:.3f} s", times_s.front(), times_s.back()));
  info.contents["first_time_s"] = times_s.front();
  info.contents["last_time_s"] = times_s.back();
  if (length_s <= 0) return;
  const double rate_hz = static_cast<double>(times_s.size() - 1) / length_s;
  info.lines.back().second += fmt::format(", {:.6g} rows a second", rate_hz);
  info.contents["rate_hz"] = rate_hz;
}

void DescribeTable(std::size_t rows, const std::vector<std::string>& columns, OtherFile& info) {
  info.lines.emplace_back("rows", std::to_string(rows));
  info.lines.emplace_back("columns",
                          fmt::format("{}: {}", columns.size(), fmt::join(columns, ", ")));
  info.contents["rows"] = rows;
  info.contents["columns"] = columns;
}

OtherFile ReadTable(const fs::path& file, const LoadOptions& /*options*/) {
  const StoTable table = ReadSto(file);
  OtherFile info{.format = EqualsIgnoringCase(file.extension().string(), ".mot") ? "MOT" : "STO",
                 .diagnostics = table.diagnostics};
  info.lines = {{"name", table.name}, {"cells", table.data_type}};
  info.contents = {{"name", table.name},
                   {"data_type", table.data_type},
                   {"in_degrees", table.in_degrees ? Json(*table.in_degrees) : Json()}};
  if (table.in_degrees) {
    info.lines.emplace_back("angles", *table.in_degrees ? "degrees" : "radians");
  }
  for (const StoHeaderLine& line : table.header) {
    info.lines.emplace_back("header", line.key.empty() ? line.value : line.key + '=' + line.value);
  }
  DescribeTable(table.row_count(), table.labels, info);
  DescribeTimes(table.times_s, info);
  return info;
}

OtherFile ReadCsvTable(const fs::path& file, const LoadOptions& /*options*/) {
  const CsvTable table = ParseCsv(MappedFile(file).text(), file);
  OtherFile info{.format = "CSV"};
  DescribeTable(table.rows.size(), table.columns, info);
  const auto column = table.FindColumn("time_s");
  if (!column) return info;
  std::vector<double> times_s;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto time_s = ParseDouble(table.rows[i][*column]);
    if (!time_s) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("time_s is {}, which is no number", Quoted(table.rows[i][*column])),
                  {file, table.lines[i]});
    }
    times_s.push_back(*time_s);
  }
  DescribeTimes(times_s, info);
  return info;
}

// The scene of a GLB: 12 bytes of header, then a chunk of JSON behind its length and kind.
Json ReadScene(const fs::path& file) {
  constexpr std::size_t kHeaderSize = 12;
  constexpr std::size_t kChunkHeaderSize = 8;
  const MappedFile mapped(file);
  std::string_view text = mapped.text();
  const auto number_at = [&](std::size_t at) {
    std::uint32_t number = 0;  // Little endian, as are the machines that Kinebase runs on.
    std::memcpy(&number, text.data() + at, sizeof number);
    return number;
  };
  const auto fail = [&](const std::string& message) -> void {
    throw Error(ErrorCode::kMalformedFile, message, {file});
  };
  if (text.size() < kHeaderSize + kChunkHeaderSize || !text.starts_with("glTF")) {
    fail("is no GLB: it does not begin with 'glTF' and a scene");
  }
  if (number_at(4) != 2) fail(fmt::format("has version {} of glTF; 2 is read", number_at(4)));
  const std::size_t whole_size = number_at(8);
  const std::size_t size = number_at(kHeaderSize);
  if (whole_size > text.size()) {
    fail(fmt::format("is cut off: it has {} of {} bytes", text.size(), whole_size));
  }
  text.remove_prefix(kHeaderSize + kChunkHeaderSize);
  if (size > text.size()) fail("is damaged: its scene is longer than the file");
  Json scene = Json::parse(text.substr(0, size), nullptr, false);
  if (!scene.is_object()) fail("holds no scene that can be read");
  return scene;
}

// The last time of the animations: the largest value of what their samplers take as times.
double LastTime(const Json& scene) {
  double last_s = 0;
  for (const Json& animation : scene.value("animations", Json::array())) {
    for (const Json& sampler : animation.at("samplers")) {
      const Json& times = scene.at("accessors").at(sampler.at("input").get<std::size_t>());
      last_s = std::max(last_s, times.at("max").at(0).get<double>());
    }
  }
  return last_s;
}

// What Kinebase notes down about the recording; null in files of others.
Json NoteOf(const Json& scene, const char* name) {
  for (const Json& animation : scene.value("animations", Json::array())) {
    const Json extras = animation.value("extras", Json::object());
    if (extras.is_object() && extras.contains(name)) return extras.at(name);
  }
  return nullptr;
}

OtherFile ReadGlb(const fs::path& file, const LoadOptions& /*options*/) {
  const Json scene = ReadScene(file);
  OtherFile info{.format = "GLB"};
  try {
    std::vector<std::string> nodes;
    for (const Json& node : scene.value("nodes", Json::array())) {
      nodes.push_back(node.value("name", std::string("(without a name)")));
    }
    const std::size_t animations = scene.value("animations", Json::array()).size();
    const std::string maker = scene.at("asset").value("generator", std::string());
    const double last_s = LastTime(scene);
    info.lines = {{"made by", maker},
                  {"nodes", fmt::format("{}: {}", nodes.size(), fmt::join(nodes, ", "))},
                  {"animation", animations == 0 ? "none" : fmt::format("{:.3f} s", last_s)}};
    info.contents = {{"generator", maker},
                     {"nodes", nodes},
                     {"animations", animations},
                     {"last_time_s", last_s},
                     {"rate_hz", NoteOf(scene, "rate_hz")},
                     {"first_frame", nullptr}};
    const Json rate = NoteOf(scene, "rate_hz");
    if (rate.is_number())
      info.lines.emplace_back("rate", fmt::format("{:g} Hz", rate.get<double>()));
    const Json first = NoteOf(scene, "first_frame");
    if (first.is_number() && std::abs(first.get<double>()) < 1e15) {
      const std::int64_t number = std::llround(first.get<double>());
      info.contents["first_frame"] = number;
      info.lines.emplace_back("frames", fmt::format("numbered from {}", number));
    }
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("holds a scene that breaks glTF's rules: {}", error.what()), {file});
  }
  return info;
}

struct Reader {
  std::string_view extension;
  OtherFile (*read)(const fs::path& file, const LoadOptions& options);
};

constexpr std::array kReaders = {Reader{".asf", &ReadSkeleton}, Reader{".mnm", &ReadNames},
                                 Reader{".mot", &ReadTable},    Reader{".sto", &ReadTable},
                                 Reader{".glb", &ReadGlb},      Reader{".csv", &ReadCsvTable}};

const Reader* FindReader(const fs::path& file) {
  const std::string extension = ToLower(file.extension().string());
  const auto* const found = std::ranges::find(kReaders, extension, &Reader::extension);
  return found == kReaders.end() ? nullptr : found;
}

}  // namespace

bool IsOtherFile(const fs::path& file) { return FindReader(file) != nullptr; }

std::string OtherEndings() {
  std::string endings;
  for (const Reader& reader : kReaders) {
    endings.append(endings.empty() ? "" : ", ").append(reader.extension);
  }
  return endings;
}

OtherFile ReadOtherFile(const fs::path& file, const LoadOptions& options) {
  const Reader* const reader = FindReader(file);
  if (reader == nullptr) throw Error(ErrorCode::kInvalidArgument, "has no known ending", {file});
  std::error_code unreachable;
  if (!fs::exists(file, unreachable)) throw Error(ErrorCode::kNotFound, "does not exist", {file});
  try {
    return reader->read(file, options);
  } catch (const Error& error) {
    if (!error.place().file.empty()) throw;
    throw Error(error.code(), error.message(), {file});
  }
}

}  // namespace kinebase::cli
