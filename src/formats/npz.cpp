// Reads and writes the ZIP archive around the arrays, with libzip.

#include "kinebase/formats/npz.h"

#include <zip.h>

#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr std::string_view kArrayExtension = ".npy";

constexpr std::uint64_t kLargestGrowth = 100;

// Levels beyond 1 take several times as long for a few percent of these numbers.
constexpr zip_uint32_t kDeflateLevel = 1;

struct DiscardArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct CloseMember {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};
struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using ArchiveHandle = std::unique_ptr<zip_t, DiscardArchive>;
using MemberHandle = std::unique_ptr<zip_file_t, CloseMember>;
using SourceHandle = std::unique_ptr<zip_source_t, FreeSource>;

// An error of libzip.
class ZipError {
 public:
  ZipError() { zip_error_init(&error_); }
  ~ZipError() { zip_error_fini(&error_); }
  ZipError(const ZipError&) = delete;
  ZipError& operator=(const ZipError&) = delete;

  zip_error_t* get() { return &error_; }
  std::string text() { return zip_error_strerror(&error_); }

 private:
  zip_error_t error_;
};

class ArchiveReader {
 public:
  ArchiveReader(std::string_view bytes, const std::filesystem::path& file,
                const NpzReadOptions& options)
      : file_(file),
        left_(std::max<std::uint64_t>(options.unpacked_limit, kLargestGrowth * bytes.size())) {
    if (!bytes.starts_with("PK")) {
      Fail("expected a ZIP archive of arrays (NPZ), found " + Quoted(bytes.substr(0, 40)));
    }
    ZipError error;
    SourceHandle source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, error.get()));
    if (source) archive_.reset(zip_open_from_source(source.get(), ZIP_RDONLY, error.get()));
    if (!archive_) Fail("is no whole ZIP archive: " + error.text());
    (void)source.release();  // The archive's now.
  }

  NpzArchive Read() {
    NpzArchive result;
    const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) TakeMember(static_cast<zip_uint64_t>(i), result);
    return result;
  }

 private:
  [[noreturn]] void Fail(const std::string& message) const {
    throw Error(ErrorCode::kMalformedFile, message, {file_});
  }

  void TakeMember(zip_uint64_t index, NpzArchive& result) {
    zip_stat_t about;
    if (zip_stat_index(archive_.get(), index, 0, &about) != 0) {
      Fail(fmt::format("entry {} of the archive: {}", index, zip_strerror(archive_.get())));
    }
    std::string name = about.name != nullptr ? about.name : "";
    if (name.ends_with('/')) return;  // A folder.
    if (!names_.insert(name).second) Fail(fmt::format("holds {} twice", Quoted(name)));
    std::string bytes = Unpack(index, name, about);
    if (!name.ends_with(kArrayExtension)) {
      result.members.push_back({std::move(name), std::move(bytes)});
      return;
    }
    try {
      result.arrays.push_back(
          ParseNpy(bytes, name.substr(0, name.size() - kArrayExtension.size()), file_));
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kMismatch) throw;
      result.diagnostics.push_back({Severity::kInfo, error.message() + "; kept as it is"});
      result.members.push_back({std::move(name), std::move(bytes)});
    }
  }

  std::string Unpack(zip_uint64_t index, const std::string& name, const zip_stat_t& about) {
    const bool understood =
        (about.valid & ZIP_STAT_COMP_METHOD) != 0 &&
        (about.comp_method == ZIP_CM_STORE || about.comp_method == ZIP_CM_DEFLATE) &&
        about.encryption_method == ZIP_EM_NONE;
    if (!understood) {
      Fail(
          fmt::format("{} is encrypted or packed in an unusual way; numpy.savez and "
                      "numpy.savez_compressed write what can be read",
                      Quoted(name)));
    }
    const MemberHandle member(zip_fopen_index(archive_.get(), index, 0));
    if (!member) Fail(fmt::format("{}: {}", Quoted(name), zip_strerror(archive_.get())));
    std::string bytes;
    std::array<char, 1 << 16> buffer;
    while (true) {
      const zip_int64_t got = zip_fread(member.get(), buffer.data(), buffer.size());
      if (got < 0) Fail(fmt::format("{}: {}", Quoted(name), zip_file_strerror(member.get())));
      if (got == 0) break;
      if (static_cast<std::uint64_t>(got) > left_) {
        Fail(
            fmt::format("{} unpacks to more than a hundred times the archive; if that is right, "
                        "write it with numpy.savez, which does not compress",
                        Quoted(name)));
      }
      left_ -= static_cast<std::uint64_t>(got);
      bytes.append(buffer.data(), static_cast<std::size_t>(got));
    }
    if ((about.valid & ZIP_STAT_SIZE) != 0 && about.size != bytes.size()) {
      Fail(fmt::format("{} says it has {} bytes, but has {}", Quoted(name), about.size,
                       bytes.size()));
    }
    return bytes;
  }

  const std::filesystem::path& file_;
  std::uint64_t left_;  // What may still be unpacked.
  ArchiveHandle archive_;
  std::set<std::string> names_;
};

class ArchiveWriter {
 public:
  ArchiveWriter() {
    target_.reset(zip_source_buffer_create(nullptr, 0, 0, error_.get()));
    if (target_) archive_.reset(zip_open_from_source(target_.get(), ZIP_TRUNCATE, error_.get()));
    if (!archive_) Fail(error_.text());
    zip_source_keep(target_.get());  // Once for the archive, once for what is read from it.
  }

  // `bytes` must live until the archive is finished.
  void Add(const std::string& name, std::string_view bytes) {
    if (!names_.insert(name).second) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("two members of the archive are named {}", Quoted(name)));
    }
    SourceHandle source(zip_source_buffer(archive_.get(), bytes.data(), bytes.size(), 0));
    const zip_int64_t index =
        source ? zip_file_add(archive_.get(), name.c_str(), source.get(), ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) Fail(zip_strerror(archive_.get()));
    (void)source.release();  // The archive's now.
    const auto at = static_cast<zip_uint64_t>(index);
    constexpr zip_uint16_t kFirstDay = (1 << 5) | 1;  // 1980-01-01: the same bytes every time.
    if (zip_set_file_compression(archive_.get(), at, ZIP_CM_DEFLATE, kDeflateLevel) != 0 ||
        zip_file_set_dostime(archive_.get(), at, 0, kFirstDay, 0) != 0) {
      Fail(zip_strerror(archive_.get()));
    }
  }

  std::string Finish() {
    if (names_.empty()) return EmptyArchive();
    if (zip_close(archive_.get()) != 0) Fail(zip_strerror(archive_.get()));
    (void)archive_.release();
    zip_stat_t about;
    zip_source_t* const target = target_.get();
    if (zip_source_stat(target, &about) != 0 || zip_source_open(target) != 0) {
      Fail(zip_error_strerror(zip_source_error(target)));
    }
    std::string bytes(about.size, '\0');
    const zip_int64_t got = zip_source_read(target, bytes.data(), bytes.size());
    zip_source_close(target);
    if (got < 0 || static_cast<std::uint64_t>(got) != about.size) Fail("cannot be read back");
    return bytes;
  }

 private:
  [[noreturn]] static void Fail(const std::string& message) {
    throw Error(ErrorCode::kIoFailure, "the archive could not be written: " + message);
  }

  // libzip deletes an archive without members; as a file it is the end of a directory and no more.
  static std::string EmptyArchive() {
    constexpr std::size_t kEndOfDirectorySize = 22;
    std::string bytes = "PK\5\6";
    bytes.resize(kEndOfDirectorySize, '\0');
    return bytes;
  }

  ZipError error_;
  SourceHandle target_;
  ArchiveHandle archive_;
  std::set<std::string> names_;
};

}  // namespace

const NpzArray* NpzArchive::Find(std::string_view name) const {
  const auto found = std::ranges::find(arrays, name, &NpzArray::name);
  return found == arrays.end() ? nullptr : &*found;
}

NpzArchive ParseNpz(std::string_view bytes, const std::filesystem::path& file,
                    const NpzReadOptions& options) {
  return ArchiveReader(bytes, file, options).Read();
}

NpzArchive ReadNpz(const std::filesystem::path& path, const NpzReadOptions& options) {
  return ParseNpz(MappedFile(path).text(), path, options);
}

std::string FormatNpz(const NpzArchive& archive) {
  std::vector<std::string> arrays;
  arrays.reserve(archive.arrays.size());
  for (const NpzArray& array : archive.arrays) arrays.push_back(FormatNpy(array));
  ArchiveWriter writer;
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    writer.Add(archive.arrays[i].name + std::string(kArrayExtension), arrays[i]);
  }
  for (const NpzMember& member : archive.members) writer.Add(member.name, member.bytes);
  return writer.Finish();
}

}  // namespace kinebase
