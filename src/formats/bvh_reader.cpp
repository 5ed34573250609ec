// Reads BVH: the hierarchy in bvh_hierarchy.cpp, the frames in bvh_frames.cpp.

#include "formats/bvh_reader.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"

namespace kinebase {
namespace internal {

BvhContext::BvhContext(std::string_view whole_text, const std::filesystem::path& file,
                       const BvhReadOptions& read_options)
    : lines(whole_text), text(whole_text), options(read_options), file_(file) {
  bvh.file_name = file.filename().string();
}

void BvhContext::Fail(const std::string& message, std::int64_t line) const {
  throw Error(ErrorCode::kMalformedFile, message, {file_, line});
}

void BvhContext::Fail(const std::string& message) const { Fail(message, lines.line_number()); }

void BvhContext::Unexpected(const std::string& expected, std::string_view found) const {
  if (HasBinary(found)) Fail("holds binary data; expected the text of a BVH file");
  if (found.empty()) Fail("expected " + expected + ", found the end of the line");
  Fail("expected " + expected + ", found " + Quoted(found));
}

void BvhContext::Warn(std::string message, std::int64_t line, Severity severity) {
  bvh.diagnostics.push_back({severity, std::move(message), line});
}

void BvhContext::CountUnknown(std::string_view line) {
  if (unknown_count_++ > 0) return;
  first_unknown_ = std::string(line);
  first_unknown_line_ = lines.line_number();
}

void BvhContext::ReportUnknown() {
  if (unknown_count_ == 0) return;
  const std::string others =
      unknown_count_ == 1 ? "" : fmt::format(" and {} more", unknown_count_ - 1);
  Warn("not understood, kept as it is: " + Quoted(first_unknown_) + others, first_unknown_line_);
}

bool HasBinary(std::string_view text) {
  return std::ranges::any_of(text, [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && !(c >= '\t' && c <= '\r');
  });
}

}  // namespace internal

namespace {

constexpr std::array<std::string_view, 6> kChannelNames = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};

bool SameValue(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

std::string_view ToString(BvhChannel channel) {
  return kChannelNames[static_cast<std::size_t>(channel)];
}

double SnapRate(double frame_time_s) {
  constexpr double kVideoTolerance = 2e-5;
  constexpr double kTolerance = 1e-3 + 1e-9;  // 0.0333 is 30 Hz, just so.
  for (const double frames : {24, 30, 60, 120}) {
    const double rate = frames * 1000 / 1001;
    if (std::abs(frame_time_s * rate - 1) <= kVideoTolerance) return rate;
  }
  for (const double step : {1.0, 0.5}) {
    const double rate = std::round(1 / frame_time_s / step) * step;
    if (std::abs(frame_time_s * rate - 1) <= kTolerance) return rate;
  }
  return 1 / frame_time_s;
}

BvhMotion ParseBvh(std::string_view text, const std::filesystem::path& file,
                   const BvhReadOptions& options) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected a BVH motion", {file});
  }
  internal::BvhContext context(text, file, options);
  internal::ReadBvhHierarchy(context);
  internal::ReadBvhFrames(context);
  context.ReportUnknown();
  return std::move(context.bvh);
}

BvhMotion ReadBvh(const std::filesystem::path& path, const BvhReadOptions& options) {
  const MappedFile file(path);
  return ParseBvh(file.text(), path, options);
}

bool operator==(const BvhJoint& a, const BvhJoint& b) {
  return a.name == b.name && a.parent == b.parent && a.offset == b.offset &&
         a.channels == b.channels && a.first_column == b.first_column &&
         a.end_sites == b.end_sites && a.unknown == b.unknown;
}

bool operator==(const BvhMotion& a, const BvhMotion& b) {
  return a.joints == b.joints && a.column_count == b.column_count &&
         a.declared_frame_count == b.declared_frame_count &&
         a.frame_time_text == b.frame_time_text && a.unknown == b.unknown &&
         std::ranges::equal(a.values, b.values, SameValue);
}

}  // namespace kinebase
