#include <span>
#include <string>

#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/asf.h"

namespace kinebase {
namespace {

void AppendNumbers(std::string& out, std::span<const double> values) {
  for (const double value : values) {
    out += ' ';
    AppendShortestText(out, value);
  }
}

void AppendUnknown(std::string& out, std::string_view indent, std::span<const AsfUnknown> unknown) {
  for (const auto& line : unknown) out.append(indent).append(line.text) += '\n';
}

void AppendUnits(std::string& out, const AsfSkeleton& asf) {
  out += ":units\n";
  if (asf.mass_unit) out += "  mass " + ToShortestText(*asf.mass_unit) + '\n';
  if (asf.length_unit) out += "  length " + ToShortestText(*asf.length_unit) + '\n';
  out += asf.angle_is_degrees ? "  angle deg\n" : "  angle rad\n";
  AppendUnknown(out, "  ", asf.unknown_units);
}

void AppendRoot(std::string& out, const AsfSkeleton& asf) {
  out += ":root\n  order";
  for (const AsfDof dof : asf.root_order) out.append(" ").append(ToString(dof));
  out += "\n  axis " + asf.root_axis + "\n  position";
  AppendNumbers(out, asf.root_position);
  out += "\n  orientation";
  AppendNumbers(out, asf.root_orientation);
  out += '\n';
  AppendUnknown(out, "  ", asf.unknown_root);
}

void AppendBone(std::string& out, const AsfBone& bone) {
  out += "  begin\n";
  if (bone.id) out += "    id " + std::to_string(*bone.id) + '\n';
  out += "    name " + bone.name + "\n    direction";
  AppendNumbers(out, bone.direction);
  out += "\n    length " + ToShortestText(bone.length) + "\n    axis";
  AppendNumbers(out, bone.axis);
  out += ' ' + bone.axis_order + '\n';
  if (!bone.dofs.empty()) {
    out += "    dof";
    for (const AsfDof dof : bone.dofs) out.append(" ").append(ToLower(ToString(dof)));
    out += '\n';
  }
  // Before the limits, which any line that begins with a parenthesis would go on with.
  AppendUnknown(out, "    ", bone.unknown);
  for (std::size_t i = 0; i < bone.limits.size(); ++i) {
    out += i == 0 ? "    limits (" : "           (";
    AppendShortestText(out, bone.limits[i].low);
    out += ' ';
    AppendShortestText(out, bone.limits[i].high);
    out += ")\n";
  }
  out += "  end\n";
}

}  // namespace

std::string FormatAsf(const AsfSkeleton& asf) {
  std::string out;
  for (const auto& comment : asf.comments) out += comment + '\n';
  if (!asf.version.empty()) out += ":version " + asf.version + '\n';
  if (!asf.name.empty()) out += ":name " + asf.name + '\n';
  AppendUnits(out, asf);
  if (!asf.documentation.empty()) {
    out += ":documentation\n";
    for (const auto& line : asf.documentation) out += line + '\n';
  }
  AppendRoot(out, asf);
  out += ":bonedata\n";
  for (const auto& bone : asf.bones) AppendBone(out, bone);
  out += ":hierarchy\n  begin\n";
  for (const auto& family : asf.hierarchy) {
    out += "    " + family.parent;
    for (const auto& child : family.children) out += ' ' + child;
    out += '\n';
  }
  out += "  end\n";
  for (const auto& section : asf.unknown_sections) out += section.text + '\n';
  return out;
}

}  // namespace kinebase
