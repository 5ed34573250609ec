#include "library/relative_name.h"

#include <algorithm>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {
namespace {

bool IsControl(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

bool HasDrive(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  return name.size() >= 2 && name[1] == ':' && is_letter(name[0]);
}

}  // namespace

std::string CheckedRelativeName(std::string_view name, std::string_view what, const Place& place) {
  const auto refuse = [&](std::string_view why) {
    throw Error(ErrorCode::kInvalidArgument, fmt::format("{} {} {}", what, Quoted(name), why),
                place);
  };
  if (std::ranges::any_of(name, IsControl)) refuse("holds a control character");
  if (name.starts_with('/') || HasDrive(name)) refuse("is absolute; name it relative to a folder");
  std::string checked;
  std::string_view last;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    last = name.substr(begin, end - begin);
    begin = end + 1;
    if (last == "..") refuse("leaves its folder by '..'");
    if (last.empty() || last == ".") continue;
    checked.append(checked.empty() ? "" : "/").append(last);
  }
  if (last.empty() || last == ".") refuse("names no file");
  return checked;
}

}  // namespace kinebase::internal
