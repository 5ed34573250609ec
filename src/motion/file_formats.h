// The functions behind the rows of MotionFormats(), a pair a format; each is defined in its
// format's `*_file.cpp`.
#pragma once

#include "kinebase/motion/motion_file.h"

namespace kinebase::internal {

Recording LoadAsfAmc(const std::filesystem::path& path, const LoadOptions& options);
void SaveAsfAmc(const Recording& recording, const std::filesystem::path& path,
                const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadC3d(const std::filesystem::path& path, const LoadOptions& options);
void SaveC3d(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadBvh(const std::filesystem::path& path, const LoadOptions& options);
void SaveBvh(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadCsm(const std::filesystem::path& path, const LoadOptions& options);
void SaveCsm(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadTrc(const std::filesystem::path& path, const LoadOptions& options);
void SaveTrc(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

// OpenSim's tables of values over time: joint angles, or analog channels of markers' recordings.
void SaveMot(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);
void SaveSto(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadNpz(const std::filesystem::path& path, const LoadOptions& options);
void SaveNpz(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

Recording LoadMat(const std::filesystem::path& path, const LoadOptions& options);
void SaveMat(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

void SaveCsv(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

void SaveGlb(const Recording& recording, const std::filesystem::path& path,
             const SaveOptions& options, Diagnostics& diagnostics);

// The rate of a file that does not tell: as asked for, else by its name, else 120 Hz with a
// warning. Errors  InvalidArgument for a rate that no recording has.
double ChooseRate(const TakeName& name, const LoadOptions& options, Diagnostics& diagnostics);

// What is written as points: the markers, or all joints of the skeleton under their bones' names
// (with a diagnostic). Y up, centimetres.
MarkerCloud PointsOf(const Recording& recording, Diagnostics& diagnostics);

// Errors  Mismatch, naming what would help, if the recording has no skeleton to write into `path`.
void RequireSkeleton(const Recording& recording, std::string_view format,
                     const std::filesystem::path& path);

}  // namespace kinebase::internal
