#include "motion/record_loss.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/c3d_motion.h"

namespace kinebase::internal {
namespace {

using Contents = std::vector<std::string>;
using Carried = std::initializer_list<Extra>;

bool Carries(Carried carried, Extra extra) {
  return std::ranges::find(carried, extra) != carried.end();
}

// Parameters that say how a group's things are stored or numbered, and are not lost with them.
struct GroupOfTheFormat {
  std::string_view name;
  std::vector<std::string_view> parameters;  // Empty: all.
};

const GroupOfTheFormat* FindGroupOfTheFormat(std::string_view name) {
  static const std::array<GroupOfTheFormat, 6> kGroups = {{
      {"POINT",
       {"USED", "SCALE", "RATE", "DATA_START", "FRAMES", "LONG_FRAMES", "UNITS", "LABELS",
        "X_SCREEN", "Y_SCREEN"}},
      {"TRIAL", {"ACTUAL_START_FIELD", "ACTUAL_END_FIELD"}},
      {"ANALOG", {}},
      {"FORCE_PLATFORM", {}},
      {"EVENT", {}},
      {"EVENT_CONTEXT", {}},
  }};
  const auto* const found = std::ranges::find_if(
      kGroups, [&](const GroupOfTheFormat& each) { return EqualsIgnoringCase(each.name, name); });
  return found == kGroups.end() ? nullptr : found;
}

bool IsOfTheFormat(const GroupOfTheFormat& group, const C3dParameter& parameter) {
  if (group.parameters.empty()) return true;
  // LABELS2 and so on hold those beyond the 255th.
  const std::string_view name = parameter.name;
  const std::string_view stem = name.substr(0, name.find_last_not_of("0123456789") + 1);
  return std::ranges::any_of(group.parameters,
                             [&](std::string_view each) { return EqualsIgnoringCase(each, stem); });
}

// A text that is there and blank, as descriptions mostly are.
bool IsBlank(const C3dParameter& parameter) {
  if (parameter.size() == 0) return true;
  const std::vector<std::string> texts = parameter.Strings();
  return !texts.empty() && std::ranges::all_of(texts, &std::string::empty);
}

// "POINT (DESCRIPTIONS, MOVIE_ID and 3 more)", if there are any.
void AppendOthers(const C3dGroup& group, const GroupOfTheFormat& known, Contents& groups) {
  constexpr std::size_t kMostNamed = 2;
  Contents names;
  for (const C3dParameter& parameter : group.parameters) {
    if (!IsOfTheFormat(known, parameter) && !IsBlank(parameter)) names.push_back(parameter.name);
  }
  if (names.empty()) return;
  const std::size_t named = std::min(names.size(), kMostNamed);
  const std::size_t more = names.size() - named;
  names.resize(named);
  groups.push_back(fmt::format("{} ({}{})", group.name, fmt::join(names, ", "),
                               more > 0 ? fmt::format(" and {} more", more) : ""));
}

Contents ContentsOf(const C3dRecording& c3d, Carried carried) {
  Contents contents;
  if (c3d.channel_count > 0 && !Carries(carried, Extra::kAnalog)) {
    contents.push_back(fmt::format("{} analog channels", c3d.channel_count));
  }
  const std::size_t events = Events(c3d).size();
  if (events > 0) contents.push_back(fmt::format("{} events", events));
  const std::size_t plates = ForcePlates(c3d).size();
  if (plates > 0 && !Carries(carried, Extra::kForcePlates)) {
    contents.push_back(fmt::format("{} force plates", plates));
  }
  if (c3d.point_count > 0) contents.emplace_back("residuals");
  const std::size_t other_points = c3d.point_count - PlacesAmongPoints(c3d).size();
  if (other_points > 0) {
    contents.push_back(fmt::format("{} points that are angles, forces and the like", other_points));
  }
  Contents groups;
  for (const C3dGroup& group : c3d.groups) {
    if (FindGroupOfTheFormat(group.name) == nullptr && !group.parameters.empty()) {
      groups.push_back(group.name);
    }
  }
  for (const C3dGroup& group : c3d.groups) {
    const GroupOfTheFormat* known = FindGroupOfTheFormat(group.name);
    if (known != nullptr) AppendOthers(group, *known, groups);
  }
  if (!groups.empty()) {
    contents.push_back(fmt::format("parameters of {}", fmt::join(groups, ", ")));
  }
  return contents;
}

Contents ContentsOf(const CsmRecording& csm, Carried /*carried*/) {
  Contents contents;
  if (csm.talent) contents.emplace_back("the performer's sizes");
  if (csm.spine_links) contents.emplace_back("the number of spine links");
  if (!csm.actor.empty()) contents.emplace_back("the performer's name");
  if (!csm.capture_date.empty() || !csm.capture_time.empty()) {
    contents.emplace_back("date and time");
  }
  if (!csm.comments.empty()) contents.emplace_back("comments");
  for (const CsmUnknownSection& section : csm.unknown_sections) {
    contents.push_back('$' + section.title);
  }
  return contents;
}

bool HasUnknownLines(const AsfSkeleton& asf) {
  return !asf.unknown_units.empty() || !asf.unknown_root.empty() || !asf.unknown_sections.empty() ||
         std::ranges::any_of(asf.bones, [](const AsfBone& bone) { return !bone.unknown.empty(); });
}

// A keyword that says how the numbers are meant, as the reader took them.
bool IsUnderstood(std::string_view keyword) {
  constexpr std::array<std::string_view, 4> kKeywords = {":fully-specified", ":degrees", ":radians",
                                                         ":force-all-joints-be-3dof"};
  return std::ranges::any_of(
      kKeywords, [&](std::string_view each) { return EqualsIgnoringCase(each, keyword); });
}

bool IsUnknown(std::string_view line) {
  const std::vector<std::string_view> words = SplitTokens(line.substr(0, line.find('#')));
  return !std::ranges::all_of(words, IsUnderstood);
}

Contents ContentsOf(const SkeletonSource& source) {
  Contents contents;
  if (!source.documentation.empty()) contents.emplace_back("the skeleton's documentation");
  if (source.mass_unit.value_or(1) != 1) contents.emplace_back("its unit of mass");
  return contents;
}

Contents ContentsOf(const AcclaimRecord& record, Carried /*carried*/) {
  Contents contents;
  std::vector<std::string> lines = record.amc.header;
  for (const AmcMotion::Remark& remark : record.amc.remarks) lines.push_back(remark.text);
  const auto has_comment = [](const std::string& line) { return line.find('#') != line.npos; };
  if (!record.asf.comments.empty() || std::ranges::any_of(lines, has_comment)) {
    contents.emplace_back("comments");
  }
  if (HasUnknownLines(record.asf)) {
    contents.emplace_back("lines of the ASF that are not understood");
  }
  if (std::ranges::any_of(lines, IsUnknown)) {
    contents.emplace_back("lines of the AMC that are not understood");
  }
  return contents;
}

bool HasUnknownLines(const BvhJoint& joint) {
  return !joint.unknown.empty() || std::ranges::any_of(joint.end_sites, [](const auto& site) {
    return !site.unknown.empty();
  });
}

Contents ContentsOf(const BvhMotion& bvh, Carried /*carried*/) {
  Contents contents;
  const auto roots = std::ranges::count(bvh.joints, -1, &BvhJoint::parent);
  if (roots > 1) contents.push_back(fmt::format("other figures of the file: {}", roots - 1));
  if (!bvh.unknown.empty() ||
      std::ranges::any_of(bvh.joints, [](const auto& joint) { return HasUnknownLines(joint); })) {
    contents.emplace_back("lines that are not understood");
  }
  return contents;
}

Contents ContentsOf(const TrcRecording& trc, Carried /*carried*/) {
  Contents contents;
  for (const TrcField& field : trc.other_fields) {
    contents.push_back(fmt::format("field '{}'", field.name));
  }
  return contents;
}

}  // namespace

void ReportRecordLoss(const Recording& recording, std::string_view format, Diagnostics& diagnostics,
                      std::initializer_list<Extra> carried) {
  Contents contents;
  if (recording.has_skeleton() && !Carries(carried, Extra::kSkeletonSource)) {
    contents = ContentsOf(recording.motion.skeleton->source());
  }
  if (recording.record != nullptr && recording.format != format) {
    std::ranges::copy(std::visit([&](const auto& record) { return ContentsOf(record, carried); },
                                 *recording.record),
                      std::back_inserter(contents));
  }
  if (contents.empty()) return;
  diagnostics.push_back(
      {Severity::kInfo, fmt::format("{} has no place for: {}", format, fmt::join(contents, ", "))});
}

namespace {

// "inch / 0.45" is several words.
std::string QuotedForShell(std::string_view word) {
  return word.find(' ') == word.npos ? std::string(word) : fmt::format("\"{}\"", word);
}

}  // namespace

void ReportUntold(const Untold& untold, std::string_view format, Diagnostics& diagnostics) {
  std::string options;
  if (untold.up) options += " --source-up " + ToLower(ToString(*untold.up));
  if (!untold.units.empty()) {
    options += fmt::format(" --source-units {}", QuotedForShell(untold.units));
  }
  if (options.empty()) return;
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("{} cannot tell what it is in; read this file with{}", format, options)});
}

}  // namespace kinebase::internal
