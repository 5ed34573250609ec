// The cost curves that `search --curve` writes: a table of one template, a picture of several.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/search_output.h"
#include "kinebase/core/file_stream.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/take_search.h"
#include "kinebase/pictures/delta_picture.h"

namespace kinebase::cli {

// By its extension; everything else is a table.
[[nodiscard]] bool IsPicture(const std::filesystem::path& path);

// Takes the curves of takes while these are at hand. A table is written as they come, a picture in
// the end; neither is there before.
class CurveFile {
 public:
  // Errors  Those of FileStream.
  CurveFile(std::filesystem::path path, std::size_t templates, Overwrite overwrite);

  // tau    Of the template's hits.
  // which  Its index among all; a table has one.
  void Add(const MotionTemplate& motion_template, double tau, std::size_t which,
           std::span<const TakeView> takes);

  // Of the takes of a picture.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

  // labels  May be empty; those of other recordings are passed over.
  // Errors  Those of DrawDeltaCurves and FileStream.
  void Write(const std::vector<NamedHit>& hits, std::span<const SegmentLabel> labels);

 private:
  DeltaPanel& PanelOf(const TakeView& take);

  void AddTable(const QuantizedTemplate& quantized, const TakeView& take);

  std::filesystem::path path_;
  std::size_t templates_;
  Overwrite overwrite_;
  std::optional<FileStream> table_;
  std::vector<DeltaPanel> panels_;                   // A take each,
  std::vector<std::filesystem::path> files_;         // its file,
  std::map<std::filesystem::path, std::size_t> of_;  // and where it is among them.
};

// Errors  Mismatch: there are none for any of these recordings.
void CheckLabels(std::span<const SegmentLabel> labels,
                 std::span<const std::filesystem::path> recordings,
                 const std::filesystem::path& file);

}  // namespace kinebase::cli
