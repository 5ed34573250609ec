// Reads C3D.
//
// Three things tell how the data lie in the file: the header, the parameters and the file's size.
// The parameters rule over the header, as the user guide wants it, but for the scale, and unless
// the file has no room for what they claim and has for what the header does. The data are then
// decoded in one pass.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "formats/c3d_numbers.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

using internal::kC3dBlock;
using internal::kC3dMaxWord;
using Place = internal::C3dHeaderPlace;

// Beyond these, 16-bit coordinates leave the range of a float.
constexpr float kSmallestIntegerScale = 1e-30F;
constexpr float kLargestIntegerScale = 1e30F;
constexpr double kLargestField = 4294967295.0;

// What a frame consists of.
struct FrameLayout {
  std::size_t points = 0;
  std::size_t channels = 0;
  std::size_t subframes = 0;

  friend bool operator==(const FrameLayout&, const FrameLayout&) = default;
};

struct FrameCount {
  std::int64_t count = 0;
  std::string_view source;
};

// Beyond what rounding on the way through another program can do.
bool Differ(double a, double b) { return std::abs(a - b) > 1e-5 * std::max(std::abs(a), 1e-9); }

class C3dReader {
 public:
  // `release` gets each part of the bytes that is done with.
  C3dReader(std::string_view bytes, const std::filesystem::path& file,
            const C3dReadOptions& options, std::function<void(std::string_view)> release)
      : bytes_(bytes), file_(file), options_(options), release_(std::move(release)) {}

  C3dRecording Read() {
    FindParameters();
    ReadHeader();
    ReadParameters();
    ChooseDataStart();
    ChooseStorageAndRate();
    ChooseLayout();
    ChooseFrames();
    ReadFrames();
    KeepTrailing();
    internal::AlignParameters(recording_);
    return std::move(recording_);
  }

 private:
  [[noreturn]] void Fail(const std::string& message, std::size_t byte) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_, 0, static_cast<std::int64_t>(byte)});
  }

  void Note(Severity severity, std::string message, std::size_t byte) {
    recording_.diagnostics.push_back(
        {severity, std::move(message), 0, static_cast<std::int64_t>(byte)});
  }
  void Warn(std::string message, std::size_t byte) {
    Note(Severity::kWarning, std::move(message), byte);
  }

  std::uint16_t HeaderWord(std::size_t byte) const {
    return internal::LoadWord(recording_.processor, bytes_.data() + byte);
  }
  float HeaderFloat(std::size_t byte) const {
    return internal::LoadFloat(recording_.processor, bytes_.data() + byte);
  }

  // A parameter as a whole number that is not negative.
  std::optional<std::int64_t> Count(std::string_view group, std::string_view name) const {
    const C3dParameter* parameter = FindParameter(recording_, group, name);
    const auto number = parameter == nullptr ? std::nullopt : parameter->UnsignedNumber();
    if (!number || !(*number >= 0 && *number <= kLargestField)) return std::nullopt;
    return std::llround(*number);
  }
  std::optional<double> Number(std::string_view group, std::string_view name) const {
    const C3dParameter* parameter = FindParameter(recording_, group, name);
    return parameter == nullptr ? std::nullopt : parameter->Number();
  }

  void FindParameters() {
    if (bytes_.empty()) Fail("is empty; expected a C3D file", 0);
    if (bytes_.size() <= internal::kC3dKeyByte ||
        bytes_[internal::kC3dKeyByte] != internal::kC3dKey) {
      Fail("is no C3D file: expected 0x50 in its second byte", internal::kC3dKeyByte);
    }
    if (bytes_.size() < kC3dBlock) {
      Fail(fmt::format("ends within its header: {} bytes of {}", bytes_.size(), kC3dBlock),
           bytes_.size());
    }
    const std::size_t block = static_cast<unsigned char>(bytes_[Place::kParameterBlock]);
    if (block < 2) {
      Fail(fmt::format("is no C3D file: its parameters begin at block {}, expected 2 or more",
                       block),
           Place::kParameterBlock);
    }
    parameter_begin_ = (block - 1) * kC3dBlock;
    if (parameter_begin_ + 4 > bytes_.size()) {
      Fail(fmt::format("ends before its parameters, which begin at byte {}", parameter_begin_),
           bytes_.size());
    }
    const int processor = static_cast<unsigned char>(bytes_[parameter_begin_ + 3]);
    if (processor < 84 || processor > 86) {
      Fail(fmt::format("has the unknown processor type {}; expected 84 (Intel), 85 (DEC) or 86 "
                       "(MIPS)",
                       processor),
           parameter_begin_ + 3);
    }
    recording_.processor = static_cast<C3dProcessor>(processor);
  }

  void ReadHeader() {
    header_layout_.points = HeaderWord(Place::kPointCount);
    header_subframes_ = HeaderWord(Place::kSubframes);
    header_analog_ = HeaderWord(Place::kAnalogPerFrame);
    recording_.first_frame = HeaderWord(Place::kFirstFrame);
    header_frames_ = static_cast<std::uint16_t>(HeaderWord(Place::kLastFrame) -
                                                HeaderWord(Place::kFirstFrame) + 1);
    recording_.max_gap = HeaderWord(Place::kMaxGap);
    data_begin_ = BlockBegin(HeaderWord(Place::kDataBlock));

    std::array<char, kC3dBlock> unknown{};
    std::copy_n(bytes_.begin(), kC3dBlock, unknown.begin());
    std::fill_n(unknown.begin(), Place::kFieldsEnd, '\0');
    ReadHeaderEvents(unknown);
    DropRangeSection(unknown);
    for (std::size_t i = 0; i < recording_.other_header_words.size(); ++i) {
      recording_.other_header_words[i] =
          internal::LoadWord(recording_.processor, unknown.data() + 2 * i);
    }
  }

  // Takes the events out of `unknown` as far as they are understood.
  void ReadHeaderEvents(std::array<char, kC3dBlock>& unknown) {
    const std::size_t count = HeaderWord(Place::kEventCount);
    if (HeaderWord(Place::kEventKey) != internal::kC3dFourCharKey) {
      if (count > 0) {
        Warn(fmt::format("the header's {} events are of an older kind and not understood", count),
             Place::kEventKey);
      }
      return;
    }
    std::fill_n(unknown.begin() + Place::kEventKey, 4, '\0');
    if (count > internal::kC3dMaxHeaderEvents) {
      Warn(fmt::format("the header claims {} events, has room for {} and is taken to have none",
                       count, internal::kC3dMaxHeaderEvents),
           Place::kEventCount);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      std::string label(bytes_.substr(Place::kEventLabels + 4 * i, 4));
      while (!label.empty() && (label.back() == ' ' || label.back() == '\0')) label.pop_back();
      recording_.header_events.push_back(
          {.label = std::move(label),
           .time_s = HeaderFloat(Place::kEventTimes + 4 * i),
           .display_flag = static_cast<std::uint8_t>(bytes_[Place::kEventFlags + i])});
    }
    std::fill_n(unknown.begin() + Place::kEventTimes, 4 * count, '\0');
    std::fill_n(unknown.begin() + Place::kEventFlags, count, '\0');
    std::fill_n(unknown.begin() + Place::kEventLabels, 4 * count, '\0');
  }

  // Old files can have a further section, of labels and ranges; where it stands is of no use when
  // it is not kept.
  void DropRangeSection(std::array<char, kC3dBlock>& unknown) {
    const std::uint16_t block = HeaderWord(Place::kRangeBlock);
    if (HeaderWord(Place::kRangeKey) != internal::kC3dRangeKey || block == 0) return;
    Warn(fmt::format("the section of labels and ranges at block {} is not kept", block),
         Place::kRangeBlock);
    std::fill_n(unknown.begin() + Place::kRangeBlock, 2, '\0');
  }

  // Blocks count from 1; 0 and 1 are the header itself, so they tell nothing.
  static std::size_t BlockBegin(std::size_t block) {
    return block < 2 ? 0 : (block - 1) * kC3dBlock;
  }

  void ReadParameters() {
    const std::size_t blocks = static_cast<unsigned char>(bytes_[parameter_begin_ + 2]);
    std::size_t limit = bytes_.size();
    if (data_begin_ > parameter_begin_) {
      limit = std::min(limit, data_begin_);
    } else if (blocks > 0) {
      limit = std::min(limit, parameter_begin_ + blocks * kC3dBlock);
    }
    internal::ReadParameterSection(bytes_, parameter_begin_, limit, recording_);
    if (recording_.groups.empty()) {
      Warn("has no parameters; the header alone tells what the data are", parameter_begin_);
    }
  }

  void ChooseDataStart() {
    const auto block = Count("POINT", "DATA_START");
    const std::size_t told = BlockBegin(static_cast<std::size_t>(block.value_or(0)));
    if (data_begin_ == 0 && told > 0) {
      data_begin_ = told;
      Warn("the header does not tell where the data begin; POINT:DATA_START does",
           Place::kDataBlock);
    } else if (block && told != data_begin_) {
      Warn(fmt::format("POINT:DATA_START says block {}, the header {}; the header is taken", *block,
                       data_begin_ / kC3dBlock + 1),
           Place::kDataBlock);
    }
    data_end_ = data_begin_ < parameter_begin_ ? parameter_begin_ : bytes_.size();
    room_ = data_begin_ == 0 || data_begin_ > data_end_ ? 0 : data_end_ - data_begin_;
  }

  void ChooseStorageAndRate() {
    const auto usable = [](double value) { return std::isfinite(value) && value != 0; };
    const auto header_scale = static_cast<double>(HeaderFloat(Place::kScale));
    const double told = Number("POINT", "SCALE").value_or(0);
    double scale = usable(header_scale) ? header_scale : told;
    // Here the header rules: other readers go by it, and in the one file known where it matters
    // (sample06 of c3d.org) the parameter makes a person of 60 cm.
    if (usable(told) && Differ(told, scale)) {
      Warn(fmt::format("POINT:SCALE is {:g}, the header says {:g}; the header is taken", told,
                       scale),
           Place::kScale);
    }
    scale_is_known_ = usable(scale);
    if (!scale_is_known_) scale = -1;
    recording_.storage = scale < 0 ? C3dStorage::kFloat : C3dStorage::kInteger;
    recording_.scale = static_cast<float>(std::abs(scale));

    const auto is_rate = [](double rate) { return rate > 0 && std::isfinite(rate); };
    const float header_rate = HeaderFloat(Place::kRate);
    const double rate = Number("POINT", "RATE").value_or(0);
    if (is_rate(rate) && Differ(rate, static_cast<double>(header_rate))) {
      Warn(fmt::format("POINT:RATE is {:g} Hz, the header says {:g} Hz; the parameter is taken",
                       rate, header_rate),
           Place::kRate);
    }
    if (is_rate(rate)) {
      recording_.rate_hz = static_cast<float>(rate);
    } else {
      recording_.rate_hz = is_rate(static_cast<double>(header_rate)) ? header_rate : 0;
    }
  }

  // Points and analog samples of a frame as the parameters tell it.
  FrameLayout ParameterLayout() const {
    FrameLayout layout = header_layout_;
    const auto points = Count("POINT", "USED");
    if (points && *points <= static_cast<std::int64_t>(kC3dMaxWord)) {
      layout.points = static_cast<std::size_t>(*points);
    }
    const auto channels = Count("ANALOG", "USED");
    if (!channels || *channels > static_cast<std::int64_t>(kC3dMaxWord)) return layout;
    layout.channels = static_cast<std::size_t>(*channels);
    layout.subframes = header_subframes_;
    if (layout.channels == 0 || HeaderHas(layout)) return layout;
    const double ratio = Number("ANALOG", "RATE").value_or(0) / recording_.rate_hz;
    if (ratio >= .5 && ratio < static_cast<double>(kC3dMaxWord)) {
      layout.subframes = static_cast<std::size_t>(std::llround(ratio));
    }
    layout.subframes = std::max<std::size_t>(layout.subframes, 1);
    return layout;
  }

  // Whether the header's number of analog samples in a frame is that of `layout`.
  bool HeaderHas(const FrameLayout& layout) const {
    return layout.subframes > 0 &&
           std::min(layout.channels * layout.subframes, kC3dMaxWord) == header_analog_;
  }

  void ChooseLayout() {
    header_layout_.subframes = header_subframes_;
    header_layout_.channels = header_analog_;
    if (header_analog_ > 0) {
      const std::size_t subframes = std::max<std::size_t>(header_subframes_, 1);
      const bool divides = header_analog_ % subframes == 0;
      header_layout_.subframes = divides ? subframes : 1;
      header_layout_.channels = header_analog_ / header_layout_.subframes;
    }
    FrameLayout layout = ParameterLayout();
    if (layout.points != header_layout_.points ||
        layout.channels * layout.subframes != header_layout_.channels * header_layout_.subframes) {
      const bool use_header = !HasRoom(layout) && HasRoom(header_layout_);
      Warn(
          fmt::format("the parameters tell of {} points and {} × {} analog samples in a frame, the "
                      "header of {} and {}; {}",
                      layout.points, layout.subframes, layout.channels, header_layout_.points,
                      header_analog_,
                      use_header ? "the header is taken, as it fits the file's size"
                                 : "the parameters are taken"),
          Place::kPointCount);
      if (use_header) layout = header_layout_;
    }
    recording_.point_count = layout.points;
    recording_.channel_count = layout.channels;
    recording_.subframe_count = layout.subframes;
    if (layout.points + layout.channels > 0) CheckScale();
  }

  void CheckScale() const {
    if (!scale_is_known_) {
      Fail("has no scale: POINT:SCALE is neither negative (floats) nor positive (integers)",
           Place::kScale);
    }
    const bool is_odd =
        recording_.scale < kSmallestIntegerScale || recording_.scale > kLargestIntegerScale;
    if (recording_.storage == C3dStorage::kInteger && is_odd) {
      Fail(fmt::format("has coordinates in steps of {:g}, which makes no sense", recording_.scale),
           Place::kScale);
    }
  }

  std::size_t FrameBytes(const FrameLayout& layout) const {
    const std::size_t size = recording_.storage == C3dStorage::kFloat ? 4 : 2;
    return (4 * layout.points + layout.channels * layout.subframes) * size;
  }

  bool HasRoom(const FrameLayout& layout) const {
    return std::ranges::any_of(FrameCounts(),
                               [&](const FrameCount& each) { return HasRoom(each, layout); });
  }
  bool HasRoom(const FrameCount& frames, const FrameLayout& layout) const {
    const std::size_t size = FrameBytes(layout);
    return size == 0 || static_cast<std::size_t>(frames.count) <= room_ / size;
  }

  std::optional<std::int64_t> TrialCount() const {
    const auto first = internal::TrialField(recording_, "ACTUAL_START_FIELD");
    const auto last = internal::TrialField(recording_, "ACTUAL_END_FIELD");
    if (!first || !last || *last < *first) return std::nullopt;
    return *last - *first + 1;
  }

  // What tells the number of frames, the most trustworthy first.
  std::vector<FrameCount> FrameCounts() const {
    constexpr auto kMax = static_cast<std::int64_t>(kC3dMaxWord);
    const auto trial = TrialCount();
    std::vector<FrameCount> counts;
    if (const auto frames = Count("POINT", "LONG_FRAMES")) {
      // A float holds 24 bits of it.
      const bool rounded = trial && static_cast<float>(*trial) == static_cast<float>(*frames);
      counts.push_back({rounded ? *trial : *frames, "POINT:LONG_FRAMES"});
    }
    if (const auto frames = Count("POINT", "FRAMES")) {
      // 16 bits are not enough for more frames; some writers fill them, others let them overflow.
      if (trial && *trial > kMax && (*frames == kMax || *frames == (*trial & kMax))) {
        counts.push_back({*trial, "TRIAL:ACTUAL_END_FIELD"});
      }
      counts.push_back({*frames, "POINT:FRAMES"});
    }
    counts.push_back({header_frames_, "the header"});
    return counts;
  }

  void ChooseFrames() {
    const FrameLayout layout{recording_.point_count, recording_.channel_count,
                             recording_.subframe_count};
    frame_bytes_ = FrameBytes(layout);
    std::vector<FrameCount> counts = FrameCounts();
    // No frames, says a parameter, yet the header has some and they are there: then it lies.
    if (header_frames_ > 0 && frame_bytes_ > 0 && HasRoom(counts.back(), layout)) {
      std::erase_if(counts, [](const FrameCount& each) { return each.count == 0; });
    }
    const FrameCount told = counts.front();
    const auto fitting =
        std::ranges::find_if(counts, [&](const FrameCount& each) { return HasRoom(each, layout); });
    if (fitting == counts.end()) {
      CutOff(told);
    } else {
      recording_.frame_count = static_cast<std::size_t>(fitting->count);
      const bool header_agrees =
          header_frames_ == std::min<std::int64_t>(fitting->count, kC3dMaxWord) ||
          fitting->count + recording_.first_frame > static_cast<std::int64_t>(kC3dMaxWord);
      if (fitting->count != told.count) {
        Warn(fmt::format("{} says {} frames, for which the file is too short; the {} of {} are "
                         "taken",
                         told.source, told.count, fitting->count, fitting->source),
             Place::kLastFrame);
      } else if (!header_agrees) {
        Warn(fmt::format("{} says {} frames, the header {}; the parameter is taken", told.source,
                         told.count, header_frames_),
             Place::kLastFrame);
      }
    }
    ChooseFirstFrame();
  }

  // The file ends before the last frame that it tells of.
  void CutOff(const FrameCount& told) {
    if (room_ < frame_bytes_) {
      Fail(
          fmt::format("ends before its first frame; it tells of {} frames of {} bytes from byte {}",
                      told.count, frame_bytes_, data_begin_),
          bytes_.size());
    }
    recording_.frame_count = room_ / frame_bytes_;
    is_cut_off_ = true;
    const std::string message =
        fmt::format("is cut off: {} frames of {} are there", recording_.frame_count, told.count);
    if (options_.strict) Fail(message + " (without --strict they are read)", bytes_.size());
    Warn(message, bytes_.size());
  }

  void ChooseFirstFrame() {
    if (recording_.frame_count == 0) {
      recording_.first_frame = 1;
      return;
    }
    const auto first = internal::TrialField(recording_, "ACTUAL_START_FIELD");
    const auto count = TrialCount();
    if (!first || !count || *first == recording_.first_frame) return;
    if (*count == static_cast<std::int64_t>(recording_.frame_count)) {
      if (recording_.first_frame < static_cast<std::int64_t>(kC3dMaxWord)) {
        Warn(fmt::format("TRIAL:ACTUAL_START_FIELD says frame {}, the header {}; the parameter is "
                         "taken",
                         *first, recording_.first_frame),
             Place::kFirstFrame);
      }
      recording_.first_frame = *first;
    } else {
      Warn(fmt::format("TRIAL tells of other frames ({} from {}) than there are ({} from {})",
                       *count, *first, recording_.frame_count, recording_.first_frame),
           Place::kFirstFrame);
    }
  }

  void ReadFrames() {
    if (frame_bytes_ > 0) internal::ReadFrames(bytes_.data() + data_begin_, recording_, release_);
  }

  void KeepTrailing() {
    if (data_begin_ == 0 || room_ == 0 || is_cut_off_) return;
    const std::size_t begin = data_begin_ + recording_.frame_count * frame_bytes_;
    std::string_view rest = bytes_.substr(begin, data_end_ - begin);
    const std::size_t last = rest.find_last_not_of('\0');
    if (last == std::string_view::npos) return;
    recording_.trailing = rest.substr(0, last + 1);
    // Less than a block is what many writers leave of something else.
    if (recording_.trailing.size() >= kC3dBlock) {
      Note(Severity::kInfo,
           fmt::format("{} bytes follow the last frame; they are kept", recording_.trailing.size()),
           begin);
    }
  }

  std::string_view bytes_;
  const std::filesystem::path& file_;
  const C3dReadOptions& options_;
  std::function<void(std::string_view)> release_;
  C3dRecording recording_;
  FrameLayout header_layout_;
  std::size_t header_subframes_ = 0;
  std::size_t header_analog_ = 0;  // Samples of all channels in a frame.
  std::int64_t header_frames_ = 0;
  std::size_t parameter_begin_ = 0;
  std::size_t data_begin_ = 0;  // 0 = nothing tells.
  std::size_t data_end_ = 0;    // End of the file, or the parameters where they come later.
  std::size_t room_ = 0;        // Bytes that data can take.
  std::size_t frame_bytes_ = 0;
  bool scale_is_known_ = false;
  bool is_cut_off_ = false;
};

}  // namespace

C3dRecording ParseC3d(std::string_view bytes, const std::filesystem::path& file,
                      const C3dReadOptions& options) {
  return C3dReader(bytes, file, options, [](std::string_view) {}).Read();
}

C3dRecording ReadC3d(const std::filesystem::path& path, const C3dReadOptions& options) {
  const MappedFile file(path);
  const auto release = [&](std::string_view part) { file.Release(part); };
  return C3dReader(file.text(), path, options, release).Read();
}

}  // namespace kinebase
