// Parameters that tell again what the record's fields tell: each is set right, none is left to lie.

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/c3d_layout.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {
namespace {

constexpr double kMaxField = 4294967295.0;
constexpr std::size_t kExactInFloat = 1 << 24;

bool FitsInt16(double value) {
  return value == std::floor(value) && value >= -32768 && value <= 65535;
}

void SetIfPresent(C3dRecording& recording, std::string_view group, std::string_view name,
                  double value) {
  C3dParameter* parameter = FindParameterToEdit(recording, group, name);
  if (parameter != nullptr && parameter->Number()) SetNumber(*parameter, 0, value);
}

// Two words where there are two, as the user guide has it; one number where there is one.
void SetTrialField(C3dParameter& parameter, std::int64_t frame) {
  const auto number = static_cast<double>(frame);
  auto* words = std::get_if<std::vector<std::int16_t>>(&parameter.values);
  if (words == nullptr || words->size() < 2) {
    if (parameter.Number()) SetNumber(parameter, 0, number);
    return;
  }
  (*words)[0] = static_cast<std::int16_t>(frame & 0xffff);
  (*words)[1] = static_cast<std::int16_t>((frame >> 16) & 0xffff);
}

void AlignTrialField(C3dRecording& recording, std::string_view name, std::int64_t frame,
                     bool is_needed) {
  if (is_needed && !TrialField(recording, name)) {
    SetParameter(
        recording, "TRIAL",
        {.name = std::string(name), .dimensions = {2}, .values = std::vector<std::int16_t>(2)});
  }
  if (C3dParameter* parameter = FindParameterToEdit(recording, "TRIAL", name)) {
    SetTrialField(*parameter, frame);
  }
}

void AlignFrames(C3dRecording& recording) {
  const auto frames = static_cast<double>(recording.frame_count);
  const C3dParameter* parameter = FindParameter(recording, "POINT", "FRAMES");
  const bool is_real =
      parameter != nullptr && std::holds_alternative<std::vector<float>>(parameter->values);
  SetIfPresent(recording, "POINT", "FRAMES",
               is_real ? frames : std::min(frames, static_cast<double>(kC3dMaxWord)));

  const bool has_many = recording.frame_count > kC3dMaxWord;
  const C3dParameter* long_frames = FindParameter(recording, "POINT", "LONG_FRAMES");
  const bool is_told =
      (long_frames != nullptr && long_frames->Number()) ||
      (TrialField(recording, "ACTUAL_START_FIELD") && TrialField(recording, "ACTUAL_END_FIELD"));
  if (has_many && !is_told) SetParameter(recording, "POINT", RealParameter("LONG_FRAMES", 0));
  SetIfPresent(recording, "POINT", "LONG_FRAMES", frames);
  const bool needs_trial = (has_many && !is_told) || recording.frame_count > kExactInFloat ||
                           recording.first_frame > static_cast<std::int64_t>(kC3dMaxWord);
  AlignTrialField(recording, "ACTUAL_START_FIELD", recording.first_frame, needs_trial);
  AlignTrialField(recording, "ACTUAL_END_FIELD", recording.last_frame(), needs_trial);
}

}  // namespace

void SetNumber(C3dParameter& parameter, std::size_t index, double value) {
  if (auto* bytes = std::get_if<std::vector<std::int8_t>>(&parameter.values)) {
    if (value == std::floor(value) && value >= -128 && value <= 255) {
      (*bytes)[index] = static_cast<std::int8_t>(static_cast<int>(value));
      return;
    }
    std::vector<std::int16_t> wider(bytes->begin(), bytes->end());
    parameter.values = std::move(wider);
  }
  if (auto* words = std::get_if<std::vector<std::int16_t>>(&parameter.values)) {
    if (FitsInt16(value)) {
      (*words)[index] = static_cast<std::int16_t>(static_cast<int>(value));
      return;
    }
    std::vector<float> wider(words->begin(), words->end());
    parameter.values = std::move(wider);
  }
  if (auto* reals = std::get_if<std::vector<float>>(&parameter.values)) {
    (*reals)[index] = static_cast<float>(value);
  }
}

std::optional<std::int64_t> TrialField(const C3dRecording& recording, std::string_view name) {
  const C3dParameter* parameter = FindParameter(recording, "TRIAL", name);
  if (parameter == nullptr) return std::nullopt;
  const auto low = parameter->UnsignedNumber(0);
  if (!low || !(*low >= 0 && *low <= kMaxField)) return std::nullopt;
  const bool has_words = std::holds_alternative<std::vector<std::int16_t>>(parameter->values);
  const double high = has_words ? parameter->UnsignedNumber(1).value_or(0) : 0;
  return std::llround(*low) + std::llround(high) * 65536;
}

void AlignParameters(C3dRecording& recording) {
  SetIfPresent(recording, "POINT", "USED", static_cast<double>(recording.point_count));
  const double sign = recording.storage == C3dStorage::kFloat ? -1 : 1;
  SetIfPresent(recording, "POINT", "SCALE", sign * recording.scale);
  SetIfPresent(recording, "POINT", "RATE", recording.rate_hz);
  AlignFrames(recording);
  SetIfPresent(recording, "ANALOG", "USED", static_cast<double>(recording.channel_count));
  const C3dParameter* rate = FindParameter(recording, "ANALOG", "RATE");
  if (recording.channel_count == 0 || rate == nullptr || !rate->Number()) return;
  // The file's own figure stays where it comes to the same, however it was rounded.
  const double ratio = *rate->Number() / recording.rate_hz;
  if (recording.rate_hz > 0 &&
      !(std::abs(ratio - static_cast<double>(recording.subframe_count)) < .5)) {
    SetIfPresent(
        recording, "ANALOG", "RATE",
        static_cast<double>(recording.rate_hz) * static_cast<double>(recording.subframe_count));
  }
}

}  // namespace kinebase::internal
