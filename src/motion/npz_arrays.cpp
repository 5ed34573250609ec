#include "motion/npz_arrays.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {
namespace {

std::string NamesOf(const NpzArchive& archive) {
  std::string names;
  for (const NpzArray& array : archive.arrays) {
    names.append(names.empty() ? "" : ", ").append(array.name);
  }
  return names.empty() ? "none" : Quoted(names);
}

template <typename Vector>
constexpr bool kIsText = std::is_same_v<Vector, std::vector<std::string>>;

}  // namespace

void NpzSource::Fail(const std::string& message) const {
  throw Error(ErrorCode::kMalformedFile, message, {file_});
}

const NpzArray& NpzSource::Need(std::string_view name) {
  const NpzArray* const array = archive_.Find(name);
  if (array == nullptr) {
    Fail(
        fmt::format("array '{}' is missing; a skeleton's motion has format, version, rate_hz, "
                    "bone_names, parents, offsets, root_position and rotations, markers have "
                    "format, version, rate_hz, labels and positions; there are {}",
                    name, NamesOf(archive_)));
  }
  read_.emplace_back(name);
  return *array;
}

const NpzArray& NpzSource::Need(std::string_view name, const NpzShape& shape,
                                std::string_view meaning) {
  const NpzArray& array = Need(name);
  if (array.shape != shape) {
    Fail(fmt::format("array '{}' has the shape ({}); expected ({}), which is {}", name,
                     fmt::join(array.shape, ", "), fmt::join(shape, ", "), meaning));
  }
  return array;
}

const NpzArray& NpzSource::NeedSingle(std::string_view name) {
  const NpzArray& array = Need(name);
  if (array.size() != 1)
    Fail(fmt::format("array '{}' has {} items; expected one", name, array.size()));
  return array;
}

std::vector<double> NpzSource::Numbers(std::string_view name, const NpzShape& shape,
                                       std::string_view meaning) {
  return std::visit(
      [&](const auto& items) -> std::vector<double> {
        if constexpr (kIsText<std::decay_t<decltype(items)>>) {
          Fail(fmt::format("array '{}' holds text; expected numbers", name));
        } else {
          return {items.begin(), items.end()};
        }
      },
      Need(name, shape, meaning).items);
}

std::vector<Eigen::Vector3d> NpzSource::Vectors(std::string_view name, const NpzShape& shape,
                                                std::string_view meaning) {
  const std::vector<double> numbers = Numbers(name, shape, meaning);
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3) vectors.emplace_back(numbers.data() + i);
  return vectors;
}

std::vector<std::int64_t> NpzSource::Integers(std::string_view name, const NpzShape& shape,
                                              std::string_view meaning) {
  return std::visit(
      [&](const auto& items) -> std::vector<std::int64_t> {
        if constexpr (std::is_integral_v<typename std::decay_t<decltype(items)>::value_type>) {
          return std::vector<std::int64_t>(items.begin(), items.end());
        } else {
          Fail(fmt::format("array '{}' holds no whole numbers", name));
        }
      },
      Need(name, shape, meaning).items);
}

std::vector<std::string> NpzSource::Texts(std::string_view name, const NpzShape& shape,
                                          std::string_view meaning) {
  const NpzArray& array = Need(name, shape, meaning);
  if (const auto* texts = std::get_if<std::vector<std::string>>(&array.items)) return *texts;
  Fail(fmt::format("array '{}' holds no text", name));
}

double NpzSource::Number(std::string_view name) {
  return Numbers(name, NeedSingle(name).shape, "one number").front();
}

std::int64_t NpzSource::Integer(std::string_view name) {
  return Integers(name, NeedSingle(name).shape, "one number").front();
}

std::string NpzSource::Text(std::string_view name) {
  return Texts(name, NeedSingle(name).shape, "one text").front();
}

std::string NpzSource::Unread() const {
  std::string names;
  const auto add = [&](const std::string& name) {
    names.append(names.empty() ? "" : ", ").append(name);
  };
  for (const NpzArray& array : archive_.arrays) {
    if (std::ranges::find(read_, array.name) == read_.end()) add(array.name);
  }
  for (const NpzMember& member : archive_.members) add(member.name);
  return names;
}

void NpzTarget::AddVectors(std::string name, NpzShape shape,
                           const std::vector<Eigen::Vector3d>& vectors, double scale) {
  std::vector<double> numbers;
  numbers.reserve(vectors.size() * 3);
  for (const Eigen::Vector3d& vector : vectors) {
    for (const double number : vector) numbers.push_back(number * scale);
  }
  shape.push_back(3);
  Add(std::move(name), std::move(shape), std::move(numbers));
}

}  // namespace kinebase::internal
