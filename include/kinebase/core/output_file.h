// Writing files so that a crash, a full disk or a second run never leaves half of one.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

namespace kinebase {

enum class Overwrite { kNo, kYes };

// Writes `contents` to a file beside `path`, flushes it to the disk and renames it to `path`;
// missing folders are made.
//
// Errors   AlreadyExists if `path` is there and `overwrite` is kNo; IoFailure. `path` is then as
//          it was.
// Threads  May be called concurrently, also for the same path: one of the writers wins whole.
void WriteFile(const std::filesystem::path& path, std::string_view contents, Overwrite overwrite);

struct FileContents {
  std::filesystem::path path;
  std::string_view contents;
};

// Files that belong together: all are written before the first gets its name, so that a full disk
// leaves none of them.
//
// Errors  As WriteFile.
void WriteFiles(std::span<const FileContents> files, Overwrite overwrite);

// Throws AlreadyExists if `path` is there and `overwrite` is kNo, IoFailure if it is a folder or a
// device: asked before long work begins.
void CheckWritable(const std::filesystem::path& path, Overwrite overwrite);

}  // namespace kinebase
