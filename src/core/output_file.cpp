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

#include "kinebase/core/error.h"

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

// Writes and flushes; 0 or the system's error number.
int WriteDurably(const std::filesystem::path& path, std::string_view contents) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  int error = 0;
  while (!contents.empty() && error == 0) {
    const ssize_t written = ::write(file, contents.data(), contents.size());
    if (written >= 0) {
      contents.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      error = errno;
    }
  }
  if (error == 0 && ::fsync(file) != 0) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
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

// A file that is written and has not got its name yet.
class PendingFile {
 public:
  PendingFile(const std::filesystem::path& named_path, std::string_view contents) {
    // A link stays, and what it points to is written.
    std::error_code not_there;
    const std::filesystem::path target = std::filesystem::canonical(named_path, not_there);
    path_ = not_there ? named_path : target;
    if (path_.has_parent_path()) {
      std::error_code error;
      std::filesystem::create_directories(path_.parent_path(), error);
      if (error) ThrowIoFailure(path_.parent_path(), error.value());
    }
    int error = 0;
    do {  // A process that crashed under the same number may have left one behind.
      temporary_ = TemporaryName(path_);
      error = WriteDurably(temporary_, contents);
    } while (error == EEXIST);
    if (error == 0) return;
    ::unlink(temporary_.c_str());
    ThrowIoFailure(path_, error);
  }
  ~PendingFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  void Publish(Overwrite overwrite) {
    const int error = GiveName(temporary_, path_, overwrite);
    if (error == EEXIST) ThrowAlreadyExists(path_);
    if (error != 0) ThrowIoFailure(path_, error);
    temporary_.clear();
  }

  // What was not there before Publish() is gone again.
  void Withdraw() const { ::unlink(path_.c_str()); }

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;
};

}  // namespace

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
  for (const FileContents& file : files) pending.emplace_back(file.path, file.contents);
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

}  // namespace kinebase
