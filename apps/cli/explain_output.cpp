#include "cli/explain_output.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <string_view>

#include "fmt/format.h"

namespace kinebase::cli {
namespace {

constexpr int kAxes = 3;

Json NamesOf(std::uint64_t word, const FeatureSet& features) {
  Json names = Json::array();
  for (int feature = 0; feature < features.feature_count(); ++feature) {
    if (((word >> feature) & 1U) != 0) names.push_back(features.features[feature].id);
  }
  return names;
}

// As the person sees it whose body it is.
std::string_view DirectionOf(const JointOffset& offset) {
  constexpr std::array<std::string_view, kAxes> kAbove = {"too far left", "too high",
                                                          "too far forward"};
  constexpr std::array<std::string_view, kAxes> kBelow = {"too far right", "too low",
                                                          "too far back"};
  return (offset.off > 0 ? kAbove : kBelow)[static_cast<std::size_t>(offset.axis)];
}

FrameRange FramesOf(const Explained& explained, int column) {
  const TakeFeatures& take = explained.take;
  return FramesOfColumns(column, column, take.features.rate_hz, take.rate_hz, take.frame_count);
}

Json ToJson(const JointOffset& offset) {
  return {{"joint", ToString(offset.joint)},
          {"direction", DirectionOf(offset)},
          {"spreads", std::abs(offset.off)},
          {"cost", offset.cost}};
}

Json PathToJson(const Explained& explained) {
  constexpr std::size_t kMostOffsets = 3;  // Of a cell; the rest is noise.
  Json path = Json::array();
  for (std::size_t i = 0; i < explained.explanation.cells.size(); ++i) {
    const ExplainedCell& cell = explained.explanation.cells[i];
    Json entry = {{"template_column", cell.cell.template_column},
                  {"column", cell.cell.recording_column},
                  {"cost", cell.cost},
                  {"agreed", NamesOf(cell.agreed, explained.features)},
                  {"disagreed", NamesOf(cell.disagreed, explained.features)}};
    if (explained.has_poses()) {
      double cost = 0;
      for (int value = 0; value < kPoseValues; ++value) {
        cost +=
            explained.explanation.places[i * kPoseValues + static_cast<std::size_t>(value)].cost;
      }
      Json off = Json::array();
      for (const JointOffset& offset : OffsetsOfCell(explained.explanation, i)) {
        if (off.size() == kMostOffsets) break;
        off.push_back(ToJson(offset));
      }
      entry["poses_cost"] = cost;
      entry["off"] = std::move(off);
    }
    path.push_back(std::move(entry));
  }
  return path;
}

Json FeaturesToJson(const Explained& explained) {
  Json features = Json::array();
  for (const FeatureTally& tally : explained.tallies) {
    const Feature& feature = explained.features.features[tally.feature];
    features.push_back({{"id", feature.id},
                        {"name", feature.name},
                        {"agreed", tally.agreed},
                        {"disagreed", tally.disagreed},
                        {"cost", tally.cost}});
  }
  return features;
}

Json JointsToJson(const Explained& explained) {
  Json joints = Json::array();
  for (const JointTally& tally : explained.joints) {
    Json most = ToJson(tally.most);
    most.erase("joint");
    most["frame"] = FramesOf(explained, tally.most.column).first + 1;
    joints.push_back({{"joint", ToString(tally.joint)}, {"cost", tally.cost}, {"most_off", most}});
  }
  return joints;
}

Json RivalToJson(const Explained& explained) {
  const std::optional<ExplainedRival>& rival = explained.explanation.rival;
  if (!rival) return {};
  return {{"template", explained.template_names[rival->motion_template]},
          {"first_frame", rival->hit.first_frame},
          {"last_frame", rival->hit.last_frame},
          {"cost", rival->hit.cost},
          {"penalty", explained.explanation.hit.score - explained.explanation.hit.cost}};
}

// Rows of features that were not as asked.
std::string FeatureTable(const Explained& explained) {
  TextTable table({"feature", "name", ">as asked", ">not", ">cost"});
  for (const FeatureTally& tally : explained.tallies) {
    if (tally.disagreed == 0) continue;
    const Feature& feature = explained.features.features[tally.feature];
    table.Add({feature.id, feature.name, std::to_string(tally.agreed),
               std::to_string(tally.disagreed), fmt::format("{:.4f}", tally.cost)});
  }
  return table.ToString();
}

// The dearest joints, and all others together.
std::string JointTable(const Explained& explained) {
  constexpr std::size_t kMostJoints = 10;
  TextTable table({"joint", ">cost", "most off", ">frame"});
  const std::size_t shown = std::min(explained.joints.size(), kMostJoints);
  for (const JointTally& tally : std::span(explained.joints).first(shown)) {
    table.Add({std::string(ToString(tally.joint)), fmt::format("{:.4f}", tally.cost),
               fmt::format("{:.1f} spreads {}", std::abs(tally.most.off), DirectionOf(tally.most)),
               std::to_string(FramesOf(explained, tally.most.column).first + 1)});
  }
  double rest = 0;
  for (const JointTally& tally : std::span(explained.joints).subspan(shown)) rest += tally.cost;
  if (rest > 0) {
    table.Add({fmt::format("{} more", explained.joints.size() - shown), fmt::format("{:.4f}", rest),
               "", ""});
  }
  return table.ToString();
}

// What beside the features counts.
std::string ContrastText(const Explained& explained) {
  const HitExplanation& explanation = explained.explanation;
  const TakeHit& hit = explanation.hit;
  std::string text =
      explanation.lookalikes_cost > 0
          ? fmt::format("features {:.4f}, poses {:.4f} and look-alikes {:.4f}",
                        explanation.matching, explanation.places_cost, explanation.lookalikes_cost)
          : fmt::format("features {:.4f} and poses {:.4f}", explanation.matching,
                        explanation.places_cost);
  if (hit.confidence) text += fmt::format("; confidence {:.2f}", *hit.confidence);
  text += '\n';
  if (explanation.rival) {
    const ExplainedRival& rival = *explanation.rival;
    text += fmt::format(
        "rival {}, frames {} to {}, features {:.4f}: ranked as if it cost {:.4f} more\n",
        OnOneLine(explained.template_names[rival.motion_template]), rival.hit.first_frame,
        rival.hit.last_frame, rival.hit.cost, hit.score - hit.cost);
  } else if (explained.template_names.size() > 1) {
    text += "no rival fits there\n";
  }
  return text;
}

}  // namespace

std::vector<FeatureTally> TallyFeatures(const std::vector<ExplainedCell>& cells,
                                        const QuantizedTemplate& motion_template) {
  std::vector<FeatureTally> tallies;
  for (int feature = 0; feature < motion_template.feature_count; ++feature) {
    FeatureTally tally{.feature = feature};
    const std::uint64_t bit = std::uint64_t{1} << feature;
    for (const ExplainedCell& cell : cells) {
      if ((cell.agreed & bit) != 0) ++tally.agreed;
      if ((cell.disagreed & bit) == 0) continue;
      ++tally.disagreed;
      tally.cost += CostOfFeature(motion_template, cell, feature);
    }
    if (tally.agreed + tally.disagreed > 0) tallies.push_back(tally);
  }
  std::ranges::stable_sort(tallies, std::greater(), &FeatureTally::cost);
  return tallies;
}

std::vector<JointTally> TallyJoints(const HitExplanation& explanation) {
  std::vector<JointTally> tallies;
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    JointTally tally{.joint = static_cast<StandardJoint>(joint)};
    for (std::size_t i = 0; i < explanation.places.size(); ++i) {
      const int value = static_cast<int>(i % kPoseValues);
      if (value / kAxes != joint) continue;
      const ExplainedPlace& place = explanation.places[i];
      tally.cost += place.cost;
      if (place.cost <= tally.most.cost) continue;
      tally.most = {.joint = tally.joint,
                    .axis = value % kAxes,
                    .column = explanation.cells[i / kPoseValues].cell.recording_column,
                    .off = place.off,
                    .cost = place.cost};
    }
    if (tally.cost > 0) tallies.push_back(tally);
  }
  std::ranges::stable_sort(tallies, std::greater(), &JointTally::cost);
  return tallies;
}

std::vector<JointOffset> OffsetsOfCell(const HitExplanation& explanation, std::size_t cell) {
  std::vector<JointOffset> offsets;
  for (int joint = 0; joint < kStandardJointCount; ++joint) {
    JointOffset most{.joint = static_cast<StandardJoint>(joint),
                     .column = explanation.cells[cell].cell.recording_column};
    for (int axis = 0; axis < kAxes; ++axis) {
      const std::size_t value = cell * kPoseValues + static_cast<std::size_t>(joint * kAxes + axis);
      const ExplainedPlace& place = explanation.places[value];
      if (place.cost <= most.cost) continue;
      most.axis = axis;
      most.off = place.off;
      most.cost = place.cost;
    }
    if (most.cost > 0) offsets.push_back(most);
  }
  std::ranges::stable_sort(offsets, std::greater(), &JointOffset::cost);
  return offsets;
}

Json ToJson(const Explained& explained) {
  const HitExplanation& explanation = explained.explanation;
  const TakeHit& hit = explanation.hit;
  Json json = {{"template", explained.template_names.front()},
               {"file", explained.file},
               {"first_frame", hit.first_frame},
               {"last_frame", hit.last_frame},
               {"start_s", hit.start_s},
               {"end_s", hit.end_s},
               {"cost", hit.cost}};
  if (explained.has_poses()) {
    json["features_cost"] = explanation.matching;
    json["poses_cost"] = explanation.places_cost;
    json["lookalikes_cost"] = explanation.lookalikes_cost;
    json["score"] = hit.score;
    json["confidence"] = hit.confidence ? Json(*hit.confidence) : Json();
    json["rival"] = RivalToJson(explained);
  }
  json["path"] = PathToJson(explained);
  json["features"] = FeaturesToJson(explained);
  if (explained.has_poses()) json["joints"] = JointsToJson(explained);
  return json;
}

std::string ToText(const Explained& explained) {
  const TakeHit& hit = explained.explanation.hit;
  int agreed = 0;
  int asked = 0;
  std::int64_t without_fault = 0;
  for (const FeatureTally& tally : explained.tallies) {
    agreed += tally.agreed;
    asked += tally.agreed + tally.disagreed;
    if (tally.disagreed == 0) ++without_fault;
  }
  std::string text = fmt::format(
      "{} in {}, frames {} to {} ({} to {})\n"
      "cost {:.4f}: ",
      OnOneLine(explained.template_names.front()), OnOneLine(explained.file), hit.first_frame,
      hit.last_frame, FormatTime(hit.start_s), FormatTime(hit.end_s), hit.cost);
  if (explained.has_poses()) text += ContrastText(explained);
  text += fmt::format("{} of {} entries along the path are as the template asks\n", agreed, asked);
  if (agreed < asked) text += '\n' + FeatureTable(explained) + '\n';
  text +=
      fmt::format("{} without a fault\n", FormatCount(without_fault, "feature is", "features are"));
  if (!explained.joints.empty()) text += '\n' + JointTable(explained);
  return text;
}

}  // namespace kinebase::cli
