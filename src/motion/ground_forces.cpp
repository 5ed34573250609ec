// Force plates as the User Guide of C3D defines them: what each type's channels mean, where the
// plate's axes lie, and from these the force, its centre and the moment about that.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/sto_motion.h"
#include "motion/sto_columns.h"

namespace kinebase {
namespace {

constexpr double kMetresPerCm = .01;

// In the plate's axes about the middle of its surface; N, m, N·m.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

// Where a plate lies in the world, m.
struct PlateFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // Columns: the plate's x, y, z.
};

// Corner 1 lies at (+x, +y) of the plate, 2 at (-x, +y), 3 at (-x, -y), 4 at (+x, -y).
std::optional<PlateFrame> FindFrame(const C3dForcePlate& plate, const Eigen::Matrix3d& to_world_m) {
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] = to_world_m * Eigen::Vector3f(plate.corners[i].data()).cast<double>();
  }
  const Eigen::Vector3d x = corners[0] - corners[1] + corners[3] - corners[2];
  const Eigen::Vector3d y = corners[0] - corners[3] + corners[1] - corners[2];
  const Eigen::Vector3d z = x.cross(y);
  if (!(z.norm() > 0) || !z.allFinite()) return std::nullopt;
  PlateFrame frame;
  frame.centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
  frame.axes.col(0) = x.normalized();
  frame.axes.col(2) = z.normalized();
  frame.axes.col(1) = frame.axes.col(2).cross(frame.axes.col(0));
  return frame;
}

// Metres in the unit of length behind the 'N' of a moment's unit; empty if it tells none.
std::optional<double> MetresInMoment(std::string_view unit) {
  std::string letters;
  for (const char c : ToLower(unit)) {
    if (c >= 'a' && c <= 'z') letters += c;
  }
  if (!letters.starts_with('n') || letters.size() < 2) return std::nullopt;
  const auto centimetres = CentimetresIn(std::string_view(letters).substr(1));
  if (!centimetres) return std::nullopt;
  return *centimetres * kMetresPerCm;
}

class Plate {
 public:
  // `samples` is [sample × channel].
  Plate(const C3dForcePlate& plate, const PlateFrame& frame, double metres_per_unit,
        std::span<const double> samples, std::size_t channel_count,
        const std::vector<std::string>& units)
      : plate_(plate),
        frame_(frame),
        metres_per_unit_(metres_per_unit),
        samples_(samples),
        channel_count_(channel_count) {
    origin_ = Eigen::Vector3f(plate.origin.data()).cast<double>() * metres_per_unit;
    // From the sensor up to the surface, and z points down: some writers have the sign wrong.
    if (origin_.z() > 0) origin_ = plate.type == 3 ? FlippedZ(origin_) : -origin_;
    moment_metres_ = metres_per_unit;
    if (plate.type != 3 && plate.channels.size() > 5) {
      const auto channel = static_cast<std::size_t>(plate.channels[5]);
      if (channel > 0 && channel <= units.size()) {
        moment_metres_ = MetresInMoment(units[channel - 1]).value_or(metres_per_unit);
      }
    }
  }

  static std::size_t ChannelsOf(int type) { return type == 3 ? 8 : 6; }

  // Force, place and moment of a sample in the world.
  void Sample(std::size_t sample, double* out) const {
    const std::vector<double> values = Values(sample);
    const Wrench wrench = plate_.type == 1   ? WrenchOfType1(values)
                          : plate_.type == 3 ? WrenchOfType3(values)
                                             : WrenchOfType2(values);
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    Eigen::Vector3d moment = wrench.moment;
    const Eigen::Vector3d& force = wrench.force;
    if (std::abs(force.z()) >= kSmallestPlateForce) {
      centre = {-moment.y() / force.z(), moment.x() / force.z(), 0};
      moment -= centre.cross(force);
    }
    const Eigen::Vector3d world_force = frame_.axes * force;
    const Eigen::Vector3d world_place = frame_.centre + frame_.axes * centre;
    const Eigen::Vector3d world_moment = frame_.axes * moment;
    for (int i = 0; i < 3; ++i) {
      out[i] = world_force[i];
      out[3 + i] = world_place[i];
      out[6 + i] = world_moment[i];
    }
  }

 private:
  static Eigen::Vector3d FlippedZ(const Eigen::Vector3d& v) { return {v.x(), v.y(), -v.z()}; }

  [[nodiscard]] std::vector<double> Values(std::size_t sample) const {
    std::vector<double> values;
    for (std::size_t i = 0; i < ChannelsOf(plate_.type); ++i) {
      const auto channel = static_cast<std::size_t>(plate_.channels[i]);
      values.push_back(channel == 0 ? 0 : samples_[sample * channel_count_ + channel - 1]);
    }
    if (plate_.type != 4 || plate_.calibration.size() < values.size() * values.size())
      return values;
    std::vector<double> calibrated(values.size(), 0.0);
    for (std::size_t row = 0; row < values.size(); ++row) {
      for (std::size_t column = 0; column < values.size(); ++column) {
        calibrated[row] +=
            static_cast<double>(plate_.calibration[row * plate_.calibration_columns + column]) *
            values[column];
      }
    }
    return calibrated;
  }

  // Fx Fy Fz Px Py Mz: the centre of pressure as it is, and the moment about it.
  [[nodiscard]] Wrench WrenchOfType1(const std::vector<double>& v) const {
    const Eigen::Vector3d force(v[0], v[1], v[2]);
    const Eigen::Vector3d centre(v[3] * metres_per_unit_, v[4] * metres_per_unit_, 0);
    return {force, centre.cross(force) + Eigen::Vector3d(0, 0, v[5] * moment_metres_)};
  }

  // Fx Fy Fz Mx My Mz about the sensor; `origin` leads from there to the middle of the surface.
  [[nodiscard]] Wrench WrenchOfType2(const std::vector<double>& v) const {
    const Eigen::Vector3d force(v[0], v[1], v[2]);
    const Eigen::Vector3d moment(v[3], v[4], v[5]);
    return {force, moment * moment_metres_ - origin_.cross(force)};
  }

  // Fx12 Fx34 Fy14 Fy23 Fz1 Fz2 Fz3 Fz4 of four sensors at (±a, ±b), the first two of `origin`.
  [[nodiscard]] Wrench WrenchOfType3(const std::vector<double>& v) const {
    const double a = origin_.x();
    const double b = origin_.y();
    const Eigen::Vector3d force(v[0] + v[1], v[2] + v[3], v[4] + v[5] + v[6] + v[7]);
    const Eigen::Vector3d moment(b * (v[4] + v[5] - v[6] - v[7]), a * (-v[4] + v[5] + v[6] - v[7]),
                                 b * (v[1] - v[0]) + a * (v[2] - v[3]));
    return {force, moment - Eigen::Vector3d(0, 0, origin_.z()).cross(force)};
  }

  const C3dForcePlate& plate_;
  const PlateFrame& frame_;
  double metres_per_unit_;
  std::span<const double> samples_;
  std::size_t channel_count_;
  Eigen::Vector3d origin_;
  double moment_metres_;
};

// Why a plate cannot be used; empty if it can.
std::string WhatIsWrong(const C3dForcePlate& plate, std::size_t channel_count) {
  if (plate.type < 1 || plate.type > 4) return fmt::format("type {} is unknown", plate.type);
  const std::size_t needed = Plate::ChannelsOf(plate.type);
  if (plate.channels.size() < needed) {
    return fmt::format("has {} channels of {}", plate.channels.size(), needed);
  }
  for (std::size_t i = 0; i < needed; ++i) {
    if (plate.channels[i] < 0 || static_cast<std::size_t>(plate.channels[i]) > channel_count) {
      return fmt::format("has channel {} of {}", plate.channels[i], channel_count);
    }
  }
  if (plate.type == 4 && (plate.calibration_columns < 6 || plate.calibration.size() < 36)) {
    return "has no calibration";
  }
  return {};
}

// The nine columns of a plate.
std::vector<internal::StoColumn> PlateColumns(std::size_t number, const Plate& plate,
                                              std::size_t sample_count, Diagnostics& diagnostics) {
  std::vector<internal::StoColumn> columns;
  for (const char* name : {"ground_force_{}_v", "ground_force_{}_p", "ground_torque_{}_"}) {
    for (const char axis : {'x', 'y', 'z'}) {
      columns.push_back({fmt::format(fmt::runtime(name), number) + axis, {}});
    }
  }
  double upward = 0;
  for (std::size_t sample = 0; sample < sample_count; ++sample) {
    std::array<double, 9> values;
    plate.Sample(sample, values.data());
    upward += values[1];
    for (std::size_t i = 0; i < values.size(); ++i) columns[i].values.push_back(values[i]);
  }
  if (upward >= 0) return columns;
  for (const std::size_t i : {0, 1, 2, 6, 7, 8}) {
    for (double& value : columns[i].values) value = -value;
  }
  diagnostics.push_back(
      {Severity::kInfo, fmt::format("force plate {} tells what pushes on it; the signs are turned "
                                    "to what it does to the feet",
                                    number)});
  return columns;
}

}  // namespace

StoTable ToGroundForces(const C3dRecording& c3d, const GroundForceOptions& options,
                        Diagnostics& diagnostics) {
  const double metres_per_unit = options.cm_per_unit * kMetresPerCm;
  const Eigen::Matrix3d to_world_m = ToYUp(options.up) * metres_per_unit;
  const std::vector<double> samples = ScaledAnalog(c3d);
  const std::vector<std::string> units = AnalogScaling(c3d).units;
  StoTable table{.header = {{"version", "1"}}, .in_degrees = false};
  table.times_s = internal::AnalogTimes(c3d);
  std::vector<internal::StoColumn> columns;
  std::size_t number = 0;
  for (const C3dForcePlate& plate : ForcePlates(c3d)) {
    ++number;
    std::string wrong = WhatIsWrong(plate, c3d.channel_count);
    const auto frame = FindFrame(plate, to_world_m);
    if (wrong.empty() && !frame) wrong = "has no corners";
    if (!wrong.empty()) {
      diagnostics.push_back(
          {Severity::kWarning, fmt::format("force plate {} {}; it is left out", number, wrong)});
      continue;
    }
    const Plate reader(plate, *frame, metres_per_unit, samples, c3d.channel_count, units);
    auto plate_columns = PlateColumns(number, reader, table.row_count(), diagnostics);
    columns.insert(columns.end(), plate_columns.begin(), plate_columns.end());
  }
  internal::SetColumns(table, columns);
  return table;
}

}  // namespace kinebase
