// What a recording holds beyond places and rotations, for formats that carry only these.
#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>

#include "kinebase/core/diagnostic.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

// What some formats carry of records that are not their own.
enum class Extra { kAnalog, kForcePlates, kSkeletonSource };

// diagnostics  One if the record has something that files of `format` have no place for: analog
//              channels, events, residuals, the performer's sizes, comments, lines that the reader
//              does not know. A record of that very format has its place.
void ReportRecordLoss(const Recording& recording, std::string_view format, Diagnostics& diagnostics,
                      std::initializer_list<Extra> carried = {});

// What a file that was written does not tell and its reader would take for something else.
struct Untold {
  std::optional<UpAxis> up;
  std::string_view units;
};

// diagnostics  One if there is something: the options that read the file right.
void ReportUntold(const Untold& untold, std::string_view format, Diagnostics& diagnostics);

}  // namespace kinebase::internal
