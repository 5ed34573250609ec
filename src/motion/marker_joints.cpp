#include "kinebase/motion/marker_joints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"

namespace kinebase {
namespace {

constexpr double kLongGapS = 0.5;

// A marker in every frame.
using Track = std::vector<Eigen::Vector3d>;

// What is missing lies on the line between its neighbours in time, or stays where it was.
int FillGaps(Track& track, const std::vector<bool>& is_missing) {
  int longest = 0;
  const int frames = static_cast<int>(track.size());
  for (int frame = 0; frame < frames; ++frame) {
    if (!is_missing[frame]) continue;
    int end = frame;
    while (end < frames && is_missing[end]) ++end;
    longest = std::max(longest, end - frame);
    const Eigen::Vector3d after = end < frames ? track[end] : track[frame - 1];
    const Eigen::Vector3d before = frame > 0 ? track[frame - 1] : after;
    for (int i = frame; i < end; ++i) {
      track[i] = before + (after - before) * ((i - frame + 1.0) / (end - frame + 1.0));
    }
    frame = end;
  }
  return longest;
}

// The markers of one set that a recording has, with their gaps filled.
class MarkerTracks {
 public:
  MarkerTracks(const MarkerCloud& markers, const MarkerSet& set) : markers_(markers), set_(set) {}

  // Null if no label of the marker is there, or it is never seen.
  const Track* Find(const std::string& name) {
    const auto known = tracks_.find(name);
    if (known != tracks_.end()) return known->second ? &*known->second : nullptr;
    auto& track = tracks_[name];
    for (const std::string& label : set_.LabelsOf(name)) {
      const auto marker = markers_.FindMarker(label);
      if (marker) track = Load(*marker);
      if (track) break;
    }
    return track ? &*track : nullptr;
  }

  bool HasAll(const MarkerSet::Names& names) {
    return std::ranges::all_of(names,
                               [&](const std::string& name) { return Find(name) != nullptr; });
  }

  // The middle of markers that are all there.
  Eigen::Vector3d Middle(const MarkerSet::Names& names, int frame) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const std::string& name : names) sum += (*Find(name))[static_cast<std::size_t>(frame)];
    return sum / static_cast<double>(names.size());
  }

  void ReportGaps(Diagnostics& diagnostics) const {
    for (const auto& [marker, longest] : longest_gaps_) {
      const double seconds = longest / markers_.rate_hz;
      if (!(seconds > kLongGapS)) continue;
      diagnostics.push_back(
          {Severity::kWarning,
           fmt::format("marker {} is missing for up to {:.2f} s; the joints near it are "
                       "interpolated there",
                       markers_.labels[static_cast<std::size_t>(marker)], seconds)});
    }
  }

 private:
  std::optional<Track> Load(int marker) {
    Track track(static_cast<std::size_t>(markers_.frame_count));
    std::vector<bool> is_missing(track.size());
    for (int frame = 0; frame < markers_.frame_count; ++frame) {
      track[frame] = markers_.at(frame, marker);
      is_missing[frame] = markers_.is_missing(frame, marker) || !track[frame].allFinite();
    }
    if (std::ranges::find(is_missing, false) == is_missing.end()) return std::nullopt;
    longest_gaps_[marker] = FillGaps(track, is_missing);
    return track;
  }

  const MarkerCloud& markers_;
  const MarkerSet& set_;
  std::map<std::string, std::optional<Track>> tracks_;
  std::map<int, int> longest_gaps_;  // In frames, by marker.
};

bool Fits(const MarkerSet::JointRow& row, const MarkerSet& set, MarkerTracks& tracks) {
  if (!tracks.HasAll(row.markers)) return false;
  if (row.axes.empty()) return true;
  const MarkerSet::Axes& axes = set.axes.find(row.axes)->second;
  return tracks.HasAll(axes.first.from) && tracks.HasAll(axes.first.to) &&
         tracks.HasAll(axes.second.from) && tracks.HasAll(axes.second.to);
}

using JointRows = std::array<const MarkerSet::JointRow*, kStandardJointCount>;

// The first row of each joint whose markers are there; null where none is.
JointRows ChooseRows(const MarkerSet& set, MarkerTracks& tracks) {
  JointRows rows{};
  for (const MarkerSet::JointRow& row : set.joints) {
    auto& chosen = rows[static_cast<std::size_t>(row.joint)];
    if (chosen == nullptr && Fits(row, set, tracks)) chosen = &row;
  }
  return rows;
}

// Columns: left, up, forward. Where markers lie so that an axis has no direction, nothing.
std::optional<Eigen::Matrix3d> AxesAt(const MarkerSet::Axes& axes, MarkerTracks& tracks,
                                      int frame) {
  constexpr double kTooShortCm = 1e-6;
  const auto direction = [&](const MarkerSet::Axis& axis) -> Eigen::Vector3d {
    return tracks.Middle(axis.to, frame) - tracks.Middle(axis.from, frame);
  };
  Eigen::Vector3d first = direction(axes.first);
  if (first.norm() < kTooShortCm) return std::nullopt;
  first.normalize();
  Eigen::Vector3d second = direction(axes.second);
  second -= second.dot(first) * first;
  if (second.norm() < kTooShortCm) return std::nullopt;
  second.normalize();
  const int a = static_cast<int>(axes.first.direction);
  const int b = static_cast<int>(axes.second.direction);
  Eigen::Matrix3d columns;
  columns.col(a) = first;
  columns.col(b) = second;
  // left × up = forward, and so on in turn.
  columns.col(3 - a - b) = (b - a + 3) % 3 == 1 ? first.cross(second) : second.cross(first);
  return columns;
}

// How much larger the person is than the one the set's distances are of.
double SizeOf(const MarkerSet& set, MarkerTracks& tracks, int frames) {
  if (set.size_from.empty() || !tracks.HasAll(set.size_from) || !tracks.HasAll(set.size_to)) {
    return 1;
  }
  std::vector<double> lengths;
  lengths.reserve(static_cast<std::size_t>(frames));
  for (int frame = 0; frame < frames; ++frame) {
    lengths.push_back(
        (tracks.Middle(set.size_to, frame) - tracks.Middle(set.size_from, frame)).norm());
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::ranges::nth_element(lengths, middle);
  return *middle / set.size_cm;
}

void PlaceJoint(const MarkerSet::JointRow& row, const MarkerSet& set, double size,
                MarkerTracks& tracks, JointTrajectories& joints) {
  // A frame whose axes are undefined takes those of the frame before.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const auto frames = static_cast<int>(joints.positions_cm.size()) / kStandardJointCount;
  for (int frame = 0; frame < frames; ++frame) {
    Eigen::Vector3d position = tracks.Middle(row.markers, frame);
    if (!row.axes.empty()) {
      axes = AxesAt(set.axes.find(row.axes)->second, tracks, frame).value_or(axes);
      position += axes * row.move_cm * size;
    }
    joints.positions_cm[static_cast<std::size_t>(frame) * kStandardJointCount +
                        static_cast<std::size_t>(row.joint)] = position;
  }
}

MarkerJoints PlaceJoints(const MarkerCloud& markers, const MarkerSet& set, const JointRows& rows,
                         MarkerTracks& tracks) {
  MarkerJoints result{.marker_set = set.name};
  result.joints = {.rate_hz = markers.rate_hz, .joint_count = kStandardJointCount};
  result.joints.positions_cm.resize(static_cast<std::size_t>(markers.frame_count) *
                                    kStandardJointCount);
  const double size = SizeOf(set, tracks, markers.frame_count);
  for (const MarkerSet::JointRow* row : rows) {
    PlaceJoint(*row, set, size, tracks, result.joints);
    std::string source;
    for (const std::string& name : row->markers) source += (source.empty() ? "" : ", ") + name;
    result.sources.push_back({row->joint, source, JointMatch::kTable, row->confidence});
  }
  return result;
}

// What a set that does not fit would need: for each joint without a row the markers of its first.
std::string WhatIsMissing(const MarkerSet& set, const JointRows& rows, MarkerTracks& tracks) {
  std::set<std::string> missing;
  for (const MarkerSet::JointRow& row : set.joints) {
    if (rows[static_cast<std::size_t>(row.joint)] != nullptr) continue;
    for (const std::string& name : row.markers) {
      if (tracks.Find(name) == nullptr) missing.insert(name);
    }
  }
  std::string text;
  for (const std::string& name : missing) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void ReportSubjects(const MarkerCloud& markers, Diagnostics& diagnostics) {
  std::set<std::string_view> subjects;
  for (const std::string& label : markers.labels) {
    const std::string_view bare = BareLabel(label);
    if (bare.size() < label.size()) {
      subjects.insert(std::string_view(label).substr(0, label.size() - bare.size() - 1));
    }
  }
  if (subjects.size() < 2) return;
  std::string names;
  for (const std::string_view subject : subjects) {
    names.append(names.empty() ? "" : ", ").append(subject);
  }
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("markers of {} subjects ({}); of equal names the first is taken",
                   subjects.size(), names)});
}

}  // namespace

MarkerJoints ApproximateJoints(const MarkerCloud& markers, std::span<const MarkerSet> sets,
                               Diagnostics& diagnostics) {
  if (markers.frame_count == 0) throw Error(ErrorCode::kMismatch, "there are no frames");
  if (markers.labels.empty()) throw Error(ErrorCode::kMismatch, "there are no markers");
  const auto is_missing = [](MarkerState state) { return state == MarkerState::kMissing; };
  if (std::ranges::all_of(markers.states, is_missing)) {
    throw Error(ErrorCode::kMismatch, "no marker is there in any frame");
  }
  std::string nearest = "no set knows any of their names";
  std::ptrdiff_t most_joints = 0;
  for (const MarkerSet& set : sets) {
    MarkerTracks tracks(markers, set);
    const JointRows rows = ChooseRows(set, tracks);
    const auto joints = kStandardJointCount - std::ranges::count(rows, nullptr);
    if (joints == kStandardJointCount) {
      MarkerJoints result = PlaceJoints(markers, set, rows, tracks);
      tracks.ReportGaps(diagnostics);
      ReportSubjects(markers, diagnostics);
      return result;
    }
    if (joints > most_joints) {
      most_joints = joints;
      nearest = fmt::format("the nearest, '{}', places {} of {} joints and lacks {}", set.name,
                            joints, kStandardJointCount, WhatIsMissing(set, rows, tracks));
    }
  }
  throw Error(ErrorCode::kMismatch,
              "the markers fit no set that tells where the joints are; " + nearest +
                  "; --names F.mnm says which of the file's names is which marker");
}

}  // namespace kinebase
