// One writer at a time. Internal.
#pragma once

#include <filesystem>

namespace kinebase::internal {

// Holds the library for writing as long as the object lives. The system lets go of it when the
// process ends, however it ends; readers need none.
class LibraryLock {
 public:
  // Errors  IoFailure: another process or thread is writing, naming it; the system refuses.
  explicit LibraryLock(const std::filesystem::path& library);
  ~LibraryLock();
  LibraryLock(const LibraryLock&) = delete;
  LibraryLock& operator=(const LibraryLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace kinebase::internal
