// A whole file as one read-only span of bytes, paged in by the system as it is read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace kinebase {

// Owns the mapping; `text()` is valid as long as the object lives. Movable, not copyable.
//
// A file that another process shortens while it is mapped ends the program with SIGBUS, as with
// every mapped file; Kinebase itself never shortens one (core/output_file.h renames).
class MappedFile {
 public:
  // Errors  NotFound; IoFailure, also for a folder or a device.
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view text() const { return {data_, size_}; }

  // Gives back the memory of a part of the text that has been read. It can still be read, and is
  // then fetched from the file again.
  void Release(std::string_view part) const;

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace kinebase
