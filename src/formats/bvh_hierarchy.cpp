// The hierarchy of a BVH file, read word by word, as braces and keywords may share lines; a name
// ends with its line because it may have blanks.

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "formats/bvh_reader.h"

namespace kinebase::internal {
namespace {

constexpr std::size_t kChannelNameLength = 9;

std::optional<BvhChannel> ParseChannel(std::string_view text) {
  for (int i = 0; i < 6; ++i) {
    const auto channel = static_cast<BvhChannel>(i);
    if (EqualsIgnoringCase(text, ToString(channel))) return channel;
  }
  return std::nullopt;
}

bool IsBrace(char c) { return c == '{' || c == '}'; }

// Takes a word off the front of `text`; it ends at a blank or before a brace.
std::string_view TakeWord(std::string_view& text) {
  text = Trim(text);
  const std::string_view word = text.substr(0, text.find_first_of(" \t\v\f{}"));
  text = Trim(text.substr(word.size()));
  return word;
}

class HierarchyReader {
 public:
  explicit HierarchyReader(BvhContext& context) : context_(context), bvh_(context.bvh) {}

  void Read() {
    while (context_.lines.Next()) {
      std::string_view rest = Trim(context_.lines.line());
      while (!rest.empty()) {
        if (TakeItem(rest)) return;
      }
    }
    if (!has_header_) Fail("has no text; expected 'HIERARCHY' of a BVH file", 0);
    if (!blocks_.empty()) FailOpenBlock("the end of the file");
    Fail("ends without 'MOTION'", 0);
  }

 private:
  // An open pair of braces: of a joint, or of an end site of that joint.
  struct Block {
    std::size_t joint = 0;
    bool is_end_site = false;
    bool has_offset = false;
    bool has_channels = false;
    std::int64_t line = 0;
  };

  template <typename... Line>
  [[noreturn]] void Fail(const std::string& message, Line... line) const {
    context_.Fail(message, line...);
  }
  [[noreturn]] void Unexpected(const std::string& expected, std::string_view found) const {
    context_.Unexpected(expected, found);
  }

  // One brace, or a keyword and what belongs to it. True after MOTION.
  bool TakeItem(std::string_view& rest) {
    const std::string_view line = rest;
    if (IsBrace(rest.front())) {
      const bool opens = rest.front() == '{';
      rest = Trim(rest.substr(1));
      if (opens) {
        OpenBlock();
      } else {
        CloseBlock();
      }
      return false;
    }
    const std::string keyword = ToLower(TakeWord(rest));
    if (!has_header_) {
      if (keyword != "hierarchy") Unexpected("'HIERARCHY', with which a BVH file begins", line);
      has_header_ = true;
      return false;
    }
    if (awaits_brace_) Unexpected("'{' after the name of a joint", line);
    if (keyword == "motion") {
      EndHierarchy();
      return true;
    }
    if (keyword == "root" || keyword == "joint") {
      BeginJoint(keyword, rest);
    } else if (blocks_.empty()) {
      Unexpected("'ROOT' or 'MOTION'", line);
    } else if (keyword == "end") {
      BeginEndSite(rest);
    } else if (keyword == "offset") {
      TakeOffset(rest);
    } else if (keyword == "channels") {
      TakeChannels(rest);
    } else {
      KeepUnknown(line);
      rest = {};
    }
    return false;
  }

  // The rest of a line up to a brace.
  static std::string TakeName(std::string_view& rest) {
    const std::size_t length = std::min(rest.find_first_of("{}"), rest.size());
    std::string name(Trim(rest.substr(0, length)));
    rest = Trim(rest.substr(length));
    return name;
  }

  void BeginJoint(const std::string& keyword, std::string_view& rest) {
    if (!blocks_.empty() && blocks_.back().is_end_site) Fail("a joint inside an 'End Site'");
    BvhJoint joint{.name = TakeName(rest),
                   .parent = blocks_.empty() ? -1 : static_cast<int>(blocks_.back().joint),
                   .line = context_.lines.line_number()};
    if (HasBinary(joint.name)) Unexpected("a joint's name", joint.name);
    if (blocks_.empty() != (keyword == "root")) {
      context_.Warn(blocks_.empty() ? "'JOINT' outside any braces is read as 'ROOT'"
                                    : "'ROOT' inside another joint's braces is read as 'JOINT'",
                    joint.line);
    }
    next_ = {.joint = bvh_.joints.size(), .line = joint.line};
    bvh_.joints.push_back(std::move(joint));
    awaits_brace_ = true;
  }

  void BeginEndSite(std::string_view& rest) {
    if (blocks_.back().is_end_site) Fail("an 'End Site' inside another");
    BvhJoint& joint = bvh_.joints[blocks_.back().joint];
    joint.end_sites.push_back({.name = TakeName(rest)});
    const std::string& name = joint.end_sites.back().name;
    if (HasBinary(name)) Unexpected("'End Site'", name);
    next_ = {
        .joint = blocks_.back().joint, .is_end_site = true, .line = context_.lines.line_number()};
    awaits_brace_ = true;
  }

  void OpenBlock() {
    if (!awaits_brace_) Fail("a '{' without 'ROOT', 'JOINT' or 'End Site' before it");
    awaits_brace_ = false;
    blocks_.push_back(next_);
  }

  void CloseBlock() {
    if (blocks_.empty() || awaits_brace_) Fail("a '}' without '{' before it");
    if (!blocks_.back().has_offset) Fail(NameOf(blocks_.back()) + " has no 'OFFSET'");
    blocks_.pop_back();
  }

  std::string NameOf(const Block& block) const {
    const std::string joint = "joint " + Quoted(bvh_.joints[block.joint].name);
    return block.is_end_site ? "the 'End Site' of " + joint : joint;
  }

  void TakeOffset(std::string_view& rest) {
    Block& block = blocks_.back();
    if (std::exchange(block.has_offset, true)) Fail(NameOf(block) + " has a second 'OFFSET'");
    BvhJoint& joint = bvh_.joints[block.joint];
    for (double& value : block.is_end_site ? joint.end_sites.back().offset : joint.offset) {
      const std::string_view word = TakeWord(rest);
      const auto number = ParseDouble(word);
      if (!number || !std::isfinite(*number)) Unexpected("three numbers after 'OFFSET'", word);
      value = *number;
    }
  }

  void TakeChannels(std::string_view& rest) {
    Block& block = blocks_.back();
    const std::string_view line = rest;
    const std::string_view count_word = TakeWord(rest);
    const auto count = ParseInteger(count_word);
    if (!count || *count < 0) Unexpected("the number of channels after 'CHANNELS'", count_word);
    if (block.is_end_site) {
      // Seen from writers that treat every node alike; anything but 0 would have columns.
      if (*count > 0) Fail(NameOf(block) + " cannot have channels");
      bvh_.joints[block.joint].end_sites.back().unknown.emplace_back("CHANNELS 0");
      return;
    }
    if (std::exchange(block.has_channels, true)) Fail(NameOf(block) + " has a second 'CHANNELS'");
    if (block.joint + 1 != bvh_.joints.size()) {
      Fail("'CHANNELS' of " + NameOf(block) + " stand behind a joint inside it");
    }
    BvhJoint& joint = bvh_.joints[block.joint];
    for (std::int64_t i = 0; i < *count; ++i) {
      const std::string_view word = TakeWord(rest);
      if (word.empty()) {
        Fail(fmt::format("{} has {} channels; {} were announced", NameOf(block), i, *count));
      }
      const auto channel = ParseChannel(word);
      if (!channel) Unexpected("a channel such as Xposition or Zrotation", word);
      joint.channels.push_back(*channel);
    }
    if (!rest.empty() && ParseChannel(rest.substr(0, kChannelNameLength))) {
      Fail(fmt::format("{} has more channels than the {} announced: {}", NameOf(block), *count,
                       Quoted(line)));
    }
  }

  // Another line inside a block, kept whole.
  void KeepUnknown(std::string_view line) {
    if (HasBinary(line) || line.find_first_of("{}") != std::string_view::npos) {
      Unexpected("a keyword such as 'JOINT' or 'OFFSET'", line);
    }
    BvhJoint& joint = bvh_.joints[blocks_.back().joint];
    (blocks_.back().is_end_site ? joint.end_sites.back().unknown : joint.unknown)
        .emplace_back(line);
    context_.CountUnknown(line);
  }

  [[noreturn]] void FailOpenBlock(std::string_view where) const {
    Fail(fmt::format("{} is not closed with '}}' before {}", NameOf(blocks_.back()), where),
         blocks_.back().line);
  }

  void EndHierarchy() {
    if (!blocks_.empty()) FailOpenBlock("'MOTION'");
    if (bvh_.joints.empty()) Fail("'MOTION' without any joint before it");
    for (BvhJoint& joint : bvh_.joints) {
      joint.first_column = bvh_.column_count;
      bvh_.column_count += joint.channels.size();
    }
    if (bvh_.column_count == 0) Fail("no joint has channels, so no frame can have values");
  }

  BvhContext& context_;
  BvhMotion& bvh_;
  std::vector<Block> blocks_;
  Block next_;  // The one whose '{' is awaited.
  bool has_header_ = false;
  bool awaits_brace_ = false;
};

}  // namespace

void ReadBvhHierarchy(BvhContext& context) { HierarchyReader(context).Read(); }

}  // namespace kinebase::internal
