#include "library/name_words.h"

#include <cctype>

namespace kinebase::internal {
namespace {

bool IsUpper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::string SpacedName(std::string_view name) {
  std::string spaced;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool begins = i > 0 && (IsUpper(name[i]) || IsDigit(name[i]) != IsDigit(name[i - 1]));
    if (begins) spaced += ' ';
    spaced += name[i];
  }
  return spaced;
}

}  // namespace kinebase::internal
