// Reads ASF line by line. A line that starts with ':' opens a section; each section has a method
// that takes one line at a time, so that sections may come in any order.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"

namespace kinebase {
namespace {

constexpr std::array<std::string_view, 7> kDofNames = {"TX", "TY", "TZ", "RX", "RY", "RZ", "L"};

std::optional<AsfDof> ParseDof(std::string_view token) {
  for (std::size_t i = 0; i < kDofNames.size(); ++i) {
    if (EqualsIgnoringCase(token, kDofNames[i])) return static_cast<AsfDof>(i);
  }
  return std::nullopt;
}

class AsfParser {
 public:
  AsfParser(std::string_view text, const std::filesystem::path& file) : lines_(text), file_(file) {
    asf_.file_name = file.filename().string();
  }

  AsfSkeleton Parse() {
    while (lines_.Next()) {
      const std::string_view line = lines_.line();
      if (line.find('\0') != std::string_view::npos) {
        Fail("holds binary data; expected the text of an ASF file");
      }
      const std::string_view trimmed = Trim(line);
      if (trimmed.starts_with(':')) {
        OpenSection(trimmed);
      } else if (section_ == &AsfParser::DocumentationLine) {
        DocumentationLine(line);
      } else {
        TakeLine(line);
      }
    }
    if (in_bone_) Fail(fmt::format("the bone that begins in line {} has no 'end'", bone_.line));
    CheckWhole();
    return std::move(asf_);
  }

 private:
  using SectionHandler = void (AsfParser::*)(std::string_view);

  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, lines_.line_number()});
  }

  void Warn(std::string message, std::int64_t line) {
    asf_.diagnostics.push_back({Severity::kWarning, std::move(message), line});
  }

  void OpenSection(std::string_view line) {
    static const std::unordered_map<std::string, SectionHandler> kSections = {
        {":version", &AsfParser::VersionLine},    {":name", &AsfParser::NameLine},
        {":units", &AsfParser::UnitsLine},        {":documentation", &AsfParser::DocumentationLine},
        {":root", &AsfParser::RootLine},          {":bonedata", &AsfParser::BoneLine},
        {":hierarchy", &AsfParser::HierarchyLine}};
    if (in_bone_) Fail(fmt::format("the bone that begins in line {} has no 'end'", bone_.line));
    std::string_view rest = line;
    const std::string keyword = ToLower(TakeToken(rest));
    const auto known = kSections.find(keyword);
    if (known == kSections.end()) {
      section_ = &AsfParser::UnknownLine;
      asf_.unknown_sections.push_back({std::string(line)});
      return;
    }
    saw_bonedata_ |= keyword == ":bonedata";
    section_ = known->second;
    if (Trim(rest).empty()) return;
    if (Trim(rest).starts_with(':')) Fail("two sections on one line: " + Quoted(line));
    TakeLine(rest);
  }

  // A line inside a section, freed of its comment.
  void TakeLine(std::string_view line) {
    const std::size_t hash = line.find('#');
    if (hash != std::string_view::npos) {
      asf_.comments.emplace_back(Trim(line.substr(hash)));
      line = line.substr(0, hash);
    }
    line = Trim(line);
    if (line.empty()) return;
    if (section_ == nullptr) {
      Fail("expected ':' and a section such as ':version' or a '#' comment, found " + Quoted(line));
    }
    (this->*section_)(line);
  }

  void VersionLine(std::string_view line) { AppendWord(asf_.version, line); }
  void NameLine(std::string_view line) { AppendWord(asf_.name, line); }

  static void AppendWord(std::string& text, std::string_view line) {
    if (!text.empty()) text += ' ';
    text += line;
  }

  void DocumentationLine(std::string_view line) { asf_.documentation.emplace_back(line); }
  void UnknownLine(std::string_view line) {
    asf_.unknown_sections.back().text += '\n';
    asf_.unknown_sections.back().text += line;
  }

  void UnitsLine(std::string_view line) {
    std::string_view rest = line;
    const std::string keyword = ToLower(TakeToken(rest));
    if (keyword == "mass") {
      asf_.mass_unit = Number(rest, "mass");
    } else if (keyword == "length") {
      asf_.length_unit = Number(rest, "length");
      if (!(*asf_.length_unit > 0) || !std::isfinite(*asf_.length_unit)) {
        Fail("':units length' must be a positive number");
      }
    } else if (keyword == "angle") {
      const std::string unit = ToLower(Trim(rest));
      if (unit != "deg" && unit != "rad" && unit != "degrees" && unit != "radians") {
        Fail("':units angle' must be 'deg' or 'rad', found " + Quoted(unit));
      }
      asf_.angle_is_degrees = unit.starts_with("deg");
    } else {
      asf_.unknown_units.push_back({std::string(line)});
    }
  }

  void RootLine(std::string_view line) {
    std::string_view rest = line;
    const std::string keyword = ToLower(TakeToken(rest));
    if (keyword == "order") {
      asf_.root_order = Dofs(rest);
    } else if (keyword == "axis") {
      asf_.root_axis = std::string(Trim(rest));
    } else if (keyword == "position") {
      asf_.root_position = Triple(rest, "position");
    } else if (keyword == "orientation") {
      asf_.root_orientation = Triple(rest, "orientation");
    } else {
      asf_.unknown_root.push_back({std::string(line)});
    }
  }

  void BoneLine(std::string_view line) {
    if (EqualsIgnoringCase(line, "begin")) {
      if (in_bone_) Fail(fmt::format("the bone that begins in line {} has no 'end'", bone_.line));
      bone_ = {};
      bone_.line = lines_.line_number();
      has_direction_ = has_length_ = false;
      in_limits_ = false;
      in_bone_ = true;
    } else if (!in_bone_) {
      Fail("expected 'begin', found " + Quoted(line));
    } else if (EqualsIgnoringCase(line, "end")) {
      CloseBone();
    } else if (line.front() == '(' && in_limits_) {
      TakeLimits(line);
    } else {
      BoneField(line);
    }
  }

  void BoneField(std::string_view line) {
    std::string_view rest = line;
    const std::string keyword = ToLower(TakeToken(rest));
    in_limits_ = keyword == "limits";
    if (keyword == "id") {
      bone_.id = ParseInteger(Trim(rest));
      if (!bone_.id) Fail("'id' must be a whole number, found " + Quoted(Trim(rest)));
    } else if (keyword == "name") {
      bone_.name = std::string(Trim(rest));
      if (SplitTokens(bone_.name).size() > 1) {
        Fail("a bone's name cannot have blanks: " + Quoted(bone_.name));
      }
    } else if (keyword == "direction") {
      bone_.direction = Triple(rest, "direction");
      has_direction_ = true;
    } else if (keyword == "length") {
      bone_.length = Number(rest, "length");
      has_length_ = true;
    } else if (keyword == "axis") {
      for (double& angle : bone_.axis) angle = Number(TakeToken(rest), "axis");
      const std::string_view order = Trim(rest);
      if (!order.empty()) bone_.axis_order = std::string(order);
    } else if (keyword == "dof") {
      bone_.dofs = Dofs(rest);
    } else if (keyword == "limits") {
      TakeLimits(rest);
    } else {
      bone_.unknown.push_back({std::string(line)});
    }
  }

  void CloseBone() {
    in_bone_ = false;
    if (bone_.name.empty()) Fail("a bone without 'name'");
    if (!has_direction_) Fail(fmt::format("bone '{}' has no 'direction'", bone_.name));
    if (!has_length_) Fail(fmt::format("bone '{}' has no 'length'", bone_.name));
    if (EqualsIgnoringCase(bone_.name, "root")) Fail("a bone cannot be named 'root'");
    if (!bone_names_.insert(bone_.name).second) {
      Fail(fmt::format("a second bone named '{}'", bone_.name));
    }
    asf_.bones.push_back(std::move(bone_));
  }

  void HierarchyLine(std::string_view line) {
    if (EqualsIgnoringCase(line, "begin") || EqualsIgnoringCase(line, "end")) return;
    AsfSkeleton::Family family;
    std::string_view rest = line;
    family.parent = std::string(TakeToken(rest));
    if (EqualsIgnoringCase(family.parent, "root")) family.parent = "root";
    for (auto child = TakeToken(rest); !child.empty(); child = TakeToken(rest)) {
      family.children.emplace_back(child);
    }
    family.line = lines_.line_number();
    asf_.hierarchy.push_back(std::move(family));
  }

  double Number(std::string_view text, std::string_view what) const {
    const auto value = ParseDouble(Trim(text));
    if (!value || std::isnan(*value) || std::isinf(*value)) {
      Fail(fmt::format("'{}' needs a number, found {}", what, Quoted(Trim(text))));
    }
    return *value;
  }

  std::array<double, 3> Triple(std::string_view text, std::string_view what) const {
    const auto tokens = SplitTokens(text);
    if (tokens.size() != 3) {
      Fail(fmt::format("'{}' needs three numbers, found {}", what, tokens.size()));
    }
    return {Number(tokens[0], what), Number(tokens[1], what), Number(tokens[2], what)};
  }

  std::vector<AsfDof> Dofs(std::string_view text) const {
    std::vector<AsfDof> dofs;
    for (const auto token : SplitTokens(text)) {
      const auto dof = ParseDof(token);
      if (!dof) Fail("unknown degree of freedom " + Quoted(token) + "; known: tx ty tz rx ry rz l");
      if (std::ranges::find(dofs, *dof) != dofs.end()) {
        Fail("degree of freedom " + Quoted(token) + " stands twice");
      }
      dofs.push_back(*dof);
    }
    return dofs;
  }

  // "(-160.0 20.0) (-70 inf)": any number of pairs.
  void TakeLimits(std::string_view text) {
    text = Trim(text);
    while (!text.empty()) {
      const std::size_t close = text.find(')');
      if (text.front() != '(' || close == std::string_view::npos) {
        Fail("'limits' needs pairs in parentheses such as (-90 90), found " + Quoted(text));
      }
      std::string pair(text.substr(1, close - 1));
      std::ranges::replace(pair, ',', ' ');
      const auto tokens = SplitTokens(pair);
      const auto low = tokens.size() == 2 ? ParseDouble(tokens[0]) : std::nullopt;
      const auto high = tokens.size() == 2 ? ParseDouble(tokens[1]) : std::nullopt;
      if (!low || !high || std::isnan(*low) || std::isnan(*high)) {
        Fail("a limit needs two numbers, found " + Quoted(text.substr(0, close + 1)));
      }
      bone_.limits.push_back({*low, *high});
      text = Trim(text.substr(close + 1));
    }
  }

  // A bone of the hierarchy as ':bonedata' spells it, where they differ in case alone.
  void AdoptSpelling() {
    std::unordered_map<std::string, std::string> spelling;
    for (const auto& bone : asf_.bones) spelling.try_emplace(ToLower(bone.name), bone.name);
    const auto adopt = [&](std::string& name) {
      if (name == "root" || bone_names_.contains(name)) return;
      const auto found = spelling.find(ToLower(name));
      if (found != spelling.end()) name = found->second;
    };
    for (auto& family : asf_.hierarchy) {
      adopt(family.parent);
      std::ranges::for_each(family.children, adopt);
    }
  }

  void CheckWhole() {
    if (!saw_bonedata_ || asf_.bones.empty()) {
      throw Error(
          ErrorCode::kMalformedFile,
          "no bones: expected ':bonedata' with 'begin' … 'end' blocks; is this an ASF file?",
          {file_});
    }
    if (asf_.hierarchy.empty()) {
      throw Error(ErrorCode::kMalformedFile, "no ':hierarchy' section", {file_});
    }
    AdoptSpelling();
    CheckHierarchy();
    if (asf_.root_order.empty()) {
      asf_.root_order = {AsfDof::kTx, AsfDof::kTy, AsfDof::kTz,
                         AsfDof::kRx, AsfDof::kRy, AsfDof::kRz};
      Warn("':root order' is missing; read as TX TY TZ RX RY RZ", 0);
    }
    if (!asf_.length_unit) Warn("':units length' is missing; lengths are read as inches", 0);
  }

  // Every parent is the root or was a child before, every child is a bone and has one parent: this
  // makes cycles impossible.
  void CheckHierarchy() {
    std::set<std::string> placed = {"root"};
    for (const auto& family : asf_.hierarchy) {
      const Place place{file_, family.line};
      if (!placed.contains(family.parent)) {
        throw Error(ErrorCode::kMalformedFile,
                    fmt::format("{} is used as a parent before it was named as a child",
                                Quoted(family.parent)),
                    place);
      }
      for (const auto& child : family.children) {
        if (!bone_names_.contains(child)) {
          throw Error(ErrorCode::kMalformedFile,
                      fmt::format("bone {} is not in ':bonedata'", Quoted(child)), place);
        }
        if (!placed.insert(child).second) {
          throw Error(ErrorCode::kMalformedFile,
                      fmt::format("bone {} has a second parent", Quoted(child)), place);
        }
      }
    }
    for (const auto& bone : asf_.bones) {
      if (!placed.contains(bone.name)) {
        Warn(fmt::format("bone '{}' is not in ':hierarchy'; it takes no part", bone.name),
             bone.line);
      }
    }
  }

  LineScanner lines_;
  const std::filesystem::path& file_;
  SectionHandler section_ = nullptr;
  AsfSkeleton asf_;
  AsfBone bone_;  // The one between 'begin' and 'end'.
  bool in_bone_ = false;
  bool in_limits_ = false;
  bool has_direction_ = false;
  bool has_length_ = false;
  bool saw_bonedata_ = false;
  std::set<std::string> bone_names_;
};

}  // namespace

std::string_view ToString(AsfDof dof) { return kDofNames[static_cast<std::size_t>(dof)]; }

AsfSkeleton ParseAsf(std::string_view text, const std::filesystem::path& file) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected an ASF skeleton", {file});
  }
  return AsfParser(text, file).Parse();
}

AsfSkeleton ReadAsf(const std::filesystem::path& path) {
  const MappedFile file(path);
  return ParseAsf(file.text(), path);
}

bool operator==(const AsfBone& a, const AsfBone& b) {
  return a.id == b.id && a.name == b.name && a.direction == b.direction && a.length == b.length &&
         a.axis == b.axis && a.axis_order == b.axis_order && a.dofs == b.dofs &&
         a.limits == b.limits && a.unknown == b.unknown;
}

bool operator==(const AsfSkeleton& a, const AsfSkeleton& b) {
  return a.comments == b.comments && a.version == b.version && a.name == b.name &&
         a.mass_unit == b.mass_unit && a.length_unit == b.length_unit &&
         a.angle_is_degrees == b.angle_is_degrees && a.unknown_units == b.unknown_units &&
         a.documentation == b.documentation && a.root_order == b.root_order &&
         a.root_axis == b.root_axis && a.root_position == b.root_position &&
         a.root_orientation == b.root_orientation && a.unknown_root == b.unknown_root &&
         a.bones == b.bones && a.hierarchy == b.hierarchy &&
         a.unknown_sections == b.unknown_sections;
}

}  // namespace kinebase
