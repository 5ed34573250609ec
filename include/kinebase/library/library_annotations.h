// Annotations that are kept in a library on disk: what templates found in its takes.
//
// Read library/take_library.h and library/annotation.h first. Labels (library/library_labels.h) are
// what people say of takes; annotations come with a cost and a template, and go when either is
// found to be wrong.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/take_choice.h"

namespace kinebase {

struct StoredAnnotation {
  std::filesystem::path path;  // Of the take.
  std::string class_name;
  std::int64_t first_frame = 0;  // From 1, inclusive.
  std::int64_t last_frame = 0;
  std::optional<double> cost;
  std::optional<double> confidence;
  std::string template_name;           // That found it; empty: not known.
  std::uint64_t feature_set_hash = 0;  // Of the template, where the library holds it; else 0.
  std::int64_t stored_s = 0;           // When; seconds since 1970, UTC.
  bool is_intact = true;               // Whether this is what was written, by its checksum.
};

// Annotations as `kinebase annotate --format csv` writes them: columns file, class, first_frame,
// last_frame, and if they are there cost, confidence and template. Stretches of no class
// ("unknown") are passed over.
struct AnnotationRow {
  StoredAnnotation annotation;  // The path as it stands in the table.
  std::int64_t line = 0;
};
// Errors  MalformedFile with the line.
[[nodiscard]] std::vector<AnnotationRow> ParseAnnotationTable(std::string_view text,
                                                              const std::filesystem::path& file);
// The table again, with the columns start_s and end_s.
// takes  To which the annotations belong.
[[nodiscard]] std::string FormatAnnotationTable(std::span<const StoredAnnotation> annotations,
                                                std::span<const StoredTake> takes);

struct AnnotationReport {
  std::int64_t stored = 0;
  std::int64_t passed_over = 0;  // Rows whose recording is not among the takes.
};

// Errors of all: those of TakeLibrary and ChooseTakes; of those that change something IoFailure if
// somebody else is writing, MalformedFile for a take or an annotation whose row is damaged. A
// change is made whole or not at all, whatever happens.

// None for a library of version 1.
struct AnnotationList {
  std::vector<StoredAnnotation> annotations;  // By path, first frame and class; all intact.
  // Takes and annotations that are not, whatever was chosen; without a path where it is not known.
  std::vector<TakeFailure> failures;
};
[[nodiscard]] AnnotationList ListAnnotations(const std::filesystem::path& library,
                                             const TakeChoice& choice);

// Adds the rows to the chosen takes that they name, by path or by the name of the file. One of the
// same stretch, class and template is replaced. A row without a template has that of the library
// that is called as the class is, for annotate calls classes so.
//
// table   For messages.
// Errors  NotFound if no row is of any of the takes; InvalidArgument with the line for a name that
//         several takes have, and for a stretch that leaves its take.
AnnotationReport StoreAnnotations(const std::filesystem::path& library, const TakeChoice& choice,
                                  std::span<const AnnotationRow> rows,
                                  const std::filesystem::path& table);

// How many were removed: those of the chosen takes, and of these classes (none given: all).
std::int64_t RemoveAnnotations(const std::filesystem::path& library, const TakeChoice& choice,
                               std::span<const std::string> classes);

}  // namespace kinebase
