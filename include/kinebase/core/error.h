// The one way in which Kinebase says that it could not do what was asked.
//
// Start here, then core/diagnostic.h for what is odd but no obstacle.
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <string>

namespace kinebase {

enum class ErrorCode {
  kInvalidArgument,  // The caller asked for something that makes no sense.
  kNotFound,         // A file, skeleton, joint or feature that is named does not exist.
  kMalformedFile,    // A file is not what its format promises.
  kMismatch,         // Two things do not belong together: a template and another feature set.
  kAlreadyExists,    // An output is there and overwriting was not asked for.
  kIoFailure,        // The system refused: permissions, a full disk.
  kCancelled,        // A progress callback asked to stop.
};

// Where in which file. Unknown parts keep their defaults.
struct Place {
  std::filesystem::path file;
  std::int64_t line = 0;   // 1-based; 0 = unknown.
  std::int64_t byte = -1;  // 0-based offset; -1 = unknown.

  [[nodiscard]] std::string ToString() const;  // "take.amc:12", "take.c3d at byte 512", "".
};

// Every exception that leaves Kinebase is of this type or std::bad_alloc.
//
// `what()` is one line for a person: place, what was found, what was expected, what to do.
class Error : public std::exception {
 public:
  Error(ErrorCode code, std::string message, Place place = {});

  [[nodiscard]] const char* what() const noexcept override { return what_.c_str(); }
  [[nodiscard]] ErrorCode code() const { return code_; }
  [[nodiscard]] const std::string& message() const { return message_; }  // Without the place.
  [[nodiscard]] const Place& place() const { return place_; }

 private:
  ErrorCode code_;
  std::string message_;
  Place place_;
  std::string what_;
};

}  // namespace kinebase
