#include "library/lookalikes.h"

#include <array>
#include <limits>

#include "kinebase/search/subsequence_dtw.h"

namespace kinebase::internal {
namespace {

// Chosen on actors left out among the training actors, where from 60 to all were the same but for
// noise (docs/design/contrast.md).
constexpr int kMostLookalikes = 100;

// Poses by the template's column that a path matches them to.
class ColumnMeans {
 public:
  explicit ColumnMeans(int columns) : sums_(columns), counts_(columns) {}

  void Add(std::span<const PathCell> path, const PoseStream& poses) {
    for (const PathCell& cell : path) {
      const std::span<const float> pose = poses.Column(cell.recording_column);
      const auto column = static_cast<std::size_t>(cell.template_column);
      for (std::size_t i = 0; i < pose.size(); ++i) sums_[column][i] += pose[i];
      ++counts_[column];
    }
  }

  // A column that all paths step over is as the one before. Every path begins with the first.
  [[nodiscard]] std::vector<float> Means() const {
    std::vector<float> means;
    means.reserve(sums_.size() * kPoseValues);
    std::size_t from = 0;
    for (std::size_t column = 0; column < sums_.size(); ++column) {
      if (counts_[column] > 0) from = column;
      for (const double sum : sums_[from]) {
        means.push_back(static_cast<float>(sum / counts_[from]));
      }
    }
    return means;
  }

 private:
  std::vector<std::array<double, kPoseValues>> sums_;
  std::vector<int> counts_;
};

}  // namespace

void FindLookalikes(std::span<const LabelledClip* const> clips,
                    std::span<const RecordingStreams> unlabelled, int threads,
                    std::span<MotionTemplate> templates) {
  std::vector<RecordingStreams> recordings;
  recordings.reserve(clips.size() + unlabelled.size());
  for (const LabelledClip* clip : clips) {
    recordings.push_back({.features = clip->take.features, .poses = &clip->take.poses});
  }
  recordings.insert(recordings.end(), unlabelled.begin(), unlabelled.end());
  const auto hits = RankHits(templates, recordings,
                             {.lookalikes = false,
                              .rivals = false,
                              .most_hits = std::numeric_limits<std::size_t>::max(),
                              .threads = threads});
  for (std::size_t t = 0; t < templates.size(); ++t) {
    MotionTemplate& each = templates[t];
    if (!each.contrast) continue;
    const QuantizedTemplate quantized = Quantize(each);
    ColumnMeans means(each.matrix.column_count());
    int found = 0;
    for (const RankedHit& ranked : hits[t]) {
      if (found == kMostLookalikes) break;
      const auto i = static_cast<std::size_t>(ranked.hit.recording);
      if (i < clips.size() && clips[i]->class_name == each.name) continue;
      means.Add(TracePath(quantized, recordings[i].features.columns, ranked.hit.last),
                *recordings[i].poses);
      ++found;
    }
    if (found > 0) each.contrast->places.lookalikes = means.Means();
  }
}

}  // namespace kinebase::internal
