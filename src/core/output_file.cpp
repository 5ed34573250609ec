#include "kinebase/core/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <deque>
#include <string>
#include <system_error>
#include <utility>

#include "kinebase/core/error.h"
#include "kinebase/core/file_stream.h"

namespace kinebase {
namespace {

[[noreturn]] void ThrowIoFailure(const std::filesystem::path& path, int error) {
  throw Error(ErrorCode::kIoFailure, std::string("cannot write: ") + std::strerror(error),
              {.file = path});
}

[[noreturn]] void ThrowAlreadyExists(const std::filesystem::path& path) {
  throw Error(ErrorCode::kAlreadyExists,
              "exists already; choose another name or overwrite it with --force", {.file = path});
}

// A name beside `path` that no other thread or process uses. It does not contain that of `path`,
// which may be as long as the system allows.
std::filesystem::path TemporaryName(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  return path.parent_path() /
         (".kinebase-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp");
}

// Gives the finished file its name. Without overwriting, link() refuses atomically where the name
// is taken, which rename() would not.
int GiveName(const std::filesystem::path& temporary, const std::filesystem::path& path,
             Overwrite overwrite) {
  if (overwrite == Overwrite::kYes) {
    return ::rename(temporary.c_str(), path.c_str()) == 0 ? 0 : errno;
  }
  if (::link(temporary.c_str(), path.c_str()) == 0) {
    ::unlink(temporary.c_str());
    return 0;
  }
  if (errno == EEXIST) return EEXIST;
  // A file system without hard links: the check and the rename are two steps there.
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return EEXIST;
  return ::rename(temporary.c_str(), path.c_str()) == 0 ? 0 : errno;
}

}  // namespace

namespace internal {

// A file that is written and has not got its name yet.
class PendingFile {
 public:
  explicit PendingFile(const std::filesystem::path& named_path) {
    // A link stays, and what it points to is written.
    std::error_code not_there;
    const std::filesystem::path target = std::filesystem::canonical(named_path, not_there);
    path_ = not_there ? named_path : target;
    if (path_.has_parent_path()) {
      std::error_code error;
      std::filesystem::create_directories(path_.parent_path(), error);
      if (error) ThrowIoFailure(path_.parent_path(), error.value());
    }
    do {  // A process that crashed under the same number may have left one behind.
      temporary_ = TemporaryName(path_);
      file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (file_ < 0 && errno == EEXIST);
    if (file_ >= 0) return;
    ThrowIoFailure(path_, errno);
  }
  ~PendingFile() {
    if (file_ >= 0) ::close(file_);
    if (!is_published_) ::unlink(temporary_.c_str());
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void Append(std::string_view contents) const {
    while (!contents.empty()) {
      const ssize_t written = ::write(file_, contents.data(), contents.size());
      if (written >= 0) {
        contents.remove_prefix(static_cast<std::size_t>(written));
      } else if (errno != EINTR) {
        ThrowIoFailure(path_, errno);
      }
    }
  }

  // Everything that was appended is on the disk.
  void Flush() {
    int error = ::fsync(file_) == 0 ? 0 : errno;
    if (::close(std::exchange(file_, -1)) != 0 && error == 0) error = errno;
    if (error != 0) ThrowIoFailure(path_, error);
  }

  // Flushed before.
  void Publish(Overwrite overwrite) {
    const int error = GiveName(temporary_, path_, overwrite);
    if (error == EEXIST) ThrowAlreadyExists(path_);
    if (error != 0) ThrowIoFailure(path_, error);
    is_published_ = true;
  }

  // What was not there before Publish() is gone again.
  void Withdraw() const { ::unlink(path_.c_str()); }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
  int file_ = -1;
  bool is_published_ = false;
};

}  // namespace internal

using internal::PendingFile;

void CheckWritable(const std::filesystem::path& path, Overwrite overwrite) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorCode::kIoFailure, "is a folder; name a file", {.file = path});
  }
  const bool is_there = std::filesystem::exists(path, ignored);
  if (is_there && !std::filesystem::is_regular_file(path, ignored)) {
    // A device such as /dev/null would be replaced by a file, for every program on the machine.
    throw Error(ErrorCode::kIoFailure, "is no regular file; name another", {.file = path});
  }
  if (overwrite == Overwrite::kNo && is_there) ThrowAlreadyExists(path);
}

void WriteFile(const std::filesystem::path& path, std::string_view contents, Overwrite overwrite) {
  const FileContents file{.path = path, .contents = contents};
  WriteFiles({&file, 1}, overwrite);
}

void WriteFiles(std::span<const FileContents> files, Overwrite overwrite) {
  for (const FileContents& file : files) CheckWritable(file.path, overwrite);
  std::deque<PendingFile> pending;
  for (const FileContents& file : files) {
    pending.emplace_back(file.path);
    pending.back().Append(file.contents);
    pending.back().Flush();
  }
  for (auto file = pending.begin(); file != pending.end(); ++file) {
    try {
      file->Publish(overwrite);
    } catch (const Error&) {
      if (overwrite == Overwrite::kNo) {
        std::for_each(pending.begin(), file, [](const PendingFile& done) { done.Withdraw(); });
      }
      throw;
    }
  }
}

FileStream::FileStream(const std::filesystem::path& path, Overwrite overwrite)
    : overwrite_(overwrite) {
  CheckWritable(path, overwrite);
  file_ = std::make_unique<PendingFile>(path);
}

FileStream::~FileStream() = default;

void FileStream::Append(std::string_view contents) { file_->Append(contents); }

void FileStream::Publish() {
  file_->Flush();
  file_->Publish(overwrite_);
}

}  // namespace kinebase
