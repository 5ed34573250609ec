// What fills OpenSim's tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/formats/c3d.h"
#include "kinebase/formats/sto.h"

namespace kinebase::internal {

struct StoColumn {
  std::string label;
  std::vector<double> values;  // [row]
};

// A name as a table can hold it: blanks become '_'.
std::string StoLabel(std::string_view name);

// Puts columns as long as the table's times into it.
void SetColumns(StoTable& table, std::span<const StoColumn> columns);

// The time of each analog sample. Frame 1 is at 0.
std::vector<double> AnalogTimes(const C3dRecording& recording);

}  // namespace kinebase::internal
