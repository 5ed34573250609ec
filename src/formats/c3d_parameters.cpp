// Finding, reading and changing parameters.

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr int kMaxGroups = 127;
constexpr std::size_t kMaxDimension = 255;

template <typename T>
bool SameNumber(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(a)) return std::isnan(b);
  }
  return a == b;
}

std::string_view WithoutPadding(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// Continuations of a list beyond its first parameter; stops at the first that is missing.
template <typename Action>
void ForEachPart(const C3dRecording& recording, std::string_view group, std::string_view name,
                 const Action& action) {
  for (int part = 1;; ++part) {
    const auto* parameter = FindParameter(recording, group, internal::ListPartName(name, part));
    if (parameter == nullptr) return;
    action(*parameter);
  }
}

void RemovePartsFrom(C3dRecording& recording, std::string_view group, std::string_view name,
                     int part) {
  while (RemoveParameter(recording, group, internal::ListPartName(name, part))) ++part;
}

int FreeGroupId(const C3dRecording& recording) {
  for (int id = 1; id <= kMaxGroups; ++id) {
    if (std::ranges::find(recording.groups, id, &C3dGroup::id) == recording.groups.end()) return id;
  }
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("a C3D file has room for {} groups; all are taken", kMaxGroups));
}

// `parameter` as it stands there, but for its values, dimensions and name.
C3dParameter Renewed(const C3dRecording& recording, std::string_view group, std::string_view name) {
  const C3dParameter* old = FindParameter(recording, group, name);
  C3dParameter parameter;
  parameter.name = old != nullptr ? old->name : std::string(name);
  if (old != nullptr) {
    parameter.description = old->description;
    parameter.is_locked = old->is_locked;
  }
  return parameter;
}

}  // namespace

std::string_view ToString(C3dProcessor processor) {
  switch (processor) {
    case C3dProcessor::kDec:
      return "DEC";
    case C3dProcessor::kMips:
      return "MIPS";
    case C3dProcessor::kIntel:
      break;
  }
  return "Intel";
}

std::string_view ToString(C3dStorage storage) {
  return storage == C3dStorage::kFloat ? "float" : "int16";
}

bool operator==(const C3dPoint& a, const C3dPoint& b) {
  return SameNumber(a.x, b.x) && SameNumber(a.y, b.y) && SameNumber(a.z, b.z) &&
         SameNumber(a.quality, b.quality);
}

bool operator==(const C3dHeaderEvent& a, const C3dHeaderEvent& b) {
  return a.label == b.label && SameNumber(a.time_s, b.time_s) && a.display_flag == b.display_flag;
}

bool operator==(const C3dParameter& a, const C3dParameter& b) {
  if (a.name != b.name || a.dimensions != b.dimensions || a.description != b.description ||
      a.is_locked != b.is_locked) {
    return false;
  }
  const auto* reals = std::get_if<std::vector<float>>(&a.values);
  const auto* others = std::get_if<std::vector<float>>(&b.values);
  if (reals == nullptr || others == nullptr) return a.values == b.values;
  return std::ranges::equal(*reals, *others, SameNumber<float>);
}

std::size_t C3dParameter::size() const {
  return std::visit([](const auto& held) { return held.size(); }, values);
}

std::optional<double> C3dParameter::Number(std::size_t index) const {
  if (std::holds_alternative<std::string>(values) || index >= size()) return std::nullopt;
  return std::visit([&](const auto& held) { return static_cast<double>(held[index]); }, values);
}

std::optional<double> C3dParameter::UnsignedNumber(std::size_t index) const {
  const auto number = Number(index);
  if (!number || *number >= 0 || std::holds_alternative<std::vector<float>>(values)) return number;
  return *number + (std::holds_alternative<std::vector<std::int8_t>>(values) ? 256 : 65536);
}

std::vector<std::string> C3dParameter::Strings() const {
  const auto* text = std::get_if<std::string>(&values);
  if (text == nullptr) return {};
  if (dimensions.size() < 2) return {std::string(WithoutPadding(*text))};
  const std::size_t length = dimensions.front();
  if (length == 0) {
    return std::vector<std::string>(dimensions.size() == 2 ? dimensions[1] : 0);
  }
  std::vector<std::string> strings;
  for (std::size_t at = 0; at + length <= text->size(); at += length) {
    strings.emplace_back(WithoutPadding(std::string_view(*text).substr(at, length)));
  }
  return strings;
}

bool operator==(const C3dRecording& a, const C3dRecording& b) {
  const auto same_group = [](const C3dGroup& x, const C3dGroup& y) {
    if (!EqualsIgnoringCase(x.name, "POINT")) return x == y;
    const auto same_parameter = [](const C3dParameter& p, const C3dParameter& q) {
      if (!EqualsIgnoringCase(p.name, "DATA_START")) return p == q;
      return EqualsIgnoringCase(q.name, "DATA_START") && p.dimensions == q.dimensions;
    };
    return x.id == y.id && x.name == y.name && x.description == y.description &&
           x.is_locked == y.is_locked &&
           std::ranges::equal(x.parameters, y.parameters, same_parameter);
  };
  return a.processor == b.processor && a.storage == b.storage && SameNumber(a.scale, b.scale) &&
         SameNumber(a.rate_hz, b.rate_hz) && a.first_frame == b.first_frame &&
         a.frame_count == b.frame_count && a.point_count == b.point_count &&
         a.channel_count == b.channel_count && a.subframe_count == b.subframe_count &&
         a.max_gap == b.max_gap && a.points == b.points &&
         std::ranges::equal(a.analog, b.analog, SameNumber<float>) &&
         a.header_events == b.header_events && a.other_header_words == b.other_header_words &&
         std::ranges::equal(a.groups, b.groups, same_group) && a.trailing == b.trailing;
}

const C3dGroup* FindGroup(const C3dRecording& recording, std::string_view group) {
  const auto found = std::ranges::find_if(
      recording.groups, [&](const C3dGroup& each) { return EqualsIgnoringCase(each.name, group); });
  return found == recording.groups.end() ? nullptr : &*found;
}

const C3dParameter* FindParameter(const C3dRecording& recording, std::string_view group,
                                  std::string_view name) {
  const C3dGroup* where = FindGroup(recording, group);
  if (where == nullptr) return nullptr;
  const auto found = std::ranges::find_if(where->parameters, [&](const C3dParameter& each) {
    return EqualsIgnoringCase(each.name, name);
  });
  return found == where->parameters.end() ? nullptr : &*found;
}

void SetParameter(C3dRecording& recording, std::string_view group, C3dParameter parameter) {
  C3dParameter* old = internal::FindParameterToEdit(recording, group, parameter.name);
  if (old != nullptr) {
    *old = std::move(parameter);
    return;
  }
  C3dGroup* where = internal::FindGroupToEdit(recording, group);
  if (where == nullptr) {
    recording.groups.push_back({.id = FreeGroupId(recording), .name = std::string(group)});
    where = &recording.groups.back();
  }
  where->parameters.push_back(std::move(parameter));
}

bool RemoveParameter(C3dRecording& recording, std::string_view group, std::string_view name) {
  const C3dParameter* parameter = FindParameter(recording, group, name);
  if (parameter == nullptr) return false;
  auto& parameters = internal::FindGroupToEdit(recording, group)->parameters;
  parameters.erase(parameters.begin() + (parameter - parameters.data()));
  return true;
}

C3dParameter RealParameter(std::string_view name, float value) {
  return {.name = std::string(name), .values = std::vector<float>{value}};
}

C3dParameter IntegerParameter(std::string_view name, int value) {
  return {.name = std::string(name),
          .values = std::vector<std::int16_t>{static_cast<std::int16_t>(value)}};
}

C3dParameter TextParameter(std::string_view name, std::string_view text) {
  text = text.substr(0, kMaxDimension);
  return {.name = std::string(name),
          .dimensions = {static_cast<std::uint8_t>(text.size())},
          .values = std::string(text)};
}

std::vector<std::string> TextList(const C3dRecording& recording, std::string_view group,
                                  std::string_view name) {
  std::vector<std::string> texts;
  ForEachPart(recording, group, name, [&](const C3dParameter& part) {
    for (std::string& text : part.Strings()) texts.push_back(std::move(text));
  });
  return texts;
}

std::vector<double> NumberList(const C3dRecording& recording, std::string_view group,
                               std::string_view name, bool is_unsigned) {
  std::vector<double> numbers;
  ForEachPart(recording, group, name, [&](const C3dParameter& part) {
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto number = is_unsigned ? part.UnsignedNumber(i) : part.Number(i);
      if (number) numbers.push_back(*number);
    }
  });
  return numbers;
}

void SetTextList(C3dRecording& recording, std::string_view group, std::string_view name,
                 std::span<const std::string> texts) {
  int part = 1;
  do {
    const auto some = texts.first(std::min(texts.size(), kMaxDimension));
    texts = texts.subspan(some.size());
    std::size_t length = 1;  // Columns of no length are more than some readers stand.
    for (const std::string& text : some) length = std::max(length, text.size());
    length = std::min(length, kMaxDimension);
    C3dParameter parameter = Renewed(recording, group, internal::ListPartName(name, part));
    parameter.dimensions = {static_cast<std::uint8_t>(length),
                            static_cast<std::uint8_t>(some.size())};
    std::string held;
    for (const std::string& text : some) {
      held += text.substr(0, length);
      held.resize(held.size() + length - std::min(length, text.size()), ' ');
    }
    parameter.values = std::move(held);
    SetParameter(recording, group, std::move(parameter));
    ++part;
  } while (!texts.empty());
  RemovePartsFrom(recording, group, name, part);
}

void SetRealList(C3dRecording& recording, std::string_view group, std::string_view name,
                 std::span<const float> values) {
  int part = 1;
  do {
    const auto some = values.first(std::min(values.size(), kMaxDimension));
    values = values.subspan(some.size());
    C3dParameter parameter = Renewed(recording, group, internal::ListPartName(name, part));
    parameter.dimensions = {static_cast<std::uint8_t>(some.size())};
    parameter.values = std::vector<float>(some.begin(), some.end());
    SetParameter(recording, group, std::move(parameter));
    ++part;
  } while (!values.empty());
  RemovePartsFrom(recording, group, name, part);
}

namespace internal {

std::string ListPartName(std::string_view name, int part) {
  return part == 1 ? std::string(name) : fmt::format("{}{}", name, part);
}

C3dGroup* FindGroupToEdit(C3dRecording& recording, std::string_view group) {
  const C3dGroup* found = FindGroup(recording, group);
  return found == nullptr ? nullptr : &recording.groups[found - recording.groups.data()];
}

C3dParameter* FindParameterToEdit(C3dRecording& recording, std::string_view group,
                                  std::string_view name) {
  const C3dParameter* found = FindParameter(recording, group, name);
  if (found == nullptr) return nullptr;
  auto& parameters = FindGroupToEdit(recording, group)->parameters;
  return &parameters[found - parameters.data()];
}

}  // namespace internal
}  // namespace kinebase
