// The markers that Character Studio knows: its format's table of attachment positions, and the
// three of a prop in either hand or both.

#include <algorithm>
#include <array>

#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/mnm.h"

namespace kinebase {
namespace {

using enum PresetMarker::Need;

constexpr std::array kPreset = {
    PresetMarker{"LFHD", "left front head", kRequired, "the head's direction"},
    PresetMarker{"LBHD", "left back head", kRequired, "the head's direction"},
    PresetMarker{"RBHD", "right back head", kRequired, "the head's direction"},
    PresetMarker{"RFHD", "right front head", kRequired, "the head's direction"},
    PresetMarker{"CLAV", "top of the chest", kRequired, "the neck and the upper chest"},
    PresetMarker{"STRN", "centre of the chest", kRequired, "the chest's inclination"},
    PresetMarker{"LFWT", "left front waist", kRequired, "the pelvis and the hips"},
    PresetMarker{"LBWT", "left back waist", kRequired, "the pelvis and the hips"},
    PresetMarker{"RBWT", "right back waist", kRequired, "the pelvis and the hips"},
    PresetMarker{"RFWT", "right front waist", kRequired, "the pelvis and the hips"},
    PresetMarker{"C7", "top of the spine", kRequired, "the neck and the upper chest"},
    PresetMarker{"T10", "middle of the back", kRequired, "the chest's inclination"},
    PresetMarker{"SACR", "lower back", kOptional, "the pelvis' tilt"},
    PresetMarker{"LKNE", "left outer knee", kRequired, "the left knee"},
    PresetMarker{"LKNI", "left inner knee", kOptional, "the left knee's middle and axis"},
    PresetMarker{"LANK", "left outer ankle", kRequired, "the left ankle"},
    PresetMarker{"LHEL", "left heel", kOptional, "the left foot's direction and contact"},
    PresetMarker{"LMT5", "left outer metatarsal", kRequired, "the left foot's roll"},
    PresetMarker{"LMTI", "left inner metatarsal", kOptional, "the left foot's roll"},
    PresetMarker{"LTOE", "left toe", kRequired, "the left foot's direction and toes"},
    PresetMarker{"RKNE", "right outer knee", kRequired, "the right knee"},
    PresetMarker{"RKNI", "right inner knee", kOptional, "the right knee's middle and axis"},
    PresetMarker{"RANK", "right outer ankle", kRequired, "the right ankle"},
    PresetMarker{"RHEL", "right heel", kOptional, "the right foot's direction and contact"},
    PresetMarker{"RMT5", "right outer metatarsal", kRequired, "the right foot's roll"},
    PresetMarker{"RMTI", "right inner metatarsal", kOptional, "the right foot's roll"},
    PresetMarker{"RTOE", "right toe", kRequired, "the right foot's direction and toes"},
    PresetMarker{"LSHO", "left shoulder", kRequired, "the left shoulder"},
    PresetMarker{"LELB", "left outer elbow", kRequired, "the left elbow"},
    PresetMarker{"LILB", "left inner elbow", kOptional, "the left elbow's middle and axis"},
    PresetMarker{"LWRE", "end of the left wrist's stick", kStick, "the left wrist"},
    PresetMarker{"LWRI", "base of the left wrist's stick", kStick, "the left wrist"},
    PresetMarker{"LWRA", "left wrist near the thumb", kBand, "the left wrist"},
    PresetMarker{"LWRB", "left wrist opposite the thumb", kBand, "the left wrist"},
    PresetMarker{"LFIN", "left hand", kRequired, "the left hand"},
    PresetMarker{"RSHO", "right shoulder", kRequired, "the right shoulder"},
    PresetMarker{"RELB", "right outer elbow", kRequired, "the right elbow"},
    PresetMarker{"RILB", "right inner elbow", kOptional, "the right elbow's middle and axis"},
    PresetMarker{"RWRE", "end of the right wrist's stick", kStick, "the right wrist"},
    PresetMarker{"RWRI", "base of the right wrist's stick", kStick, "the right wrist"},
    PresetMarker{"RWRA", "right wrist near the thumb", kBand, "the right wrist"},
    PresetMarker{"RWRB", "right wrist opposite the thumb", kBand, "the right wrist"},
    PresetMarker{"RFIN", "right hand", kRequired, "the right hand"},
    PresetMarker{"LPRPB", "base of the left hand's prop", kProp, "the prop"},
    PresetMarker{"LPRPM", "middle of the left hand's prop", kProp, "the prop"},
    PresetMarker{"LPRPT", "tip of the left hand's prop", kProp, "the prop"},
    PresetMarker{"RPRPB", "base of the right hand's prop", kProp, "the prop"},
    PresetMarker{"RPRPM", "middle of the right hand's prop", kProp, "the prop"},
    PresetMarker{"RPRPT", "tip of the right hand's prop", kProp, "the prop"},
    PresetMarker{"MPRPB", "base of both hands' prop", kProp, "the prop"},
    PresetMarker{"MPRPM", "middle of both hands' prop", kProp, "the prop"},
    PresetMarker{"MPRPT", "tip of both hands' prop", kProp, "the prop"},
};

}  // namespace

std::span<const PresetMarker> PresetMarkers() { return kPreset; }

const PresetMarker* FindPresetMarker(std::string_view name) {
  const auto found = std::ranges::find_if(
      kPreset, [&](const PresetMarker& each) { return EqualsIgnoringCase(each.name, name); });
  return found == kPreset.end() ? nullptr : &*found;
}

}  // namespace kinebase
