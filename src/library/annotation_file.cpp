#include "kinebase/library/annotation_file.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string_view>

#include "fmt/format.h"
#include "formats/unicode.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

// The columns of either form of table.
struct LabelColumns {
  std::size_t file = 0;
  std::size_t label = 0;
  std::size_t first = 0;
  std::size_t last = 0;
};

LabelColumns FindColumns(const CsvTable& table) {
  if (table.FindColumn("trial")) {
    return {table.Column("trial"), table.Column("label"), table.Column("first_frame_1based"),
            table.Column("last_frame_1based")};
  }
  return {table.Column("file"), table.Column("class"), table.Column("first_frame"),
          table.Column("last_frame")};
}

std::int64_t ParseFrame(const std::string& text, const Place& place) {
  const auto frame = ParseInteger(Trim(text));
  if (frame && *frame >= 1) return *frame;
  throw Error(ErrorCode::kMalformedFile,
              fmt::format("frame {}; expected a whole number from 1", Quoted(text)), place);
}

// What XML 1.0 has no place for, not even as a reference, becomes a space, and bytes that are not
// UTF-8 become U+FFFD: names of files can hold both.
std::string XmlText(std::string_view text) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::string clean;
  while (!text.empty()) {
    const char32_t c = internal::TakeCharacter(text).value_or(kReplacement);
    internal::AppendUtf8(clean, c < 0x20 || c == 0xFFFE || c == 0xFFFF ? U' ' : c);
  }
  return EscapeXml(clean);
}

struct Milliseconds {
  std::int64_t start = 0;
  std::int64_t end = 0;
};

Milliseconds TimesOf(const TierSegment& segment) {
  constexpr double kMillisecondsPerSecond = 1000;
  const std::int64_t start = std::llround(segment.start_s * kMillisecondsPerSecond);
  const std::int64_t end = std::llround(segment.end_s * kMillisecondsPerSecond);
  return {start, std::max(end, start + 1)};
}

void CheckTiers(std::span<const AnnotationTier> tiers) {
  std::set<std::string_view> names;
  for (const AnnotationTier& tier : tiers) {
    if (!names.insert(tier.name).second) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("two tiers have the name {}", Quoted(tier.name)));
    }
    std::int64_t end = 0;
    for (const TierSegment& segment : tier.segments) {
      const Milliseconds times = TimesOf(segment);
      if (segment.end_s < segment.start_s || times.start < end) {
        throw Error(ErrorCode::kInvalidArgument,
                    fmt::format("tier {} has a segment from {} to {} s that runs backwards or into "
                                "the one before; segments of a tier follow each other",
                                Quoted(tier.name), segment.start_s, segment.end_s));
      }
      end = times.end;
    }
  }
}

// The numbers from 1 of time slots that stand in the order of their times.
std::vector<std::size_t> SlotNumbers(std::span<const std::int64_t> times) {
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return times[i]; });
  std::vector<std::size_t> numbers(times.size());
  for (std::size_t i = 0; i < order.size(); ++i) numbers[order[i]] = i + 1;
  return numbers;
}

constexpr std::string_view kElanHead =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<ANNOTATION_DOCUMENT AUTHOR="kinebase" DATE="{}" FORMAT="3.0" VERSION="3.0"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xsi:noNamespaceSchemaLocation="http://www.mpi.nl/tools/elan/EAFv3.0.xsd">
  <HEADER MEDIA_FILE="" TIME_UNITS="milliseconds">
    <PROPERTY NAME="lastUsedAnnotationId">{}</PROPERTY>
    <PROPERTY NAME="recording">{}</PROPERTY>
  </HEADER>
)";

// The type that all tiers are of.
constexpr std::string_view kElanTail =
    R"(  <LINGUISTIC_TYPE GRAPHIC_REFERENCES="false" LINGUISTIC_TYPE_ID="motion" TIME_ALIGNABLE="true"/>
</ANNOTATION_DOCUMENT>
)";

}  // namespace

std::string RecordingName(const fs::path& file) { return file.stem().string(); }

std::vector<SegmentLabel> ReadSegmentLabels(const fs::path& path) {
  return ParseSegmentLabels(MappedFile(path).text(), path);
}

std::vector<SegmentLabel> ParseSegmentLabels(std::string_view text, const fs::path& path) {
  const CsvTable table = ParseCsv(text, path);
  const LabelColumns columns = FindColumns(table);
  std::vector<SegmentLabel> labels;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<std::string>& row = table.rows[i];
    const Place place{path, table.lines[i]};
    SegmentLabel label{.recording = RecordingName(row[columns.file]),
                       .label = row[columns.label],
                       .first_frame = ParseFrame(row[columns.first], place),
                       .last_frame = ParseFrame(row[columns.last], place),
                       .line = table.lines[i],
                       .file = row[columns.file]};
    if (label.last_frame < label.first_frame) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("the last frame, {}, comes before the first, {}", label.last_frame,
                              label.first_frame),
                  place);
    }
    labels.push_back(std::move(label));
  }
  return labels;
}

std::string FormatElan(std::span<const AnnotationTier> tiers, const ElanOptions& options) {
  CheckTiers(tiers);
  std::vector<std::int64_t> times;  // Start and end of every annotation.
  for (const AnnotationTier& tier : tiers) {
    for (const TierSegment& segment : tier.segments) {
      const Milliseconds at = TimesOf(segment);
      times.insert(times.end(), {at.start, at.end});
    }
  }
  const std::vector<std::size_t> slots = SlotNumbers(times);
  std::string rows;
  std::size_t annotation = 0;
  for (const AnnotationTier& tier : tiers) {
    rows +=
        fmt::format("  <TIER LINGUISTIC_TYPE_REF=\"motion\" TIER_ID=\"{}\">\n", XmlText(tier.name));
    for (const TierSegment& segment : tier.segments) {
      rows += fmt::format(
          "    <ANNOTATION>\n"
          "      <ALIGNABLE_ANNOTATION ANNOTATION_ID=\"a{}\" TIME_SLOT_REF1=\"ts{}\" "
          "TIME_SLOT_REF2=\"ts{}\">\n"
          "        <ANNOTATION_VALUE>{}</ANNOTATION_VALUE>\n"
          "      </ALIGNABLE_ANNOTATION>\n"
          "    </ANNOTATION>\n",
          annotation + 1, slots[2 * annotation], slots[2 * annotation + 1], XmlText(segment.text));
      ++annotation;
    }
    rows += "  </TIER>\n";
  }
  std::ranges::sort(times);
  std::string order;
  for (std::size_t i = 0; i < times.size(); ++i) {
    order +=
        fmt::format("    <TIME_SLOT TIME_SLOT_ID=\"ts{}\" TIME_VALUE=\"{}\"/>\n", i + 1, times[i]);
  }
  return fmt::format(fmt::runtime(kElanHead), XmlText(options.date), annotation,
                     XmlText(options.recording.filename().string())) +
         "  <TIME_ORDER>\n" + order + "  </TIME_ORDER>\n" + rows + std::string(kElanTail);
}

}  // namespace kinebase
