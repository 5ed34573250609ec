#include "cli/annotate_output.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>

#include "cli/failure_output.h"
#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/pictures/timeline_picture.h"

namespace kinebase::cli {
namespace {

// A segment with the names that people know it by; without a cost where no class fits.
struct NamedSegment {
  std::string class_name;
  std::int64_t first_frame = 0;
  std::int64_t last_frame = 0;
  double start_s = 0;
  double end_s = 0;
  std::optional<double> cost;
  std::optional<double> confidence;
};

NamedSegment Named(const AnnotatedTake& take, std::string class_name, const PlaceRange& frames) {
  return {.class_name = std::move(class_name),
          .first_frame = frames.first,
          .last_frame = frames.last,
          .start_s = static_cast<double>(frames.first - 1) / take.rate_hz,
          .end_s = static_cast<double>(frames.last) / take.rate_hz,
          .cost = {},
          .confidence = {}};
}

const std::string& ClassOf(const Annotation& annotation, const AnnotationCandidate& segment) {
  return annotation.classes[static_cast<std::size_t>(segment.motion_class)];
}

std::vector<NamedSegment> NamedSegments(const Annotation& annotation, const AnnotatedTake& take) {
  std::vector<NamedSegment> list;
  for (const AnnotationCandidate& segment : take.segments) {
    list.push_back(Named(take, ClassOf(annotation, segment), {segment.first, segment.last}));
    list.back().cost = segment.cost;
    list.back().confidence = segment.confidence;
  }
  if (annotation.shows_unknown) {
    for (const PlaceRange& frames : UncoveredStretches(take.segments, {1, take.frame_count})) {
      list.push_back(Named(take, std::string(kUnknownClass), frames));
    }
  }
  std::ranges::stable_sort(list, {}, &NamedSegment::first_frame);
  return list;
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

std::string OrNothing(const std::optional<double>& value) {
  return value ? ToShortestText(*value) : std::string();
}

Json CountsToJson(const std::vector<AccuracyCounts>& counts,
                  const std::vector<std::string>& classes) {
  const AccuracyCounts micro = AnnotationAccuracy::Micro(counts);
  const MacroAccuracy macro = AnnotationAccuracy::Macro(counts);
  Json list = Json::array();
  for (std::size_t i = 0; i < classes.size(); ++i) {
    list.push_back({{"class", classes[i]},
                    {"right", counts[i].right},
                    {"found", counts[i].found},
                    {"present", counts[i].present},
                    {"precision", counts[i].precision()},
                    {"recall", counts[i].recall()},
                    {"f1", counts[i].f1()}});
  }
  return {
      {"micro", {{"precision", micro.precision()}, {"recall", micro.recall()}, {"f1", micro.f1()}}},
      {"macro", {{"precision", macro.precision}, {"recall", macro.recall}, {"f1", macro.f1}}},
      {"classes", std::move(list)}};
}

Json AccuracyToJson(const AnnotationAccuracy& accuracy, const std::vector<std::string>& classes) {
  std::vector<std::string> names = classes;
  names.emplace_back(kUnknownClass);
  return {{"frames", CountsToJson(accuracy.frames, classes)},
          {"segments", CountsToJson(accuracy.segments, classes)},
          {"confusion", {{"classes", names}, {"frames", accuracy.confusion}}}};
}

std::string Share(double value) { return fmt::format("{:.3f}", value); }

std::string CountsTable(const std::vector<AccuracyCounts>& counts,
                        const std::vector<std::string>& classes, const std::string& what) {
  TextTable table({what, ">right", ">found", ">present", ">precision", ">recall", ">F1"});
  const auto add = [&](const std::string& name, const AccuracyCounts& of) {
    table.Add({name, std::to_string(of.right), std::to_string(of.found), std::to_string(of.present),
               Share(of.precision()), Share(of.recall()), Share(of.f1())});
  };
  for (std::size_t i = 0; i < classes.size(); ++i) add(classes[i], counts[i]);
  add("micro", AnnotationAccuracy::Micro(counts));
  const MacroAccuracy macro = AnnotationAccuracy::Macro(counts);
  table.Add({"macro", "", "", "", Share(macro.precision), Share(macro.recall), Share(macro.f1)});
  return table.ToString();
}

// Classes are numbered across, as their names are long.
std::string ConfusionTable(const AnnotationAccuracy& accuracy,
                           const std::vector<std::string>& classes) {
  std::vector<std::string> titles = {">", "frames that are, found as"};
  for (std::size_t i = 0; i < classes.size(); ++i) titles.push_back('>' + std::to_string(i + 1));
  titles.emplace_back(">unknown");
  TextTable table(std::move(titles));
  for (std::size_t i = 0; i <= classes.size(); ++i) {
    const bool is_class = i < classes.size();
    std::vector<std::string> cells = {is_class ? std::to_string(i + 1) : std::string(),
                                      is_class ? classes[i] : std::string(kUnknownClass)};
    for (const std::int64_t frames : accuracy.confusion[i]) cells.push_back(std::to_string(frames));
    table.Add(std::move(cells));
  }
  return table.ToString();
}

bool KnowsConfidence(const Annotation& annotation) {
  return std::ranges::any_of(annotation.takes, [](const AnnotatedTake& take) {
    return std::ranges::any_of(take.segments, [](const AnnotationCandidate& segment) {
      return segment.confidence.has_value();
    });
  });
}

// As "2026-01-31T12:00:00+00:00".
std::string Now() {
  const auto now = std::chrono::system_clock::now();
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}+00:00",
                     fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

// Rows for the classes, and below them for labels of the truth that are none.
Timeline TimelineOf(const Annotation& annotation, const AnnotatedTake& take) {
  Timeline timeline{.title = take.path.filename().string(),
                    .duration_s = static_cast<double>(take.frame_count) / take.rate_hz,
                    .rows = {},
                    .has_truth = !take.truth.empty()};
  for (const std::string& name : annotation.classes) timeline.rows.push_back({name, {}, {}});
  const auto bar = [&](std::int64_t first, std::int64_t last) {
    return TimelineBar{static_cast<double>(first - 1) / take.rate_hz,
                       static_cast<double>(last) / take.rate_hz};
  };
  for (const AnnotationCandidate& segment : take.segments) {
    timeline.rows[static_cast<std::size_t>(segment.motion_class)].found.push_back(
        bar(segment.first, segment.last));
  }
  for (const SegmentLabel& label : take.truth) {
    if (label.label == kUnknownClass) continue;
    auto row = std::ranges::find(timeline.rows, label.label, &TimelineRow::name);
    if (row == timeline.rows.end()) {
      timeline.rows.push_back({label.label, {}, {}});
      row = timeline.rows.end() - 1;
    }
    row->truth.push_back(bar(label.first_frame, label.last_frame));
  }
  return timeline;
}

}  // namespace

Json ToJson(const Annotation& annotation) {
  Json segments = Json::array();
  for (const AnnotatedTake& take : annotation.takes) {
    for (const NamedSegment& segment : NamedSegments(annotation, take)) {
      segments.push_back({{"file", take.path.string()},
                          {"class", segment.class_name},
                          {"first_frame", segment.first_frame},
                          {"last_frame", segment.last_frame},
                          {"start_s", segment.start_s},
                          {"end_s", segment.end_s},
                          {"cost", OrNull(segment.cost)},
                          {"confidence", OrNull(segment.confidence)}});
    }
  }
  Json thresholds = Json::array();
  for (const UsedThreshold& used : annotation.thresholds) {
    thresholds.push_back(
        {{"template", used.template_name}, {"class", used.class_name}, {"tau", used.tau}});
  }
  Json json = {{"segments", std::move(segments)}, {"thresholds", std::move(thresholds)}};
  if (annotation.accuracy) {
    json["accuracy"] = AccuracyToJson(*annotation.accuracy, annotation.classes);
  }
  if (!annotation.failures.empty()) json["failed"] = FailuresToJson(annotation.failures);
  return json;
}

std::string ToCsv(const Annotation& annotation) {
  std::string text = "file,class,first_frame,last_frame,start_s,end_s,cost,confidence\n";
  for (const AnnotatedTake& take : annotation.takes) {
    for (const NamedSegment& segment : NamedSegments(annotation, take)) {
      text += fmt::format("{},{},{},{},{},{},{},{}\n", CsvField(take.path.string()),
                          CsvField(segment.class_name), segment.first_frame, segment.last_frame,
                          ToShortestText(segment.start_s), ToShortestText(segment.end_s),
                          OrNothing(segment.cost), OrNothing(segment.confidence));
    }
  }
  return text;
}

std::string ToElan(const Annotation& annotation, const AnnotatedTake& take) {
  std::vector<AnnotationTier> tiers;
  if (annotation.one_track) {
    tiers.push_back({"motion", {}});
  } else {
    for (const std::string& name : annotation.classes) tiers.push_back({name, {}});
    if (annotation.shows_unknown) tiers.push_back({std::string(kUnknownClass), {}});
  }
  for (const NamedSegment& segment : NamedSegments(annotation, take)) {
    AnnotationTier& tier =
        annotation.one_track ? tiers.front()
                             : *std::ranges::find(tiers, segment.class_name, &AnnotationTier::name);
    tier.segments.push_back({segment.start_s, segment.end_s, segment.class_name});
  }
  return FormatElan(tiers, {.date = Now(), .recording = take.path});
}

std::string SegmentTable(const Annotation& annotation) {
  const bool with_confidence = KnowsConfidence(annotation);
  std::vector<std::string> titles = {"class", ">frames", ">time", ">cost"};
  if (with_confidence) titles.emplace_back(">confidence");
  titles.emplace_back("file");
  TextTable table(std::move(titles));
  for (const AnnotatedTake& take : annotation.takes) {
    for (const NamedSegment& segment : NamedSegments(annotation, take)) {
      std::vector<std::string> cells = {
          segment.class_name, fmt::format("{}-{}", segment.first_frame, segment.last_frame),
          fmt::format("{}-{}", FormatTime(segment.start_s), FormatTime(segment.end_s)),
          segment.cost ? fmt::format("{:.4f}", *segment.cost) : std::string()};
      if (with_confidence) {
        cells.push_back(segment.confidence ? fmt::format("{:.2f}", *segment.confidence)
                                           : std::string());
      }
      cells.push_back(take.path.string());
      table.Add(std::move(cells));
    }
  }
  return table.ToString();
}

std::string AccuracyTables(const Annotation& annotation) {
  const AnnotationAccuracy& accuracy = *annotation.accuracy;
  return CountsTable(accuracy.frames, annotation.classes, "frames") + '\n' +
         CountsTable(accuracy.segments, annotation.classes, "segments") + '\n' +
         ConfusionTable(accuracy, annotation.classes);
}

void DrawAnnotation(const Annotation& annotation, const std::filesystem::path& path,
                    Overwrite overwrite) {
  std::vector<Timeline> timelines;
  timelines.reserve(annotation.takes.size());
  for (const AnnotatedTake& take : annotation.takes) {
    timelines.push_back(TimelineOf(annotation, take));
  }
  DrawTimelines(timelines, path, overwrite);
}

}  // namespace kinebase::cli
