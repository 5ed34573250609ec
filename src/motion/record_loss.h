// What a file's record holds beyond places and rotations, for formats that carry only these.
#pragma once

#include <string_view>

#include "kinebase/core/diagnostic.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

// diagnostics  One if the record has something that files of `format` have no place for: analog
//              channels, events, residuals, the performer's sizes, comments.
void ReportRecordLoss(const Recording& recording, std::string_view format,
                      Diagnostics& diagnostics);

}  // namespace kinebase::internal
