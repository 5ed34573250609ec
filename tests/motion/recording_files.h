// Recordings that go to a file and come back, in a folder of their own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/motion/motion_file.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {

inline std::vector<std::string> Messages(const Diagnostics& diagnostics) {
  std::vector<std::string> messages;
  for (const auto& diagnostic : diagnostics) messages.push_back(diagnostic.message);
  return messages;
}

inline std::string With(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class RecordingFiles : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path PathOf(std::string_view name) const {
    return folder_.path() / name;
  }

  Recording LoadText(std::string_view name, std::string_view text,
                     const LoadOptions& options = {}) {
    WriteText(PathOf(name), text);
    return LoadRecording(PathOf(name), options);
  }

  // What was said while writing is in diagnostics_.
  std::string Save(const Recording& recording, std::string_view name,
                   const SaveOptions& options = {}) {
    diagnostics_.clear();
    SaveRecording(recording, PathOf(name), options, diagnostics_);
    return ReadText(PathOf(name));
  }

  Recording SaveAndLoad(const Recording& recording, std::string_view name,
                        const SaveOptions& save = {}, const LoadOptions& load = {}) {
    Save(recording, name, save);
    return LoadRecording(PathOf(name), load);
  }

  TemporaryFolder folder_;
  Diagnostics diagnostics_;
};

}  // namespace kinebase::test
