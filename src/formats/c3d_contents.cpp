// What parameters mean together: labels, analog scaling, force plates.

#include <algorithm>
#include <cmath>

#include "formats/c3d_layout.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr std::size_t kPlaneCoordinates = 12;  // Of the four corners of a force plate.

std::optional<std::size_t> UnsignedCount(const C3dRecording& recording, std::string_view group,
                                         std::string_view name) {
  const C3dParameter* parameter = FindParameter(recording, group, name);
  const auto number = parameter == nullptr ? std::nullopt : parameter->UnsignedNumber();
  if (!number || !(*number >= 0 && *number <= 65535)) return std::nullopt;
  return static_cast<std::size_t>(*number);
}

// Those of the force plate `plate` where each has `count`.
std::vector<float> PlateValues(const C3dRecording& recording, std::string_view name,
                               std::size_t plate, std::size_t count) {
  std::vector<float> values;
  const C3dParameter* parameter = FindParameter(recording, "FORCE_PLATFORM", name);
  if (parameter == nullptr || (plate + 1) * count > parameter->size()) return values;
  for (std::size_t i = 0; i < count; ++i) {
    values.push_back(static_cast<float>(parameter->Number(plate * count + i).value_or(0)));
  }
  return values;
}

std::vector<int> PlateChannels(const C3dRecording& recording, std::size_t plate) {
  const C3dParameter* parameter = FindParameter(recording, "FORCE_PLATFORM", "CHANNEL");
  if (parameter == nullptr || parameter->dimensions.empty()) return {};
  const std::size_t count = parameter->dimensions.front();
  if ((plate + 1) * count > parameter->size()) return {};
  std::vector<int> channels;
  for (std::size_t i = 0; i < count; ++i) {
    channels.push_back(
        static_cast<int>(std::clamp(parameter->Number(plate * count + i).value_or(0), 0., 65535.)));
  }
  return channels;
}

// The matrices are stored column by column.
void AddCalibration(const C3dRecording& recording, std::size_t plate, C3dForcePlate& result) {
  const C3dParameter* parameter = FindParameter(recording, "FORCE_PLATFORM", "CAL_MATRIX");
  if (parameter == nullptr || parameter->dimensions.size() < 2) return;
  const std::size_t rows = parameter->dimensions[0];
  const std::size_t columns = parameter->dimensions[1];
  const std::vector<float> stored = PlateValues(recording, "CAL_MATRIX", plate, rows * columns);
  if (stored.empty()) return;
  result.calibration_columns = columns;
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      result.calibration.push_back(stored[column * rows + row]);
    }
  }
}

std::vector<std::string> Labels(const C3dRecording& recording, std::string_view group,
                                std::size_t count) {
  std::vector<std::string> labels = TextList(recording, group, "LABELS");
  labels.resize(count);
  return labels;
}

}  // namespace

std::vector<std::string> PointLabels(const C3dRecording& recording) {
  return Labels(recording, "POINT", recording.point_count);
}

std::vector<std::string> ChannelLabels(const C3dRecording& recording) {
  return Labels(recording, "ANALOG", recording.channel_count);
}

bool HasUnsignedAnalog(const C3dRecording& recording) {
  const C3dParameter* format = FindParameter(recording, "ANALOG", "FORMAT");
  const auto texts = format == nullptr ? std::vector<std::string>() : format->Strings();
  return !texts.empty() && EqualsIgnoringCase(Trim(texts.front()), "UNSIGNED");
}

C3dAnalogScaling AnalogScaling(const C3dRecording& recording) {
  C3dAnalogScaling scaling;
  const C3dParameter* general = FindParameter(recording, "ANALOG", "GEN_SCALE");
  if (general != nullptr) scaling.general_scale = general->Number().value_or(1);
  if (scaling.general_scale == 0) scaling.general_scale = 1;  // Never filled in.
  scaling.scale = NumberList(recording, "ANALOG", "SCALE");
  scaling.scale.resize(recording.channel_count, 1);
  const bool is_unsigned = HasUnsignedAnalog(recording);
  scaling.offset = NumberList(recording, "ANALOG", "OFFSET", is_unsigned);
  // So one maker's programs call it.
  if (scaling.offset.empty()) {
    scaling.offset = NumberList(recording, "ANALOG", "OFFSETS", is_unsigned);
  }
  scaling.offset.resize(recording.channel_count, 0);
  scaling.units = TextList(recording, "ANALOG", "UNITS");
  scaling.units.resize(recording.channel_count);
  return scaling;
}

std::vector<double> ScaledAnalog(const C3dRecording& recording) {
  const C3dAnalogScaling scaling = AnalogScaling(recording);
  std::vector<double> values;
  values.reserve(recording.analog.size());
  while (values.size() < recording.analog.size()) {
    for (std::size_t channel = 0; channel < recording.channel_count; ++channel) {
      const double stored = static_cast<double>(recording.analog[values.size()]);
      values.push_back((stored - scaling.offset[channel]) * scaling.scale[channel] *
                       scaling.general_scale);
    }
  }
  return values;
}

std::vector<C3dForcePlate> ForcePlates(const C3dRecording& recording) {
  const C3dParameter* types = FindParameter(recording, "FORCE_PLATFORM", "TYPE");
  const std::size_t typed = types == nullptr ? 0 : types->size();
  const std::size_t used = UnsignedCount(recording, "FORCE_PLATFORM", "USED").value_or(typed);
  std::vector<C3dForcePlate> plates;
  for (std::size_t i = 0; i < std::min(used, typed); ++i) {
    C3dForcePlate plate;
    plate.type = static_cast<int>(std::clamp(types->Number(i).value_or(0), 0., 255.));
    const auto corners = PlateValues(recording, "CORNERS", i, kPlaneCoordinates);
    for (std::size_t k = 0; k < corners.size(); ++k) plate.corners[k / 3][k % 3] = corners[k];
    const auto origin = PlateValues(recording, "ORIGIN", i, 3);
    std::ranges::copy(origin, plate.origin.begin());
    plate.channels = PlateChannels(recording, i);
    AddCalibration(recording, i, plate);
    plates.push_back(std::move(plate));
  }
  return plates;
}

}  // namespace kinebase
