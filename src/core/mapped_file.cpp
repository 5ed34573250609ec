#include "kinebase/core/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "kinebase/core/error.h"

namespace kinebase {
namespace {

// Closes the descriptor at the end of the scope: the mapping outlives it.
struct Descriptor {
  int value;
  ~Descriptor() {
    if (value >= 0) ::close(value);
  }
};

[[noreturn]] void ThrowSystemError(const std::filesystem::path& path, int error) {
  const auto code =
      error == ENOENT || error == ENOTDIR ? ErrorCode::kNotFound : ErrorCode::kIoFailure;
  throw Error(code, std::strerror(error), {.file = path});
}

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.value < 0) ThrowSystemError(path, errno);
  struct stat status {};
  if (::fstat(file.value, &status) != 0) ThrowSystemError(path, errno);
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorCode::kIoFailure, "is not a regular file", {.file = path});
  }
  if (status.st_size == 0) return;  // mmap refuses empty ranges.
  size_ = static_cast<std::size_t>(status.st_size);
  void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file.value, 0);
  if (data == MAP_FAILED) {
    size_ = 0;
    ThrowSystemError(path, errno);
  }
  ::madvise(data, size_, MADV_SEQUENTIAL);  // Only a hint: its failure changes nothing.
  data_ = static_cast<const char*>(data);
}

void MappedFile::Release(std::string_view part) const {
  // Whole pages only: what shares a page with the part may still be needed.
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const auto offset = static_cast<std::size_t>(part.data() - data_);
  const std::size_t begin = (offset + page - 1) / page * page;
  const std::size_t end = (offset + part.size()) / page * page;
  if (begin >= end) return;
  ::madvise(const_cast<char*>(data_) + begin, end - begin, MADV_DONTNEED);  // Failing is no harm.
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

}  // namespace kinebase
