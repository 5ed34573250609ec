#include "kinebase/core/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
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

// A name beside `path` that no other thread or process uses.
std::filesystem::path TemporaryName(const std::filesystem::path& path) {
  static std::atomic<unsigned> counter{0};
  std::filesystem::path name = path;
  name += ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
  return name;
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
int Publish(const std::filesystem::path& temporary, const std::filesystem::path& path,
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
  if (std::filesystem::exists(path)) return EEXIST;
  return ::rename(temporary.c_str(), path.c_str()) == 0 ? 0 : errno;
}

}  // namespace

void CheckWritable(const std::filesystem::path& path, Overwrite overwrite) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(ErrorCode::kIoFailure, "is a folder; name a file", {.file = path});
  }
  if (overwrite == Overwrite::kNo && std::filesystem::exists(path, ignored)) {
    ThrowAlreadyExists(path);
  }
}

void WriteFile(const std::filesystem::path& path, std::string_view contents, Overwrite overwrite) {
  CheckWritable(path, overwrite);
  if (path.has_parent_path()) {
    std::error_code error;
    std::filesystem::create_directories(path.parent_path(), error);
    if (error) ThrowIoFailure(path.parent_path(), error.value());
  }
  const std::filesystem::path temporary = TemporaryName(path);
  int error = WriteDurably(temporary, contents);
  if (error == 0) error = Publish(temporary, path, overwrite);
  if (error == 0) return;
  ::unlink(temporary.c_str());
  if (error == EEXIST) ThrowAlreadyExists(path);
  ThrowIoFailure(path, error);
}

}  // namespace kinebase
