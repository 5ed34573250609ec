// Loaded before a program (LD_PRELOAD), this lets its calls to the system that change files go
// wrong from a certain one on. Only for tests; it does what the environment says:
//
//   KINEBASE_FAULT_AT=n     the n-th call, counted from 1; none if unset
//   KINEBASE_FAULT=kill     the program is killed instead of the call
//                  torn     a write writes half of its bytes first
//                  full     from then on calls that need room fail with ENOSPC
//                  once     this call fails with EIO, later ones do not
//   KINEBASE_FAULT_TOTAL=F  at the end the number of calls is written to F
//   KINEBASE_FAULT_FLUSHED=F  each file and folder that is flushed is added to F, a line each
//
// Flushing to the disk is counted and left out: a program that is killed loses nothing by it.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

enum class Room { kNeeded, kNotNeeded };

std::atomic<long> calls{0};

long FaultAt() {
  const char* text = std::getenv("KINEBASE_FAULT_AT");
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

bool FaultIs(const char* kind) {
  const char* text = std::getenv("KINEBASE_FAULT");
  return text != nullptr && std::strcmp(text, kind) == 0;
}

void Die() {
  ::kill(::getpid(), SIGKILL);
  ::pause();
}

// The error that this call is to fail with; 0: it is to be done.
int NextFault(Room room) {
  const long at = FaultAt();
  const long call = ++calls;
  if (at == 0 || call < at) return 0;
  if (FaultIs("full")) return room == Room::kNeeded ? ENOSPC : 0;
  if (call != at) return 0;
  if (FaultIs("once")) return EIO;
  Die();
  return 0;
}

bool IsTornNext() { return FaultIs("torn") && calls + 1 == FaultAt(); }

bool IsRegularFile(int file) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

void NoteFlushed(int file) {
  const char* path = std::getenv("KINEBASE_FAULT_FLUSHED");
  if (path == nullptr) return;
  char link[64];
  char name[4096];
  std::snprintf(link, sizeof(link), "/proc/self/fd/%d", file);
  const ssize_t size = ::readlink(link, name, sizeof(name));
  const long notes = ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0666);
  if (size > 0 && notes >= 0)
    ::dprintf(static_cast<int>(notes), "%.*s\n", static_cast<int>(size), name);
  if (notes >= 0) ::syscall(SYS_close, notes);
}

int Fail(int error) {
  errno = error;
  return -1;
}

int Open(const char* path, int flags, mode_t mode) {
  if ((flags & O_CREAT) != 0) {
    if (const int error = NextFault(Room::kNeeded)) return Fail(error);
  }
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

mode_t ModeOf(int flags, va_list arguments) {
  return (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(arguments, int)) : 0;
}

struct ReportAtExit {
  ~ReportAtExit() {
    const char* path = std::getenv("KINEBASE_FAULT_TOTAL");
    if (path == nullptr) return;
    if (std::FILE* file = std::fopen(path, "w")) {
      std::fprintf(file, "%ld\n", calls.load());
      std::fclose(file);
    }
  }
} report_at_exit;

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = ModeOf(flags, arguments);
  va_end(arguments);
  return Open(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = ModeOf(flags, arguments);
  va_end(arguments);
  return Open(path, flags, mode);
}

ssize_t write(int file, const void* data, size_t size) {
  // What is said on pipes and terminals changes no file.
  if (!IsRegularFile(file)) return ::syscall(SYS_write, file, data, size);
  if (IsTornNext()) ::syscall(SYS_write, file, data, size / 2);
  if (const int error = NextFault(Room::kNeeded)) return Fail(error);
  return ::syscall(SYS_write, file, data, size);
}

ssize_t pwrite64(int file, const void* data, size_t size, off64_t offset) {
  if (IsTornNext()) ::syscall(SYS_pwrite64, file, data, size / 2, offset);
  if (const int error = NextFault(Room::kNeeded)) return Fail(error);
  return ::syscall(SYS_pwrite64, file, data, size, offset);
}

ssize_t pwrite(int file, const void* data, size_t size, off_t offset) {
  return pwrite64(file, data, size, offset);
}

int ftruncate64(int file, off64_t size) noexcept {
  if (const int error = NextFault(Room::kNotNeeded)) return Fail(error);
  return static_cast<int>(::syscall(SYS_ftruncate, file, size));
}

int ftruncate(int file, off_t size) noexcept { return ftruncate64(file, size); }

int fsync(int file) {
  NoteFlushed(file);
  const int error = NextFault(Room::kNeeded);
  return error == 0 ? 0 : Fail(error);
}

int fdatasync(int file) { return fsync(file); }

int link(const char* from, const char* to) noexcept {
  if (const int error = NextFault(Room::kNeeded)) return Fail(error);
  return static_cast<int>(::syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int unlink(const char* path) noexcept {
  if (const int error = NextFault(Room::kNotNeeded)) return Fail(error);
  return static_cast<int>(::syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}

int remove(const char* path) noexcept { return unlink(path); }

int mkdir(const char* path, mode_t mode) noexcept {
  if (const int error = NextFault(Room::kNeeded)) return Fail(error);
  return static_cast<int>(::syscall(SYS_mkdirat, AT_FDCWD, path, mode));
}

}  // extern "C"
