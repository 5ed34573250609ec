// Template files: JSON with "format": "kinebase-template" and a version; docs/template-file.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kinebase/core/output_file.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// Errors  MalformedFile naming the field; Mismatch for a version newer than this program's.
[[nodiscard]] MotionTemplate ParseTemplate(std::string_view json,
                                           const std::filesystem::path& file);
[[nodiscard]] MotionTemplate ReadTemplate(const std::filesystem::path& path);

// ParseTemplate(FormatTemplate(t)) == t, to the last bit.
[[nodiscard]] std::string FormatTemplate(const MotionTemplate& motion_template);
void WriteTemplate(const MotionTemplate& motion_template, const std::filesystem::path& path,
                   Overwrite overwrite);

}  // namespace kinebase
