// Arrays of an NPZ by name, type and shape, with an error for each that is not as expected.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/formats/npz.h"
#include "kinebase/motion/motion.h"

namespace kinebase::internal {

using NpzShape = std::vector<std::size_t>;

// Reads arrays and remembers which were asked for.
class NpzSource {
 public:
  NpzSource(const NpzArchive& archive, const std::filesystem::path& file)
      : archive_(archive), file_(file) {}

  [[nodiscard]] bool Has(std::string_view name) const { return archive_.Find(name) != nullptr; }

  // Errors  MalformedFile, naming the arrays that are expected and those that are there.
  const NpzArray& Need(std::string_view name);

  // Numbers of any type. `shape` must fit exactly; `meaning` says what it is: "frames × 3".
  // Errors  MalformedFile: missing, not numbers, another shape.
  std::vector<double> Numbers(std::string_view name, const NpzShape& shape,
                              std::string_view meaning);
  std::vector<Eigen::Vector3d> Vectors(std::string_view name, const NpzShape& shape,
                                       std::string_view meaning);
  std::vector<std::int64_t> Integers(std::string_view name, const NpzShape& shape,
                                     std::string_view meaning);
  std::vector<std::string> Texts(std::string_view name, const NpzShape& shape,
                                 std::string_view meaning);

  // Single items; in an array of one item too.
  double Number(std::string_view name);
  std::int64_t Integer(std::string_view name);
  std::string Text(std::string_view name);

  // Arrays and other members that nobody asked for.
  [[nodiscard]] std::string Unread() const;

  [[noreturn]] void Fail(const std::string& message) const;

 private:
  const NpzArray& Need(std::string_view name, const NpzShape& shape, std::string_view meaning);
  const NpzArray& NeedSingle(std::string_view name);

  const NpzArchive& archive_;
  const std::filesystem::path& file_;
  std::vector<std::string> read_;
};

// Collects arrays.
class NpzTarget {
 public:
  void Add(std::string name, NpzShape shape, NpzItems items) {
    archive_.arrays.push_back({std::move(name), std::move(shape), std::move(items)});
  }
  void Add(std::string name, double value) { Add(std::move(name), {}, std::vector{value}); }
  void Add(std::string name, std::int64_t value) { Add(std::move(name), {}, std::vector{value}); }
  void Add(std::string name, std::string text) {
    Add(std::move(name), {}, std::vector<std::string>{std::move(text)});
  }
  // [… × 3], times `scale`.
  void AddVectors(std::string name, NpzShape shape, const std::vector<Eigen::Vector3d>& vectors,
                  double scale);

  NpzArchive Take() { return std::move(archive_); }

 private:
  NpzArchive archive_;
};

// The skeleton of a motion, lengths divided by `unit_cm`. What comes back is the same to the bit
// where that is 1.
void AddSkeleton(const Skeleton& skeleton, double unit_cm, NpzTarget& target);

// Errors  MalformedFile: no tree of bones, an unknown DOF or Euler order, arrays that do not fit.
[[nodiscard]] std::shared_ptr<const Skeleton> TakeSkeleton(NpzSource& source, double unit_cm);

}  // namespace kinebase::internal
