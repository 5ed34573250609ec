#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/formats/bvh.h"

namespace kinebase {
namespace {

// Deeper blocks stand no further right: in a chain of thousands of joints blanks would be all.
constexpr std::size_t kDeepestIndent = 32;

class BvhWriter {
 public:
  explicit BvhWriter(const BvhMotion& bvh) : bvh_(bvh) {}

  std::string Write() {
    out_.reserve(bvh_.values.size() * 10);
    out_ += "HIERARCHY\n";
    for (std::size_t i = 0; i < bvh_.joints.size(); ++i) OpenJoint(static_cast<int>(i));
    while (!open_.empty()) Close();
    out_ += "MOTION\n";
    if (bvh_.declared_frame_count) {
      out_ += fmt::format("Frames: {}\n", *bvh_.declared_frame_count);
    }
    if (!bvh_.frame_time_text.empty()) out_ += "Frame Time: " + bvh_.frame_time_text + '\n';
    for (const auto& line : bvh_.unknown) out_ += line + '\n';
    for (std::size_t frame = 0; frame < bvh_.frame_count(); ++frame) {
      AppendNumbers(bvh_.Frame(frame));
      out_.back() = '\n';
    }
    return std::move(out_);
  }

 private:
  void OpenJoint(int index) {
    const BvhJoint& joint = bvh_.joints[static_cast<std::size_t>(index)];
    while (!open_.empty() && open_.back() != joint.parent) Close();
    if (open_.empty() && joint.parent != -1) {
      throw Error(
          ErrorCode::kInvalidArgument,
          fmt::format("joint {} ('{}') does not follow its parent depth first", index, joint.name));
    }
    Open((joint.parent == -1 ? "ROOT " : "JOINT ") + joint.name);
    open_.push_back(index);
    Offset(joint.offset);
    Indent() += fmt::format("CHANNELS {}", joint.channels.size());
    for (const BvhChannel channel : joint.channels) out_.append(" ").append(ToString(channel));
    out_ += '\n';
    for (const auto& line : joint.unknown) Indent() += line + '\n';
    for (const auto& end_site : joint.end_sites) {
      Open("End " + end_site.name);
      open_.push_back(-1);
      Offset(end_site.offset);
      for (const auto& line : end_site.unknown) Indent() += line + '\n';
      Close();
    }
  }

  void Open(const std::string& line) {
    Indent() += line + '\n';
    Indent() += "{\n";
  }
  void Close() {
    open_.pop_back();
    Indent() += "}\n";
  }
  std::string& Indent() { return out_.append(std::min(open_.size(), kDeepestIndent), '\t'); }

  void Offset(std::span<const double> offset) {
    Indent() += "OFFSET ";
    AppendNumbers(offset);
    out_.back() = '\n';
  }

  void AppendNumbers(std::span<const double> values) {
    for (const double value : values) {
      AppendShortestText(out_, value);
      out_ += ' ';
    }
  }

  const BvhMotion& bvh_;
  std::vector<int> open_;  // Joints whose braces are open; -1 for an end site.
  std::string out_;
};

}  // namespace

std::string FormatBvh(const BvhMotion& motion) { return BvhWriter(motion).Write(); }

}  // namespace kinebase
