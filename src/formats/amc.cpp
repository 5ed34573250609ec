// Reads and writes AMC.
//
// One pass over the mapped text. The first frame is read in general and fixes the columns. In
// practice all others have the same bones in the same order and nothing else, and such a frame is
// read as a whole; only one that differs in any way is read line by line.

#include "kinebase/formats/amc.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>
#include <utility>

#include "fmt/format.h"
#include "formats/decimal_number.h"
#include "formats/text_lines.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

// Takes a number off the front of `text`; false if something else stands there.
bool TakeNumber(std::string_view& text, double& value) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto result = std::from_chars(begin, end, value);
  const bool whole = result.ptr == end || *result.ptr == ' ' || *result.ptr == '\t';
  if (result.ec == std::errc() && whole) [[likely]] {
    text.remove_prefix(static_cast<std::size_t>(result.ptr - begin));
    return true;
  }
  // The rare forms: a plus sign, numbers too small for a double.
  std::string_view rest = text;
  const auto parsed = ParseDouble(TakeToken(rest));
  if (!parsed) return false;
  value = *parsed;
  text = rest;
  return true;
}

void SkipBlanks(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || (text.front() >= '\t' && text.front() <= '\r'))) {
    text.remove_prefix(1);
  }
}

class AmcParser {
 public:
  AmcParser(std::string_view text, const std::filesystem::path& file, const AmcReadOptions& options)
      : lines_(text), text_(text), file_(file), options_(options) {}

  AmcMotion Parse() {
    while (true) {
      while (TakeUsualFrame()) {
      }
      if (!lines_.Next()) break;
      try {
        TakeLine();
      } catch (const Error&) {
        // A last line without its end that makes no sense was cut off, as the file was. Within the
        // first frame nothing says which bones it should have had.
        const bool in_first = in_first_frame() && !IsFrameLine(lines_.line());
        const bool may_be_cut = !lines_.line_is_terminated() && !amc_.frame_numbers.empty();
        if (!may_be_cut || in_first || options_.strict) throw;
        last_line_is_cut_ = true;
      }
    }
    FinishLastFrame();
    ReportJumps();
    return std::move(amc_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, lines_.line_number()});
  }

  bool in_first_frame() const { return amc_.frame_numbers.size() == 1; }

  static bool IsFrameLine(std::string_view line) {
    SkipBlanks(line);
    return !line.empty() && (IsDigit(line.front()) || line.front() == '+' || line.front() == '-');
  }

  // Reads a frame that has the next number and all bones in order, each with its values, a line
  // each. False if what follows is anything else; it is then still to be read.
  bool TakeUsualFrame() {
    if (amc_.bones.empty() || bones_in_frame_ != amc_.bones.size()) return false;
    const std::string_view rest = lines_.rest();
    const char* at = rest.data();
    const char* const end = at + rest.size();
    const std::int64_t before = amc_.frame_numbers.back();
    std::int64_t number = before;  // As it stays if there is none.
    at = std::from_chars(at, end, number).ptr;
    if (number <= before || number - 1 > before || !TakeLineEnd(at, end)) return false;
    usual_frame_.resize(amc_.column_count);
    double* value = usual_frame_.data();
    for (const AmcBone& bone : amc_.bones) {
      if (static_cast<std::size_t>(end - at) < bone.name.size()) return false;
      if (std::memcmp(at, bone.name.data(), bone.name.size()) != 0) return false;
      at += bone.name.size();
      for (std::size_t i = 0; i < bone.column_count; ++i, ++value) {
        if (!TakeBlanks(at, end)) return false;
        const auto [next, error] = internal::NumberFromChars(at, end, end, *value);
        if (error != std::errc()) return false;
        at = next;
      }
      if (!TakeLineEnd(at, end)) return false;
    }
    if (in_first_frame()) Reserve(rest.data());
    amc_.frame_numbers.push_back(number);
    amc_.values.insert(amc_.values.end(), usual_frame_.begin(), usual_frame_.end());
    frame_line_ = lines_.line_number() + 1;
    last_line_has_values_ = true;
    lines_.Skip(static_cast<std::size_t>(at - rest.data()),
                static_cast<std::int64_t>(amc_.bones.size()) + 1);
    return true;
  }

  // False if there are none.
  static bool TakeBlanks(const char*& at, const char* end) {
    if (at == end || (*at != ' ' && *at != '\t')) return false;
    do {
      ++at;
    } while (at != end && (*at == ' ' || *at == '\t'));
    return true;
  }

  static bool TakeLineEnd(const char*& at, const char* end) {
    TakeBlanks(at, end);
    if (at != end && *at == '\r') ++at;
    if (at == end || *at != '\n') return false;
    ++at;
    return true;
  }

  void Reserve(const char* first_frame_end) {
    const std::size_t frames = internal::GuessFrames(first_frame_, first_frame_end, text_);
    amc_.frame_numbers.reserve(frames);
    amc_.values.reserve(frames * amc_.column_count);
  }

  void TakeLine() {
    std::string_view line = lines_.line();
    SkipBlanks(line);
    last_line_has_values_ = false;
    if (line.empty()) return;
    const char first = line.front();
    if (first == '#' || first == ':') {
      KeepRemark(lines_.line());
      return;
    }
    const std::string_view comment = TakeComment(line);
    if (IsFrameLine(line)) {
      BeginFrame(Trim(line));
    } else {
      TakeBoneLine(line);
    }
    if (!comment.empty()) KeepRemark(comment);
  }

  // Takes a comment off the end of a line.
  static std::string_view TakeComment(std::string_view& line) {
    const std::size_t hash = line.find('#');
    if (hash == std::string_view::npos) return {};
    const std::string_view comment = line.substr(hash);
    line.remove_suffix(comment.size());
    return comment;
  }

  void KeepRemark(std::string_view line) {
    CheckText(line);
    if (!amc_.frame_numbers.empty()) {
      amc_.remarks.push_back({amc_.frame_numbers.size() - 1, std::string(line)});
      return;
    }
    amc_.header.emplace_back(line);
    // Several keywords on a line and a comment after them do no harm.
    for (const auto keyword : SplitTokens(line.substr(0, line.find('#')))) {
      if (EqualsIgnoringCase(keyword, ":degrees")) amc_.angle_unit = AmcAngleUnit::kDegrees;
      if (EqualsIgnoringCase(keyword, ":radians")) amc_.angle_unit = AmcAngleUnit::kRadians;
      if (EqualsIgnoringCase(keyword, ":force-all-joints-be-3dof")) {
        amc_.all_bones_have_three_dofs = true;
      }
    }
  }

  void CheckText(std::string_view line) const {
    const bool binary = std::ranges::any_of(line, [](char c) {
      const auto byte = static_cast<unsigned char>(c);
      return byte < 0x20 && c != '\t' && c != '\f' && c != '\v';
    });
    if (binary) Fail("holds binary data; expected the text of an AMC file");
  }

  void BeginFrame(std::string_view line) {
    const auto number = ParseInteger(line);
    if (!number) {
      CheckText(line);
      Fail("expected a frame number or a bone's name, found " + Quoted(line));
    }
    if (!amc_.frame_numbers.empty()) {
      CompleteFrame();
      const std::int64_t before = amc_.frame_numbers.back();
      if (*number <= before) {
        Fail(fmt::format("frame {} after frame {}: frame numbers must grow", *number, before));
      }
      if (*number != before + 1 && jumps_++ == 0) {
        first_jump_ = {before, *number, lines_.line_number()};
      }
    }
    if (amc_.frame_numbers.empty()) first_frame_ = line.data();
    if (in_first_frame()) Reserve(line.data());
    amc_.frame_numbers.push_back(*number);
    frame_line_ = lines_.line_number();
    bones_in_frame_ = 0;
    if (amc_.frame_numbers.size() > 1) {
      amc_.values.resize(amc_.values.size() + amc_.column_count);
      seen_.assign(seen_.size(), false);
    }
  }

  void TakeBoneLine(std::string_view line) {
    if (amc_.frame_numbers.empty()) {
      CheckText(line);
      Fail("expected a ':' keyword, a '#' comment or a frame number, found " + Quoted(line));
    }
    if (in_first_frame()) {
      LearnBone(line);
    } else {
      ReadBone(line);
    }
    ++bones_in_frame_;
    last_line_has_values_ = true;
  }

  // A line of the first frame: a new bone with as many columns as there are values.
  void LearnBone(std::string_view line) {
    const std::string_view name = TakeToken(line);
    CheckText(name);
    AmcBone bone{std::string(name), amc_.values.size(), 0, lines_.line_number()};
    if (!bone_index_.emplace(bone.name, amc_.bones.size()).second) {
      Fail(
          fmt::format("bone {} stands twice in frame {}", Quoted(name), amc_.frame_numbers.back()));
    }
    for (SkipBlanks(line); !line.empty(); SkipBlanks(line)) {
      amc_.values.push_back(Value(line, name));
      ++bone.column_count;
    }
    if (bone.column_count == 0) Fail(fmt::format("bone {} has no values", Quoted(name)));
    amc_.column_count = amc_.values.size();
    amc_.bones.push_back(std::move(bone));
    seen_.push_back(true);
  }

  void ReadBone(std::string_view line) {
    const std::size_t index = FindBone(line);
    const AmcBone& bone = amc_.bones[index];
    if (seen_[index]) {
      Fail(fmt::format("bone {} stands twice in frame {}", Quoted(bone.name),
                       amc_.frame_numbers.back()));
    }
    line.remove_prefix(bone.name.size());
    double* const frame = amc_.values.data() + amc_.values.size() - amc_.column_count;
    std::size_t count = 0;
    for (SkipBlanks(line); !line.empty(); SkipBlanks(line), ++count) {
      const double value = Value(line, bone.name);
      if (count < bone.column_count) frame[bone.first_column + count] = value;
    }
    if (count != bone.column_count) {
      Fail(fmt::format("bone {} has {} values; in the first frame it has {}", Quoted(bone.name),
                       count, bone.column_count));
    }
    seen_[index] = true;
  }

  // Index of the bone that `line` starts with: most likely the one in its place in the first frame.
  std::size_t FindBone(std::string_view line) const {
    if (bones_in_frame_ < amc_.bones.size()) {
      const std::string& expected = amc_.bones[bones_in_frame_].name;
      if (line.starts_with(expected) &&
          (line.size() == expected.size() || line[expected.size()] == ' ' ||
           line[expected.size()] == '\t')) {
        return bones_in_frame_;
      }
    }
    const std::string_view name = TakeToken(line);
    const auto found = bone_index_.find(std::string(name));
    if (found == bone_index_.end()) {
      CheckText(name);
      Fail(fmt::format("bone {} is not in the first frame", Quoted(name)));
    }
    return found->second;
  }

  double Value(std::string_view& line, std::string_view bone) const {
    double value = kMissing;
    if (TakeNumber(line, value)) return value;
    std::string_view rest = line;
    const std::string_view token = TakeToken(rest);
    CheckText(token);
    Fail(fmt::format("a value of bone {} is not a number: {}", Quoted(bone), Quoted(token)));
  }

  // At the next frame number: the frame before it must have every bone.
  void CompleteFrame() const {
    if (amc_.bones.empty()) {
      Fail(fmt::format("frame {} has no bones", amc_.frame_numbers.back()));
    }
    const auto missing = std::ranges::find(seen_, false);
    if (missing == seen_.end()) return;
    const AmcBone& bone = amc_.bones[static_cast<std::size_t>(missing - seen_.begin())];
    throw Error(ErrorCode::kMalformedFile,
                fmt::format("frame {} lacks bone {}", amc_.frame_numbers.back(), Quoted(bone.name)),
                {file_, frame_line_});
  }

  // A file that was cut off ends in the middle of a frame, most often of a line.
  void FinishLastFrame() {
    if (amc_.frame_numbers.empty()) {
      throw Error(ErrorCode::kMalformedFile, "has no frames", {file_});
    }
    const bool whole = !amc_.bones.empty() && std::ranges::find(seen_, false) == seen_.end();
    const std::int64_t number = amc_.frame_numbers.back();
    const bool last_value_may_be_cut = last_line_has_values_ && !lines_.line_is_terminated();
    if (whole && !last_line_is_cut_ && !last_value_may_be_cut) return;
    if (!whole && in_first_frame()) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("has no whole frame: frame {} is cut off", number),
                  {file_, frame_line_});
    }
    if (options_.strict) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("the last frame, {}, {}", number,
                              whole ? "may be cut off: its last line has no end (without --strict "
                                      "it is read)"
                                    : "is cut off (without --strict it is left out)"),
                  {file_, frame_line_});
    }
    if (!whole) {
      DropLastFrame();
      Warn(fmt::format("the last frame, {}, is cut off; it is left out", number), frame_line_);
    } else if (last_line_is_cut_) {
      Warn("the last line is cut off; it is left out", lines_.line_number());
    } else {
      Warn("the last line has no end: if the file was cut off, its last value may lack digits",
           lines_.line_number());
    }
  }

  void Warn(std::string message, std::int64_t line) {
    amc_.diagnostics.push_back({Severity::kWarning, std::move(message), line});
  }

  // Once, however many there are: a recording that keeps only every fourth frame jumps at each.
  void ReportJumps() {
    if (jumps_ == 0) return;
    const std::string others = jumps_ == 1 ? "" : fmt::format(", and {} more", jumps_ - 1);
    Warn(fmt::format("frame {} follows frame {}{}: numbers jump, time is taken to go on evenly",
                     first_jump_.to, first_jump_.from, others),
         first_jump_.line);
  }

  void DropLastFrame() {
    amc_.frame_numbers.pop_back();
    amc_.values.resize(amc_.values.size() - amc_.column_count);
    std::erase_if(amc_.remarks, [&](const AmcMotion::Remark& remark) {
      return remark.frame >= amc_.frame_numbers.size();
    });
  }

  LineScanner lines_;
  const std::string_view text_;
  const char* first_frame_ = nullptr;  // Where it begins in the text.
  const std::filesystem::path& file_;
  const AmcReadOptions& options_;
  AmcMotion amc_;
  std::unordered_map<std::string, std::size_t> bone_index_;
  std::vector<double> usual_frame_;  // Values of the frame that is read as a whole.
  std::vector<bool> seen_;           // [bone] in the current frame.
  std::size_t bones_in_frame_ = 0;
  std::int64_t frame_line_ = 0;
  std::int64_t jumps_ = 0;  // Of frame numbers.
  struct {
    std::int64_t from = 0;
    std::int64_t to = 0;
    std::int64_t line = 0;
  } first_jump_;
  bool last_line_is_cut_ = false;
  bool last_line_has_values_ = false;
};

bool SameValue(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

AmcMotion ParseAmc(std::string_view text, const std::filesystem::path& file,
                   const AmcReadOptions& options) {
  if (text.empty()) {
    throw Error(ErrorCode::kMalformedFile, "is empty; expected an AMC motion", {file});
  }
  return AmcParser(text, file, options).Parse();
}

AmcMotion ReadAmc(const std::filesystem::path& path, const AmcReadOptions& options) {
  const MappedFile file(path);
  return ParseAmc(file.text(), path, options);
}

std::string FormatAmc(const AmcMotion& amc) {
  std::string out;
  out.reserve(amc.values.size() * 10);
  for (const auto& line : amc.header) out += line + '\n';
  auto remark = amc.remarks.begin();
  for (std::size_t frame = 0; frame < amc.frame_count(); ++frame) {
    out += std::to_string(amc.frame_numbers[frame]) + '\n';
    const auto values = amc.Frame(frame);
    for (const AmcBone& bone : amc.bones) {
      out += bone.name;
      for (const double value : values.subspan(bone.first_column, bone.column_count)) {
        out += ' ';
        AppendShortestText(out, value);
      }
      out += '\n';
    }
    for (; remark != amc.remarks.end() && remark->frame == frame; ++remark) {
      out += remark->text + '\n';
    }
  }
  return out;
}

bool operator==(const AmcMotion& a, const AmcMotion& b) {
  return a.header == b.header && a.angle_unit == b.angle_unit &&
         a.all_bones_have_three_dofs == b.all_bones_have_three_dofs && a.bones == b.bones &&
         a.column_count == b.column_count && a.frame_numbers == b.frame_numbers &&
         std::ranges::equal(a.values, b.values, SameValue) && a.remarks == b.remarks;
}

}  // namespace kinebase
