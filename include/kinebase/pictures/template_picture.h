// A motion template as a picture: rows = features by name, columns = time.
//
// Read templates/motion_template.h first. docs/pictures.md shows how to read the picture.
// Source: Müller & Röder, "Motion Templates ...", SCA 2006, Figs. 2 to 6.
// Departures: weights are bars as high as they are large, as well as coloured; a legend, names of
// the features and a time axis, which the figures lack.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/output_file.h"
#include "kinebase/features/feature_matrix.h"
#include "kinebase/features/feature_set.h"
#include "kinebase/motion/standard_skeleton.h"
#include "kinebase/pictures/canvas.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// Black at 0, red at 3/8, yellow at 3/4, white at 1, and straight between: what all performances
// agree on is black or white, what they vary in is coloured. Lightness grows with the value, so
// the picture can be read without colours too.
[[nodiscard]] Color TemplateColor(double value);

// An entry that a quantised template leaves free.
inline constexpr Color kAnyColor = {150, 150, 150};

struct TemplatePictureOptions {
  bool quantized = false;  // Black, white and gray for zeros, ones and "any" by the template's δ.
  bool weights = true;     // Bars above with the weight of each column.
};

// The time axis follows the weights: a column of weight 2 lasts twice as long as its neighbours,
// though it is drawn as wide.
//
// Errors  Mismatch if `features` is not the template's set; InvalidArgument if the template has no
//         columns, no rate, or values or weights that no template can have; those of WritePicture.
void DrawTemplate(const MotionTemplate& motion_template, const FeatureSet& features,
                  const std::filesystem::path& path, Overwrite overwrite,
                  const TemplatePictureOptions& options = {});

// A recording's feature matrix the same way: black = 0, white = 1. Where there are more columns
// than can be told apart (1600), several are drawn as one with the share of ones among them.
//
// Errors  Mismatch if the matrix has another number of rows than the set; InvalidArgument if it
//         has no columns or no rate; those of WritePicture.
void DrawFeatureMatrix(const FeatureMatrix& matrix, const FeatureSet& features,
                       const std::string& title, const std::filesystem::path& path,
                       Overwrite overwrite);

// One column of a template against the column of a recording that it was matched with.
struct ComparedColumn {
  std::uint64_t consistent = 0;  // Bit i: feature i is asked for,
  std::uint64_t ones = 0;        // and must hold.
  std::uint64_t recording = 0;   // It does.
};

// How a joint lay along the warping path.
struct ComparedJoint {
  StandardJoint joint = StandardJoint::kRoot;
  double cost = 0;          // Of the hit's.
  std::vector<double> off;  // [column] from where the class has it, in spreads; from 0.
};

// What a hit's cost is made of, where features do not all count the same and poses count too.
struct ComparedCosts {
  std::vector<double> features;  // [feature]
  std::vector<ComparedJoint> joints;
  double lookalikes = 0;  // For poses that are rather those of what looks like the class.
};

// Each row twice: above what the template asks for (black = must not hold, white = must hold, gray
// = any), below what the recording does, red where that is not as asked.
//
// With costs they stand at the right of the rows, and below the features there is a row a joint,
// the redder the farther it is off: white = as the class has it, red = two spreads or more.
//
// columns  Along the warping path, `rate_hz` of them a second.
// Errors   InvalidArgument without columns or rate, or for costs of another number of features or
//          columns; those of WritePicture.
void DrawComparison(std::span<const ComparedColumn> columns, double rate_hz,
                    const FeatureSet& features, const std::string& title,
                    const std::filesystem::path& path, Overwrite overwrite,
                    const std::optional<ComparedCosts>& costs = {});

}  // namespace kinebase
