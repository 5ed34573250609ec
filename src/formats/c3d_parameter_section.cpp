// The parameter section: a chain of records, each of a group or of a parameter.
//
//   byte 0, 1   1 and 0x50, or anything
//   byte 2      blocks of 512 bytes in the section; often wrong
//   byte 3      processor
//   then records:
//     int8      length of the name, negative if locked; 0 ends the chain
//     int8      -id of a group, or +id of the group that a parameter belongs to
//     name
//     uint16    bytes from here to the next record; 0 for the last one
//     parameter only:
//       int8    type: -1 text, 1 bytes, 2 16-bit integers, 4 floats
//       uint8   number of dimensions, then one byte for each
//       values
//     uint8     length of the description, then that; some writers leave it out
//
// Where a record says that the next one is at an impossible place, its own contents tell where it
// ends; where the contents do not fit between the record and the next one, they are left out.

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "fmt/format.h"
#include "formats/c3d_layout.h"
#include "formats/c3d_numbers.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {
namespace {

constexpr std::size_t kSectionHeader = 4;
constexpr std::size_t kMaxRecord = 65535;
constexpr std::size_t kMaxName = 127;
constexpr std::size_t kMaxDescription = 255;
constexpr std::size_t kMaxBlockCount = 255;

std::size_t ValueSize(int type) {
  switch (type) {
    case -1:
    case 1:
      return 1;
    case 2:
      return 2;
    case 4:
      return 4;
    default:
      return 0;
  }
}

int TypeOf(const C3dValues& values) {
  constexpr int kTypes[] = {-1, 1, 2, 4};
  return kTypes[values.index()];
}

// Number of values, capped above `limit`.
std::size_t ProductOf(const std::vector<std::uint8_t>& dimensions, std::size_t limit) {
  if (std::ranges::find(dimensions, 0) != dimensions.end()) return 0;
  std::size_t product = 1;
  for (const std::uint8_t dimension : dimensions) {
    product *= dimension;
    if (product > limit) return limit + 1;
  }
  return product;
}

class SectionReader {
 public:
  SectionReader(std::string_view bytes, std::size_t limit, C3dRecording& recording)
      : bytes_(bytes), limit_(limit), recording_(recording) {}

  void Read(std::size_t begin) {
    const std::size_t block_count = static_cast<unsigned char>(bytes_[begin + 2]);
    const std::size_t declared_end = begin + block_count * kC3dBlock;
    at_ = begin + kSectionHeader;
    while (ReadRecord()) {
    }
    if (at_ > declared_end && !recording_.groups.empty()) {
      Warn(fmt::format("the parameters take more than the {} blocks that their section claims",
                       block_count),
           begin + 2);
    }
    ReportRepeats(begin);
  }

 private:
  void Warn(std::string message, std::size_t byte) {
    recording_.diagnostics.push_back(
        {Severity::kWarning, std::move(message), 0, static_cast<std::int64_t>(byte)});
  }

  std::uint8_t Byte(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }

  // Reads the record at `at_` and moves to the next; false at the end of the chain.
  bool ReadRecord() {
    if (at_ + 2 > limit_) return false;
    const auto name_length = static_cast<std::int8_t>(bytes_[at_]);
    const auto id = static_cast<std::int8_t>(bytes_[at_ + 1]);
    if (name_length == 0) return false;
    const std::size_t length = static_cast<std::size_t>(std::abs(int{name_length}));
    const std::size_t link = at_ + 2 + length;
    if (link + 2 > limit_ || length > kMaxName) {
      Warn("the last parameter is cut off; it is left out", at_);
      return false;
    }
    const std::string name(bytes_.substr(at_ + 2, length));
    const std::size_t offset = LoadWord(recording_.processor, bytes_.data() + link);
    const std::size_t next = link + offset;
    const bool is_last = offset == 0;
    const bool is_linked = !is_last && offset >= 2 && next <= limit_;
    if (!is_last && !is_linked) {
      Warn(fmt::format("the record of {} says that the next one is {} bytes further on, beyond the "
                       "parameters; its own length is taken",
                       Quoted(name), offset),
           link);
    }
    record_end_ = is_linked ? next : limit_;
    contents_end_ = 0;
    if (id < 0) {
      ReadGroup(name, -int{id}, name_length < 0, link + 2);
    } else {
      ReadParameter(name, id, name_length < 0, link + 2);
    }
    if (is_last || (!is_linked && contents_end_ == 0)) {
      at_ = std::max(at_, contents_end_);
      return false;
    }
    at_ = is_linked ? next : contents_end_;
    return true;
  }

  C3dGroup& GroupOf(int id) {
    const auto [found, is_new] = group_of_id_.emplace(id, recording_.groups.size());
    if (is_new) recording_.groups.push_back({.id = id});
    return recording_.groups[found->second];
  }

  // The description that begins at `at`; none where the record ends there.
  std::string Description(std::size_t at) {
    contents_end_ = std::min(at, record_end_);
    if (at >= record_end_) return {};
    const std::size_t length = std::min<std::size_t>(Byte(at), record_end_ - at - 1);
    contents_end_ = at + 1 + length;
    return std::string(bytes_.substr(at + 1, length));
  }

  void ReadGroup(const std::string& name, int id, bool is_locked, std::size_t at) {
    C3dGroup& group = GroupOf(id);
    const std::string description = Description(at);
    if (!group.name.empty()) {
      Warn(fmt::format("group {} has the number of group {}; it is taken for the same",
                       Quoted(name), Quoted(group.name)),
           at_);
      return;
    }
    group.name = name;
    group.description = description;
    group.is_locked = is_locked;
  }

  void ReadParameter(const std::string& name, int id, bool is_locked, std::size_t at) {
    const auto leave_out = [&](std::string_view why) {
      Warn(fmt::format("parameter {} {}; it is left out", Quoted(name), why), at_);
    };
    if (at + 2 > record_end_) return leave_out("is cut off");
    const auto type = static_cast<std::int8_t>(bytes_[at]);
    const std::size_t dimension_count = Byte(at + 1);
    at += 2;
    if (at + dimension_count > record_end_) return leave_out("is cut off");
    C3dParameter parameter{.name = name, .is_locked = is_locked};
    for (std::size_t i = 0; i < dimension_count; ++i) parameter.dimensions.push_back(Byte(at + i));
    at += dimension_count;
    const std::size_t value_size = ValueSize(type);
    if (value_size == 0) return leave_out(fmt::format("has the unknown type {}", type));
    const std::size_t count = ProductOf(parameter.dimensions, bytes_.size());
    if (count > (record_end_ - at) / value_size) {
      return leave_out("has more values than there is room for");
    }
    parameter.values = Values(type, at, count);
    parameter.description = Description(at + count * value_size);
    if (RecordLength(parameter) > kMaxRecord) return leave_out("is longer than 65,535 bytes");
    GroupOf(id).parameters.push_back(std::move(parameter));
  }

  C3dValues Values(int type, std::size_t at, std::size_t count) const {
    if (type == -1) return std::string(bytes_.substr(at, count));
    const char* from = bytes_.data() + at;
    if (type == 1) return std::vector<std::int8_t>(from, from + count);
    return WithCodec(recording_.processor, [&](auto codec) -> C3dValues {
      if (type == 2) {
        std::vector<std::int16_t> words(count);
        for (std::size_t i = 0; i < count; ++i) {
          words[i] = static_cast<std::int16_t>(codec.LoadWord(from + 2 * i));
        }
        return words;
      }
      std::vector<float> reals(count);
      for (std::size_t i = 0; i < count; ++i) reals[i] = codec.LoadFloat(from + 4 * i);
      return reals;
    });
  }

  void ReportRepeats(std::size_t begin) {
    std::set<std::string> names;
    for (const C3dGroup& group : recording_.groups) {
      if (group.name.empty()) {
        Warn(fmt::format("{} parameters belong to a group {} that is not there",
                         group.parameters.size(), group.id),
             begin);
      } else if (!names.insert(ToLower(group.name)).second) {
        Warn(fmt::format("two groups are named {}; both are kept, the first is used",
                         Quoted(group.name)),
             begin);
      }
      std::set<std::string> parameters;
      std::size_t repeats = 0;
      for (const C3dParameter& each : group.parameters) {
        repeats += parameters.insert(ToLower(each.name)).second ? 0 : 1;
      }
      if (repeats > 0) {
        Warn(fmt::format("{} parameters of group {} repeat a name; all are kept, the first of each "
                         "is used",
                         repeats, Quoted(group.name)),
             begin);
      }
    }
  }

  std::string_view bytes_;
  std::size_t limit_;
  C3dRecording& recording_;
  std::map<int, std::size_t> group_of_id_;
  std::size_t at_ = 0;
  std::size_t record_end_ = 0;    // Of the current record; the end of all where it does not tell.
  std::size_t contents_end_ = 0;  // Where its own contents end; 0 if they make no sense.
};

class SectionWriter {
 public:
  explicit SectionWriter(C3dProcessor processor) : processor_(processor) {}

  std::string Write(const std::vector<C3dGroup>& groups) {
    out_ = {1, kC3dKey, 0, static_cast<char>(processor_)};
    for (const C3dGroup& group : groups) WriteGroup(group);
    out_.append(2, '\0');  // Ends the chain.
    out_.resize((out_.size() + kC3dBlock - 1) / kC3dBlock * kC3dBlock);
    out_[2] = static_cast<char>(std::min(out_.size() / kC3dBlock, kMaxBlockCount));
    return std::move(out_);
  }

 private:
  [[noreturn]] static void Refuse(const std::string& message) {
    throw Error(ErrorCode::kInvalidArgument, message);
  }

  void WriteGroup(const C3dGroup& group) {
    const int max_id = group.name.empty() ? 127 : 128;
    if (group.id < (group.name.empty() ? 0 : 1) || group.id > max_id) {
      Refuse(fmt::format("group {} has the number {}; a C3D file takes 1 to {}", Quoted(group.name),
                         group.id, max_id));
    }
    if (!group.parameters.empty() && group.id > 127) {
      Refuse(fmt::format("group {} has the number 128, to which no parameter can belong",
                         Quoted(group.name)));
    }
    if (!group.name.empty()) {
      WriteStart(group.name, -group.id, group.is_locked, RecordLength(group));
      WriteDescription(group.description);
    }
    for (const C3dParameter& parameter : group.parameters) WriteParameter(parameter, group);
  }

  void WriteStart(const std::string& name, int id, bool is_locked, std::size_t length) {
    if (name.empty() || name.size() > kMaxName) {
      Refuse(fmt::format("the name {} has {} bytes; a C3D file takes 1 to {}", Quoted(name),
                         name.size(), kMaxName));
    }
    if (length > kMaxRecord) {
      Refuse(fmt::format("{} takes {} bytes; a C3D file has room for {} in one parameter",
                         Quoted(name), length, kMaxRecord));
    }
    const int name_length = static_cast<int>(name.size());
    out_ += static_cast<char>(is_locked ? -name_length : name_length);
    out_ += static_cast<char>(id);
    out_ += name;
    WriteWord(static_cast<std::uint16_t>(length));
  }

  void WriteWord(std::uint16_t word) {
    char bytes[2];
    StoreWord(processor_, bytes, word);
    out_.append(bytes, sizeof(bytes));
  }

  void WriteDescription(const std::string& description) {
    if (description.size() > kMaxDescription) {
      Refuse(fmt::format("the description {} has {} bytes; a C3D file takes {}",
                         Quoted(description), description.size(), kMaxDescription));
    }
    out_ += static_cast<char>(description.size());
    out_ += description;
  }

  void WriteParameter(const C3dParameter& parameter, const C3dGroup& group) {
    if (parameter.dimensions.size() > 255 ||
        ProductOf(parameter.dimensions, parameter.size()) != parameter.size()) {
      Refuse(
          fmt::format("parameter {}:{} has {} values, which are not as many as its dimensions "
                      "say",
                      group.name, parameter.name, parameter.size()));
    }
    WriteStart(parameter.name, group.id, parameter.is_locked, RecordLength(parameter));
    out_ += static_cast<char>(TypeOf(parameter.values));
    out_ += static_cast<char>(parameter.dimensions.size());
    for (const std::uint8_t dimension : parameter.dimensions) out_ += static_cast<char>(dimension);
    WriteValues(parameter.values);
    WriteDescription(parameter.description);
  }

  void WriteValues(const C3dValues& values) {
    if (const auto* text = std::get_if<std::string>(&values)) {
      out_ += *text;
    } else if (const auto* bytes = std::get_if<std::vector<std::int8_t>>(&values)) {
      out_.append(bytes->begin(), bytes->end());
    } else if (const auto* words = std::get_if<std::vector<std::int16_t>>(&values)) {
      for (const std::int16_t word : *words) WriteWord(static_cast<std::uint16_t>(word));
    } else {
      for (const float real : std::get<std::vector<float>>(values)) {
        char stored[4];
        StoreFloat(processor_, stored, real);
        out_.append(stored, sizeof(stored));
      }
    }
  }

  C3dProcessor processor_;
  std::string out_;
};

}  // namespace

std::size_t RecordLength(const C3dGroup& group) { return 2 + 1 + group.description.size(); }

std::size_t RecordLength(const C3dParameter& parameter) {
  return 2 + 2 + parameter.dimensions.size() +
         parameter.size() * ValueSize(TypeOf(parameter.values)) + 1 + parameter.description.size();
}

void ReadParameterSection(std::string_view bytes, std::size_t begin, std::size_t limit,
                          C3dRecording& recording) {
  SectionReader(bytes, limit, recording).Read(begin);
}

std::string FormatParameterSection(const std::vector<C3dGroup>& groups, C3dProcessor processor) {
  return SectionWriter(processor).Write(groups);
}

}  // namespace kinebase::internal
