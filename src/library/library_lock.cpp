#include "library/library_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "library/library_layout.h"

namespace kinebase::internal {
namespace {

// Whoever holds the lock has left the number of its process in the file; empty if it did not yet.
std::string HolderOf(int file) {
  std::array<char, 24> text{};
  const ssize_t size = ::pread(file, text.data(), text.size() - 1, 0);
  const auto number = ParseInteger(
      Trim(std::string_view(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0)));
  return number ? fmt::format(" (process {})", *number) : std::string();
}

}  // namespace

LibraryLock::LibraryLock(const std::filesystem::path& library) {
  const std::filesystem::path path = LockFile(library);
  const auto refuse = [&](std::string message) {
    if (file_ >= 0) ::close(file_);
    throw Error(ErrorCode::kIoFailure, std::move(message), {.file = path});
  };
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) refuse(fmt::format("cannot be written: {}", std::strerror(errno)));
  int result = 0;
  do {
    result = ::flock(file_, LOCK_EX | LOCK_NB);
  } while (result != 0 && errno == EINTR);
  if (result != 0 && errno == EWOULDBLOCK) {
    refuse(fmt::format("somebody else{} is writing to this library; try again when that has ended",
                       HolderOf(file_)));
  }
  if (result != 0) refuse(fmt::format("cannot be locked: {}", std::strerror(errno)));
  // Only for the message above: a full disk is no obstacle here.
  const std::string holder = std::to_string(::getpid());
  if (::ftruncate(file_, 0) == 0) {
    [[maybe_unused]] const ssize_t written = ::pwrite(file_, holder.data(), holder.size(), 0);
  }
}

LibraryLock::~LibraryLock() { ::close(file_); }

}  // namespace kinebase::internal
