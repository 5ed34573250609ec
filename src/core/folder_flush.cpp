#include "kinebase/core/folder_flush.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "kinebase/core/error.h"

namespace kinebase {
namespace {

[[noreturn]] void ThrowSystemError(const std::filesystem::path& folder, int error) {
  const auto code =
      error == ENOENT || error == ENOTDIR ? ErrorCode::kNotFound : ErrorCode::kIoFailure;
  throw Error(code, std::string("cannot be flushed to the disk: ") + std::strerror(error),
              {.file = folder});
}

}  // namespace

void FlushFolder(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) ThrowSystemError(folder, errno);
  // A file system that cannot do this for folders (EINVAL) has no such promise to give.
  const int error = ::fsync(file) == 0 || errno == EINVAL ? 0 : errno;
  ::close(file);
  if (error != 0) ThrowSystemError(folder, error);
}

}  // namespace kinebase
