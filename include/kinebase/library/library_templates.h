// Motion templates that are kept in a library on disk, beside the takes that they are searched in.
//
// Read library/take_library.h and templates/motion_template.h first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// What the catalogue knows of a template.
struct StoredTemplate {
  std::string name;  // Of the template; no two have the same.
  std::string json;  // As FormatTemplate writes it.
  std::uint64_t feature_set_hash = 0;
  std::int64_t stored_s = 0;  // When; seconds since 1970, UTC.
  bool is_intact = true;      // Whether this is what was written, by its checksum.
};

// Errors of all: those of TakeLibrary; of those that change something IoFailure if somebody else is
// writing. A change is made whole or not at all, whatever happens.

// By name. None for a library of version 1.
[[nodiscard]] std::vector<StoredTemplate> ListTemplates(const std::filesystem::path& library);

// One of a list. Errors  MalformedFile if it is damaged.
[[nodiscard]] MotionTemplate ParseStoredTemplate(const StoredTemplate& stored,
                                                 const std::filesystem::path& library);

// Errors  NotFound, naming those that there are; MalformedFile if it is damaged.
[[nodiscard]] MotionTemplate LoadTemplate(const std::filesystem::path& library,
                                          const std::string& name);

// The template of a file; where there is none, or a folder, that of this name in the library, if
// one is given. Errors  Those of ReadTemplate and LoadTemplate.
[[nodiscard]] MotionTemplate ReadOrLoadTemplate(const std::filesystem::path& file_or_name,
                                                const std::filesystem::path& library);

// Errors  InvalidArgument for one without a name, two of one name, and a name that is taken unless
//         `overwrite` says otherwise.
void StoreTemplates(const std::filesystem::path& library, std::span<const MotionTemplate> templates,
                    Overwrite overwrite);

// Errors  NotFound, naming those that there are.
void RemoveTemplates(const std::filesystem::path& library, std::span<const std::string> names);

}  // namespace kinebase
