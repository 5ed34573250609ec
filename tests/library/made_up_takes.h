// Small AMC files of one made-up figure, for tests of libraries on disk.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kinebase/library/take_import.h"
#include "kinebase/library/take_library.h"
#include "library/sqlite_database.h"
#include "motion/figure.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {

inline std::filesystem::path WriteMadeUpTake(const std::filesystem::path& path, unsigned seed,
                                             int frames) {
  Diagnostics ignored;
  const Motion motion = SmoothMotion(FigureSkeleton(), seed, frames, 120);
  WriteText(path, FormatAmc(ToAmc(motion, ignored)));
  return path;
}

// A folder with takes a … of actor xx, class wave, and one for their library.
class MadeUpTakes {
 public:
  explicit MadeUpTakes(int takes = 3) {
    WriteText(folder_.path() / "takes" / "HDM_xx.asf", FormatAsf(FigureAsf()));
    for (int i = 0; i < takes; ++i) {
      files_.push_back(WriteMadeUpTake(
          folder_.path() / "takes" / ("HDM_xx_wave_00" + std::to_string(i + 1) + "_120.amc"),
          static_cast<unsigned>(i + 1), 40 + 30 * i));
    }
  }

  [[nodiscard]] std::filesystem::path folder() const { return folder_.path() / "takes"; }
  [[nodiscard]] std::filesystem::path library() const { return folder_.path() / "library"; }
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

  [[nodiscard]] std::vector<ImportSource> Sources() const {
    std::vector<ImportSource> sources;
    sources.reserve(files_.size());
    for (const auto& file : files_) sources.push_back({.file = file});
    return sources;
  }

  [[nodiscard]] static ImportOptions Options() {
    return {.features = LoadFeatureSet("bonn"), .threads = 1};
  }

  ImportReport Import(const ImportOptions& options = Options()) const {
    return ImportTakes(library(), Sources(), options);
  }

  [[nodiscard]] std::filesystem::path Segment(int number) const {
    return library() / "segments" / ("0000000" + std::to_string(number) + ".segment");
  }

 private:
  TemporaryFolder folder_;
  std::vector<std::filesystem::path> files_;
};

// The takes that a filter leaves, read; those that cannot be read are failures.
inline TakeBatch LoadAll(const TakeLibrary& library, const FeatureSet& features, double rate_hz,
                         const TakeFilter& filter = {}, bool with_poses = false) {
  TakeBatch batch;
  for (const StoredTake* take : library.TakesWith(features, rate_hz, filter, with_poses)) {
    try {
      batch.takes.push_back(library.LoadTake(*take, features, rate_hz, with_poses));
    } catch (const Error& error) {
      batch.failures.push_back({take->path, error});
    }
  }
  return batch;
}

// Changes the rows of a catalogue behind its back.
inline void ExecuteSql(const std::filesystem::path& library, const std::string& sql) {
  internal::SqliteDatabase(library / "catalogue.sqlite", internal::SqliteDatabase::Access::kCreate)
      .Execute(sql.c_str());
}

// Changes one byte of a file.
inline void Spoil(const std::filesystem::path& path, std::size_t byte) {
  std::string bytes = ReadText(path);
  bytes.at(byte) = static_cast<char>(bytes.at(byte) ^ 1);
  WriteText(path, bytes);
}

}  // namespace kinebase::test
