// Any bytes as a query: templates that can be matched, or one kinebase::QueryError that points into
// the query. What was compiled is written and read again, and has its phases in order.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "kinebase/features/feature_set.h"
#include "kinebase/templates/quantized_template.h"
#include "kinebase/templates/query.h"
#include "kinebase/templates/template_file.h"

namespace {

// Writing long ones takes most of the time and shows nothing new.
constexpr int kMostColumns = 300;

void Check(bool holds) {
  if (!holds) std::abort();
}

const kinebase::FeatureSet& Features() {
  static const kinebase::FeatureSet features = kinebase::LoadFeatureSet("bonn");
  return features;
}

// Another exception than kinebase::QueryError leaves through here and is a finding.
std::optional<kinebase::CompiledQuery> Compile(std::string_view text) {
  try {
    return kinebase::CompileQuery(text, Features(), {.name = "query"});
  } catch (const kinebase::QueryError& error) {
    Check(error.column() >= 1 && error.column() <= static_cast<int>(text.size()) + 1);
    Check(std::ranges::count(error.marked(), '\n') == 1);
    return std::nullopt;
  }
}

void TryTemplate(const kinebase::MotionTemplate& compiled) {
  for (const double value : compiled.matrix.values) {
    Check(value == 0 || value == 1 || value == kinebase::kAnyValue);
  }
  const int columns = compiled.matrix.column_count();
  Check(columns >= 1 && columns <= kinebase::kMostTemplateColumns);
  if (columns > kMostColumns) return;
  Check(kinebase::Quantize(compiled).column_count() == columns);
  Check(kinebase::ParseTemplate(kinebase::FormatTemplate(compiled), "query.json") == compiled);
}

void TryQuery(std::string_view text) {
  const auto query = Compile(text);
  if (!query) return;
  Check(!query->templates.empty() && query->templates.size() <= 2 && !query->phases.empty());
  for (const kinebase::MotionTemplate& compiled : query->templates) TryTemplate(compiled);
  int next = 0;
  for (const kinebase::QueryPhase& phase : query->phases) {
    Check(phase.columns.first == next && phase.columns.last >= phase.columns.first);
    next = phase.columns.last + 1;
  }
  Check(next == query->templates.front().matrix.column_count());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  TryQuery({reinterpret_cast<const char*>(data), size});
  return 0;
}
