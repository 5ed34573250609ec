// Writing files that are longer than memory should be, whole or not at all.
//
// Read core/output_file.h first.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "kinebase/core/output_file.h"

namespace kinebase {

namespace internal {
class PendingFile;
}  // namespace internal

// A file that is written piece by piece beside `path`, where it is gone again unless Publish() is
// called.
class FileStream {
 public:
  // Errors  As WriteFile.
  FileStream(const std::filesystem::path& path, Overwrite overwrite);
  ~FileStream();
  FileStream(const FileStream&) = delete;
  FileStream& operator=(const FileStream&) = delete;

  // Errors  IoFailure.
  void Append(std::string_view contents);

  // Flushes it to the disk and renames it to `path`. Called once, in the end.
  // Errors  As WriteFile.
  void Publish();

 private:
  std::unique_ptr<internal::PendingFile> file_;
  Overwrite overwrite_;
};

}  // namespace kinebase
