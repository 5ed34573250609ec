// The cost curves that `search --curve` writes: a table of one template, a picture of several.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/take_search.h"

namespace kinebase::cli {

// A template, what it was looked for in, and what was found.
struct SearchedTemplate {
  const MotionTemplate* motion_template = nullptr;
  const TakeBatch* batch = nullptr;
  double tau = 0;
  std::vector<TakeHit> hits;
};

// By its extension; everything else is a table.
[[nodiscard]] bool IsPicture(const std::filesystem::path& path);

// file,column,frame,delta,start_frame
[[nodiscard]] std::string CurveTable(const MotionTemplate& motion_template, const TakeBatch& batch);

// templates  All searched the same recordings.
// labels     May be empty; those of other recordings are passed over.
// Errors     Those of DrawDeltaCurves.
void DrawCurves(std::span<const SearchedTemplate> templates, std::span<const SegmentLabel> labels,
                const std::filesystem::path& path, Overwrite overwrite);

// Errors  Mismatch: there are none for any of these recordings.
void CheckLabels(std::span<const SegmentLabel> labels, const TakeBatch& batch,
                 const std::filesystem::path& file);

}  // namespace kinebase::cli
