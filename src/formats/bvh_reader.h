// What the two halves of the BVH reader share: the place in the text, the record, how to complain.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/bvh.h"

namespace kinebase::internal {

class BvhContext {
 public:
  BvhContext(std::string_view whole_text, const std::filesystem::path& file,
             const BvhReadOptions& options);

  LineScanner lines;
  const std::string_view text;
  const BvhReadOptions& options;
  BvhMotion bvh;

  // Throws MalformedFile; without `line` for the current one.
  [[noreturn]] void Fail(const std::string& message, std::int64_t line) const;
  [[noreturn]] void Fail(const std::string& message) const;

  // Fails for what stands in the current line; text that is none gets that as its reason.
  [[noreturn]] void Unexpected(const std::string& expected, std::string_view found) const;

  void Warn(std::string message, std::int64_t line, Severity severity = Severity::kWarning);

  // Lines that are kept but not understood become one diagnostic, however many they are.
  void CountUnknown(std::string_view line);
  void ReportUnknown();

 private:
  const std::filesystem::path& file_;
  std::int64_t unknown_count_ = 0;
  std::string first_unknown_;
  std::int64_t first_unknown_line_ = 0;
};

// Whether a text has bytes that no text has.
[[nodiscard]] bool HasBinary(std::string_view text);

// Reads up to and with the line `MOTION`.
void ReadBvhHierarchy(BvhContext& context);

// Reads what follows: frame count, frame time, values.
void ReadBvhFrames(BvhContext& context);

}  // namespace kinebase::internal
