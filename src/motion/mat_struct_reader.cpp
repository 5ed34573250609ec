#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "motion/mat_structs.h"

namespace kinebase::internal {

MatStructReader::MatStructReader(const MatArray& structure, std::string name,
                                 const std::filesystem::path& file)
    : structure_(structure), name_(std::move(name)), file_(file) {
  if (structure.type != MatClass::kStruct) {
    throw Error(
        ErrorCode::kMalformedFile,
        fmt::format("{} is of class {}; expected a structure", name_, ToString(structure.type)),
        {file_});
  }
}

void MatStructReader::Fail(std::string_view field, std::size_t element,
                           const std::string& message) const {
  const std::string index = size() > 1 ? fmt::format("({})", element + 1) : "";
  throw Error(ErrorCode::kMalformedFile, fmt::format("{}{}.{} {}", name_, index, field, message),
              {file_});
}

const MatArray& MatStructReader::Need(std::string_view field, std::size_t element) const {
  if (const MatArray* const found = Find(field, element)) return *found;
  Fail(field, element,
       fmt::format("is missing; there are: {}", fmt::join(structure_.fields, ", ")));
}

std::vector<double> MatStructReader::Numbers(std::string_view field, std::size_t element) const {
  const MatArray& array = Need(field, element);
  if (array.type <= MatClass::kUint32) return array.numbers;
  Fail(field, element, fmt::format("is of class {}; expected numbers", ToString(array.type)));
}

double MatStructReader::Number(std::string_view field, std::size_t element) const {
  const std::vector<double> numbers = Numbers(field, element);
  if (numbers.size() == 1) return numbers.front();
  Fail(field, element, fmt::format("has {} numbers; expected one", numbers.size()));
}

Eigen::Vector3d MatStructReader::Vector(std::string_view field, std::size_t element) const {
  const std::vector<double> numbers = Numbers(field, element);
  if (numbers.size() != 3) {
    Fail(field, element, fmt::format("has {} numbers; expected three", numbers.size()));
  }
  Eigen::Vector3d vector(numbers.data());
  if (!vector.allFinite()) Fail(field, element, "is no vector of finite numbers");
  return vector;
}

std::string MatStructReader::Text(std::string_view field, std::size_t element) const {
  const MatArray& array = Need(field, element);
  if (array.type == MatClass::kChar || array.size() == 0) return array.Text();
  Fail(field, element, fmt::format("is of class {}; expected text", ToString(array.type)));
}

std::vector<std::string> MatStructReader::Texts(std::string_view field, std::size_t element) const {
  const MatArray& array = Need(field, element);
  if (array.size() == 0) return {};
  if (array.type == MatClass::kChar) return {array.Text()};
  std::vector<std::string> texts;
  for (const MatArray& cell : array.elements) {
    if (array.type != MatClass::kCell || (cell.type != MatClass::kChar && cell.size() != 0)) break;
    texts.push_back(cell.Text());
  }
  if (texts.size() != array.size()) Fail(field, element, "is no cell array of texts");
  return texts;
}

MatStructReader MatStructReader::Struct(std::string_view field) const {
  return {Need(field), fmt::format("{}.{}", name_, field), file_};
}

}  // namespace kinebase::internal
