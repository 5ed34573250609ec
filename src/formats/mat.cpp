// What MATLAB arrays are made of and can be asked.

#include "kinebase/formats/mat.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/mat_text.h"

namespace kinebase {
namespace {

bool SameNumbers(const std::vector<double>& a, const std::vector<double>& b) {
  return std::ranges::equal(
      a, b, [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

MatArray OfClass(MatClass type, std::size_t rows, std::size_t columns) {
  MatArray array{.type = type};
  array.dims = {static_cast<std::int32_t>(rows), static_cast<std::int32_t>(columns)};
  return array;
}

}  // namespace

std::string_view ToString(MatClass type) {
  constexpr std::array<std::string_view, 12> kNames = {"double", "single", "int8",   "uint8",
                                                       "int16",  "uint16", "int32",  "uint32",
                                                       "char",   "cell",   "struct", "other"};
  return kNames[static_cast<std::size_t>(type)];
}

std::size_t MatArray::size() const {
  std::size_t count = 1;
  for (const std::int32_t length : dims) count *= static_cast<std::size_t>(length);
  return count;
}

const MatArray* MatArray::Field(std::string_view name, std::size_t element) const {
  const auto found = std::ranges::find(fields, name);
  if (found == fields.end()) return nullptr;
  const std::size_t at = element * fields.size() + static_cast<std::size_t>(found - fields.begin());
  return at < elements.size() ? &elements[at] : nullptr;
}

std::string MatArray::Text() const { return internal::Utf16ToUtf8(characters); }

bool operator==(const MatArray& a, const MatArray& b) {
  return a.type == b.type && a.is_logical == b.is_logical && a.dims == b.dims &&
         SameNumbers(a.numbers, b.numbers) && a.characters == b.characters &&
         a.fields == b.fields && a.elements == b.elements && a.bytes == b.bytes;
}

const MatArray* MatFile::Find(std::string_view name) const {
  const auto found = std::ranges::find(variables, name, &MatVariable::name);
  return found == variables.end() ? nullptr : &found->value;
}

MatArray MatText(std::string_view utf8) {
  std::u16string characters = internal::Utf8ToUtf16(utf8);
  MatArray array = OfClass(MatClass::kChar, characters.empty() ? 0 : 1, characters.size());
  array.characters = std::move(characters);
  return array;
}

MatArray MatScalar(double value) { return MatColumn({value}); }

MatArray MatColumn(std::vector<double> numbers) {
  const std::size_t rows = numbers.size();
  return MatMatrix(rows, std::move(numbers));
}

MatArray MatMatrix(std::size_t rows, std::vector<double> numbers) {
  if (numbers.empty()) return {};
  MatArray array = OfClass(MatClass::kDouble, rows, numbers.size() / rows);
  array.numbers = std::move(numbers);
  return array;
}

MatArray MatCells(std::vector<MatArray> elements) {
  MatArray array = OfClass(MatClass::kCell, elements.size(), elements.empty() ? 0 : 1);
  array.elements = std::move(elements);
  return array;
}

MatArray MatStruct(std::vector<std::pair<std::string, MatArray>> fields) {
  MatArray array = OfClass(MatClass::kStruct, 1, 1);
  for (auto& field : fields) {
    array.fields.push_back(std::move(field.first));
    array.elements.push_back(std::move(field.second));
  }
  return array;
}

}  // namespace kinebase
