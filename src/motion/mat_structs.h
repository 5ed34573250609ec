// The structures `skel` and `mot` of HDM05's MATLAB tools.
//
// Indices in them count from 1, and 0 is none; lengths are in inches (as the original cache files
// have them, whatever the documentation says) unless said otherwise; angles are in degrees.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 3.1; docs/formats/mat.md.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "kinebase/core/diagnostic.h"
#include "kinebase/formats/mat.h"
#include "kinebase/motion/marker_cloud.h"
#include "kinebase/motion/motion.h"

namespace kinebase::internal {

// unit_cm  Centimetres in the unit of what is written.
[[nodiscard]] MatArray SkelOf(const Skeleton& skeleton, double unit_cm);
[[nodiscard]] MatArray MotOf(const Motion& motion, const std::string& file_name, double unit_cm);

// As the tools make them of a C3D file: trajectories and names, no nodes and no rotations.
[[nodiscard]] MatArray SkelOf(const MarkerCloud& markers, const std::string& file_name);
[[nodiscard]] MatArray MotOf(const MarkerCloud& markers, const std::string& file_name,
                             double unit_cm);

// A structure of a file with an error for each field that is not as expected.
class MatStructReader {
 public:
  // name  For messages: "skel".
  MatStructReader(const MatArray& structure, std::string name, const std::filesystem::path& file);

  [[nodiscard]] std::size_t size() const { return structure_.size(); }
  // Null if the field is not there.
  [[nodiscard]] const MatArray* Find(std::string_view field, std::size_t element = 0) const {
    return structure_.Field(field, element);
  }
  // Errors  MalformedFile for all of these: no such field, or not what is asked for.
  [[nodiscard]] const MatArray& Need(std::string_view field, std::size_t element = 0) const;
  [[nodiscard]] std::vector<double> Numbers(std::string_view field, std::size_t element = 0) const;
  [[nodiscard]] double Number(std::string_view field, std::size_t element = 0) const;
  [[nodiscard]] Eigen::Vector3d Vector(std::string_view field, std::size_t element = 0) const;
  [[nodiscard]] std::string Text(std::string_view field, std::size_t element = 0) const;
  // A cell array of texts; a single text is one line, [] is none.
  [[nodiscard]] std::vector<std::string> Texts(std::string_view field,
                                               std::size_t element = 0) const;
  [[nodiscard]] MatStructReader Struct(std::string_view field) const;

  [[noreturn]] void Fail(std::string_view field, std::size_t element,
                         const std::string& message) const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  const MatArray& structure_;
  std::string name_;
  const std::filesystem::path& file_;
};

// Whether there are nodes and rotations; else `mot` has trajectories only.
[[nodiscard]] bool HasRotations(const MatStructReader& skel, const MatStructReader& mot);

[[nodiscard]] std::shared_ptr<const Skeleton> TakeSkel(const MatStructReader& skel, double unit_cm);

// Without rate: see RateOf.
// diagnostics  Trajectories that the rotations do not lead to.
[[nodiscard]] Motion TakeMot(const MatStructReader& mot, std::shared_ptr<const Skeleton> skeleton,
                             double unit_cm, Diagnostics& diagnostics);
[[nodiscard]] MarkerCloud TakeTrajectories(const MatStructReader& mot, double unit_cm);

// The rate that the file tells; 0 if it tells none that a recording can have.
[[nodiscard]] double RateOf(const MatStructReader& mot);

}  // namespace kinebase::internal
