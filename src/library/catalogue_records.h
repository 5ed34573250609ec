// Stored templates and annotations as rows of a catalogue. Internal.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinebase/library/library_annotations.h"
#include "kinebase/library/library_templates.h"
#include "library/catalogue.h"

namespace kinebase::internal {

[[nodiscard]] std::int64_t SecondsSince1970();

// Inside of one transaction; none for version 1.
[[nodiscard]] std::vector<StoredTemplate> TemplateRows(const Catalogue& catalogue);

struct AnnotationOfTake {
  std::int64_t take = 0;
  StoredAnnotation annotation;  // Without its path.
};
[[nodiscard]] std::vector<AnnotationOfTake> AnnotationRows(const Catalogue& catalogue);
[[nodiscard]] std::string NameOf(const AnnotationOfTake& row);  // As messages have it.

// Inside of a transaction that writes: adds a row, or replaces that of the same key.
void RemoveTemplate(const Catalogue& catalogue, const std::string& name);
void PutTemplate(const Catalogue& catalogue, const StoredTemplate& stored);
void PutAnnotation(const Catalogue& catalogue, const AnnotationOfTake& row);
// Keeps of a take's annotations what lies within its frames.
void CutAnnotations(const Catalogue& catalogue, std::int64_t take, std::int64_t frames);
void RemoveAnnotation(const Catalogue& catalogue, const AnnotationOfTake& row);

// Those whose rows are not what was written, as messages name them.
[[nodiscard]] std::vector<std::string> DamagedRecords(const Catalogue& catalogue);
// Inside of a transaction that writes. Gives what was removed.
std::vector<std::string> RemoveDamagedRecords(const Catalogue& catalogue);

}  // namespace kinebase::internal
