// Reads cut files, line by line.

#include "kinebase/library/cut_list.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "library/relative_name.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExpected = "expected \"take\" first last clip";

// The files were made on Windows.
std::string WithSlashes(std::string_view name) {
  std::string text(name);
  std::ranges::replace(text, '\\', '/');
  return text;
}

std::string_view WithoutMotionExtension(std::string_view name) {
  const std::string lower = ToLower(name);
  for (const std::string_view extension : {".amc", ".c3d"}) {
    if (lower.ends_with(extension)) return name.substr(0, name.size() - extension.size());
  }
  return name;
}

// A relative name without extension, or InvalidArgument.
std::string CheckedName(std::string_view text, std::string_view what, const Place& place) {
  const std::string name = WithSlashes(text);
  return internal::CheckedRelativeName(WithoutMotionExtension(name), what, place);
}

// Takes a name off the front: up to the closing quote if it begins with one, else a token. Empty
// optional if the quote is never closed.
std::optional<std::string_view> TakeNamePart(std::string_view& text) {
  text = Trim(text);
  if (!text.starts_with('"')) return TakeToken(text);
  const std::size_t closing = text.find('"', 1);
  if (closing == std::string_view::npos) return std::nullopt;
  const std::string_view name = text.substr(1, closing - 1);
  text.remove_prefix(closing + 1);
  return name;
}

// A line in its parts; numbers are still text.
struct CutLine {
  std::string_view take;
  std::string_view first;
  std::string_view last;
  std::string_view clip;
};

// Errors  MalformedFile with `place`.
CutLine SplitCutLine(std::string_view line, const Place& place) {
  const auto fail = [&](std::string_view what) {
    throw Error(ErrorCode::kMalformedFile, fmt::format("{}; {}", what, kExpected), place);
  };
  std::string_view rest = line;
  CutLine parts;
  const auto take = TakeNamePart(rest);
  if (!take) fail("the quote before the take's name is not closed");
  parts.take = *take;
  parts.first = TakeToken(rest);
  parts.last = TakeToken(rest);
  const auto clip = TakeNamePart(rest);
  if (!clip) fail("the quote before the clip's name is not closed");
  parts.clip = *clip;
  rest = Trim(rest);
  if (parts.clip.empty()) fail("the line ends early");
  if (!rest.empty() && !rest.starts_with('%')) {
    fail(fmt::format("{} follows the clip's name", Quoted(rest)));
  }
  return parts;
}

std::int64_t FrameNumber(std::string_view text, const Place& place) {
  const auto number = ParseInteger(text);
  if (!number) {
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("{} is no frame number; {}", Quoted(text), kExpected), place);
  }
  return *number;
}

Cut ParseCut(std::string_view line, const Place& place) {
  const CutLine parts = SplitCutLine(line, place);
  Cut cut{.first_frame = FrameNumber(parts.first, place),
          .last_frame = FrameNumber(parts.last, place),
          .place = place};
  if (cut.first_frame < 1 || cut.last_frame < cut.first_frame) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("frames {} to {} are no range; frames count from 1, the first stands "
                            "before the last",
                            cut.first_frame, cut.last_frame),
                place);
  }
  cut.take = CheckedName(parts.take, "take", place);
  cut.clip = CheckedName(parts.clip, "clip", place);
  return cut;
}

// Whether a line that does not begin with a quote has all that a cut needs.
bool LooksLikeCut(std::string_view line) {
  line = Trim(line);
  if (line.empty() || line.starts_with('%') || line.starts_with('#')) return false;
  try {
    const CutLine parts = SplitCutLine(line, {});
    return ParseInteger(parts.first) && ParseInteger(parts.last);
  } catch (const Error&) {
    return false;
  }
}

void Append(CutList& list, CutList&& more) {
  std::ranges::move(more.cuts, std::back_inserter(list.cuts));
  std::ranges::move(more.refused, std::back_inserter(list.refused));
  if (list.unquoted_lines == 0) list.first_unquoted_line = std::move(more.first_unquoted_line);
  list.unquoted_lines += more.unquoted_lines;
}

std::vector<fs::path> TextFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  // Not a range-based loop: its ++ throws where a folder cannot be read on.
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    const bool is_text = ToLower(entry->path().extension().string()) == ".txt";
    if (is_text && entry->is_regular_file(ignored)) files.push_back(entry->path());
  }
  if (error) {
    throw Error(ErrorCode::kIoFailure, "cannot be read: " + error.message(), {.file = folder});
  }
  if (files.empty()) {
    throw Error(ErrorCode::kNotFound, "holds no cut file; looked for *.txt in it",
                {.file = folder});
  }
  std::ranges::sort(files);
  return files;
}

}  // namespace

CutList ParseCutList(std::string_view text, const fs::path& file, const CutListOptions& options) {
  CutList list;
  LineScanner lines(text);
  while (lines.Next()) {
    const Place place{file, lines.line_number()};
    if (!lines.line().starts_with('"')) {
      if (!LooksLikeCut(lines.line())) continue;
      if (!options.unquoted) {
        if (list.unquoted_lines++ == 0) list.first_unquoted_line = place;
        continue;
      }
    }
    try {
      list.cuts.push_back(ParseCut(lines.line(), place));
    } catch (const Error& error) {
      list.refused.push_back(error);
    }
  }
  return list;
}

CutList ReadCutLists(std::span<const fs::path> paths, const CutListOptions& options) {
  CutList list;
  for (const fs::path& path : paths) {
    std::error_code ignored;
    if (!fs::exists(path, ignored)) throw Error(ErrorCode::kNotFound, "does not exist", {path});
    const auto files =
        fs::is_directory(path, ignored) ? TextFilesIn(path) : std::vector<fs::path>{path};
    for (const fs::path& file : files) {
      Append(list, ParseCutList(MappedFile(file).text(), file, options));
    }
  }
  if (!list.cuts.empty() || !list.refused.empty()) return list;
  Place place = list.first_unquoted_line;
  if (list.unquoted_lines == 0 && !paths.empty()) place.file = paths.front();
  throw Error(ErrorCode::kMalformedFile,
              list.unquoted_lines > 0
                  ? fmt::format("no line begins with a quote; {} from here on look like cuts "
                                "without quotes, --unquoted takes them",
                                list.unquoted_lines)
                  : fmt::format("holds no cut; {}", kExpected),
              place);
}

}  // namespace kinebase
