#include "kinebase/search/example_search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "search/plain_scan.h"
#include "search/search_checks.h"
#include "templates/matrix_check.h"

namespace kinebase {
namespace {

double RotationDistance(std::span<const float> a, std::span<const float> b) {
  constexpr std::size_t kNumbers = 4;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); i += kNumbers) {
    double product = 0;
    for (std::size_t j = i; j < i + kNumbers; ++j) product += static_cast<double>(a[j]) * b[j];
    sum += std::acos(std::min(std::abs(product), 1.0));  // q and −q are one rotation.
  }
  return sum * (2 / std::numbers::pi);
}

double PositionDistance(std::span<const float> a, std::span<const float> b) {
  constexpr std::size_t kNumbers = 3;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); i += kNumbers) {
    double squares = 0;
    for (std::size_t j = i; j < i + kNumbers; ++j) {
      const double difference = static_cast<double>(a[j]) - b[j];
      squares += difference * difference;
    }
    sum += std::sqrt(squares);
  }
  return sum;
}

// What the columns of a template cost against any feature word, eight features at a time: a table
// says for each value of eight features what they add up to.
class UnquantizedCosts {
 public:
  UnquantizedCosts(const TemplateMatrix& matrix, Profile matching)
      : bytes_((static_cast<std::size_t>(matrix.feature_count) + kBits - 1) / kBits),
        tables_(static_cast<std::size_t>(matrix.column_count()) * bytes_ * kWords) {
    for (int column = 0; column < matrix.column_count(); ++column) {
      const double weight = matrix.weights[static_cast<std::size_t>(column)];
      const double scale =
          (matching == Profile::kBonn ? (weight + 1) / 2 : 1) / matrix.feature_count;
      Fill(matrix.Column(column), scale, static_cast<std::size_t>(column));
    }
  }

  [[nodiscard]] double At(std::size_t column, std::uint64_t features) const {
    double cost = 0;
    const double* table = tables_.data() + column * bytes_ * kWords;
    for (std::size_t byte = 0; byte < bytes_; ++byte, table += kWords) {
      cost += table[(features >> (kBits * byte)) & (kWords - 1)];
    }
    return cost;
  }

 private:
  static constexpr std::size_t kBits = 8;
  static constexpr std::size_t kWords = std::size_t{1} << kBits;

  void Fill(std::span<const double> values, double scale, std::size_t column) {
    for (std::size_t byte = 0; byte < bytes_; ++byte) {
      const std::size_t first = byte * kBits;
      const std::size_t count = std::min(kBits, values.size() - first);
      double* table = tables_.data() + (column * bytes_ + byte) * kWords;
      for (std::size_t word = 0; word < kWords; ++word) {
        for (std::size_t i = 0; i < count; ++i) {
          const double value = values[first + i];
          table[word] += ((word >> i) & 1U) != 0 ? (1 - value) * scale : value * scale;
        }
      }
    }
  }

  std::size_t bytes_;
  std::vector<double> tables_;  // [column × byte × value of the byte]
};

[[noreturn]] void FailToCompare(const std::string& recording, const std::string& example) {
  throw Error(ErrorCode::kMismatch,
              fmt::format("a recording has {}, the example {}; extract both in the same way",
                          recording, example));
}

std::string Shape(const FeatureMatrix& features) {
  return fmt::format("{} features and {} columns a second", features.feature_count,
                     features.rate_hz);
}

std::string Shape(const JointStream& stream) {
  return fmt::format("{} of {} joints and {} columns a second",
                     stream.kind == JointStreamKind::kRotations ? "rotations" : "positions",
                     stream.joint_count, stream.rate_hz);
}

std::string Shape(const TemplateMatrix& matrix) {
  return fmt::format("{} features and {} columns a second", matrix.feature_count, matrix.rate_hz);
}

bool SameShape(const JointStream& a, const JointStream& b) {
  return a.kind == b.kind && a.joint_count == b.joint_count && a.rate_hz == b.rate_hz;
}

template <typename Example>
bool SameShape(const Example& a, const FeatureMatrix& b) {
  return a.feature_count == b.feature_count && a.rate_hz == b.rate_hz;
}

template <typename Example, typename Stream>
void CheckComparable(const Example& example, const Stream& recording) {
  if (example.column_count() == 0) {
    throw Error(ErrorCode::kInvalidArgument, "an example needs at least one column");
  }
  if (!SameShape(example, recording)) FailToCompare(Shape(recording), Shape(example));
}

void CheckMatrix(const TemplateMatrix& matrix) {
  if (const std::string problem = internal::ProblemOf(matrix); !problem.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "template has " + problem);
  }
}

DeltaCurve ScanUnquantized(const UnquantizedCosts& costs, int rows, const FeatureMatrix& recording,
                           Profile matching) {
  return internal::ScanPlainly(rows, recording.columns.size(), matching, [&](int k, std::size_t l) {
    return costs.At(static_cast<std::size_t>(k), recording.columns[l]);
  });
}

// Hits by the curve that `curve_of` gives for each recording.
template <typename Stream, typename CurveOf>
std::vector<Hit> SearchByCurves(std::span<const Stream> recordings, const SearchOptions& options,
                                const CurveOf& curve_of) {
  internal::CheckTau(options.tau);
  std::vector<std::vector<Hit>> found(recordings.size());
  ParallelFor(recordings.size(), options.threads, "searching", options.progress,
              [&](std::size_t i) {
                found[i] = ExtractHits(curve_of(recordings[i]), options.tau, static_cast<int>(i));
              });
  std::vector<Hit> hits;
  for (const std::vector<Hit>& some : found) hits.insert(hits.end(), some.begin(), some.end());
  return BestHits(std::move(hits), options.most_hits);
}

}  // namespace

DeltaCurve ComputeExampleDelta(const FeatureMatrix& example, const FeatureMatrix& recording,
                               Profile matching) {
  CheckComparable(example, recording);
  const double scale = 1.0 / example.feature_count;
  return internal::ScanPlainly(
      example.column_count(), recording.columns.size(), matching, [&](int k, std::size_t l) {
        const std::uint64_t differs =
            example.columns[static_cast<std::size_t>(k)] ^ recording.columns[l];
        return std::popcount(differs) * scale;
      });
}

DeltaCurve ComputeExampleDelta(const JointStream& example, const JointStream& recording,
                               Profile matching) {
  CheckComparable(example, recording);
  const auto distance =
      example.kind == JointStreamKind::kRotations ? &RotationDistance : &PositionDistance;
  return internal::ScanPlainly(
      example.column_count(), static_cast<std::size_t>(recording.column_count()), matching,
      [&](int k, std::size_t l) {
        return distance(example.Column(k), recording.Column(static_cast<int>(l))) /
               example.joint_count;
      });
}

DeltaCurve ComputeUnquantizedDelta(const TemplateMatrix& matrix, const FeatureMatrix& recording,
                                   Profile matching) {
  CheckMatrix(matrix);
  CheckComparable(matrix, recording);
  return ScanUnquantized(UnquantizedCosts(matrix, matching), matrix.column_count(), recording,
                         matching);
}

std::vector<Hit> SearchExample(const FeatureMatrix& example,
                               std::span<const FeatureMatrix> recordings,
                               const SearchOptions& options, Profile matching) {
  return SearchByCurves(recordings, options, [&](const FeatureMatrix& recording) {
    return ComputeExampleDelta(example, recording, matching);
  });
}

std::vector<Hit> SearchExample(const JointStream& example, std::span<const JointStream> recordings,
                               const SearchOptions& options, Profile matching) {
  return SearchByCurves(recordings, options, [&](const JointStream& recording) {
    return ComputeExampleDelta(example, recording, matching);
  });
}

std::vector<Hit> SearchUnquantized(const TemplateMatrix& matrix,
                                   std::span<const FeatureMatrix> recordings,
                                   const SearchOptions& options, Profile matching) {
  CheckMatrix(matrix);
  const UnquantizedCosts costs(matrix, matching);
  return SearchByCurves(recordings, options, [&](const FeatureMatrix& recording) {
    CheckComparable(matrix, recording);
    return ScanUnquantized(costs, matrix.column_count(), recording, matching);
  });
}

}  // namespace kinebase
