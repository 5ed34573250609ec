#include "synth/timeline.h"

#include <algorithm>
#include <cmath>

namespace kinebase::internal {

void Track::Set(double time_s, double value) {
  const auto place = std::lower_bound(keys_.begin(), keys_.end(), time_s,
                                      [](const Key& key, double t) { return key.time_s < t; });
  if (place != keys_.end() && place->time_s == time_s) {
    place->value = value;
  } else {
    keys_.insert(place, {time_s, value, 0});
  }
}

void Track::Finish() {
  for (std::size_t i = 1; i + 1 < keys_.size(); ++i) {
    const double before_s = keys_[i].time_s - keys_[i - 1].time_s;
    const double after_s = keys_[i + 1].time_s - keys_[i].time_s;
    const double before = (keys_[i].value - keys_[i - 1].value) / before_s;
    const double after = (keys_[i + 1].value - keys_[i].value) / after_s;
    if (before * after <= 0) continue;
    const double share = (before_s + 2 * after_s) / (3 * (before_s + after_s));
    keys_[i].slope = before * after / (share * after + (1 - share) * before);
  }
}

double Track::At(double time_s) const {
  if (time_s <= keys_.front().time_s) return keys_.front().value;
  if (time_s >= keys_.back().time_s) return keys_.back().value;
  const auto after = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                      [](double t, const Key& key) { return t < key.time_s; });
  const Key& a = *(after - 1);
  const Key& b = *after;
  const double span = b.time_s - a.time_s;
  const double u = (time_s - a.time_s) / span;
  const double v = 1 - u;
  return v * v * (1 + 2 * u) * a.value + u * u * (1 + 2 * v) * b.value +
         u * v * span * (v * a.slope - u * b.slope);
}

Timeline::Timeline(const Pose& rest) : rest_(rest) {}

void Timeline::Set(double time_s, int channel, double value) {
  tracks_[channel].Set(time_s, value);
}

void Timeline::Set(double time_s, Body channel, double value) {
  Set(time_s, ChannelOf(channel), value);
}

void Timeline::Set(double time_s, Limb channel, Side side, double value) {
  Set(time_s, ChannelOf(channel, side), value);
}

void Timeline::SetBoth(double time_s, Limb channel, double value) {
  Set(time_s, channel, Side::kLeft, value);
  Set(time_s, channel, Side::kRight, value);
}

void Timeline::Finish(double duration_s) { FinishOpen(duration_s, false, false); }

void Timeline::FinishOpen(double duration_s, bool open_begin, bool open_end) {
  duration_s_ = duration_s;
  for (int channel = 0; channel < kChannelCount; ++channel) {
    Track& track = tracks_[channel];
    if (track.empty()) {
      track.Set(0, rest_.values[channel]);
      continue;
    }
    const double rest = rest_.values[channel];
    if (!open_begin) track.Set(0, rest);
    if (!open_end && track.last_time_s() < duration_s) {
      // After a full turn of an arm the way back to rest is not to turn it back.
      const double turns = IsPlace(channel) ? 0 : std::round((track.last_value() - rest) / 360);
      track.Set(duration_s, rest + 360 * turns);
    }
    track.Finish();
  }
}

Pose Timeline::At(double time_s) const {
  Pose pose;
  for (int channel = 0; channel < kChannelCount; ++channel) {
    pose.values[channel] = tracks_[channel].At(time_s);
  }
  return pose;
}

}  // namespace kinebase::internal
