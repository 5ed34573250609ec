#include "kinebase/library/library_labels.h"

#include <algorithm>
#include <map>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"
#include "library/catalogue.h"
#include "library/library_lock.h"
#include "library/named_recordings.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::Catalogue;
using internal::SqliteDatabase;
using internal::SqliteTransaction;

void CheckChange(const LabelChange& change) {
  for (const auto* labels : {&change.add, &change.remove}) {
    for (const std::string& label : *labels) {
      if (!Trim(label).empty()) continue;
      throw Error(ErrorCode::kInvalidArgument, "a label is empty; name it by a word or more");
    }
  }
  const bool is_whole = change.first_frame == 0 && change.last_frame == 0;
  if (is_whole || (change.first_frame >= 1 && change.last_frame >= change.first_frame)) return;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("frames {}-{}: expected a first frame from 1 and a last one that is not "
                          "before it",
                          change.first_frame, change.last_frame));
}

void CheckWithin(const LabelChange& change, const StoredTake& take) {
  if (change.last_frame <= take.frame_count) return;
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("has {} frames; frames {}-{} are not all within it", take.frame_count,
                          change.first_frame, change.last_frame),
              {.file = take.path});
}

// Whether it is new.
bool Add(const StoredLabel& label, StoredTake& take) {
  if (std::ranges::find(take.labels, label) != take.labels.end()) return false;
  take.labels.push_back(label);
  return true;
}

std::size_t Remove(const LabelChange& change, StoredTake& take) {
  return std::erase_if(take.labels, [&](const StoredLabel& label) {
    const bool is_within = change.first_frame == 0 || (label.first_frame >= change.first_frame &&
                                                       label.last_frame <= change.last_frame);
    return is_within && std::ranges::find(change.remove, label.text) != change.remove.end();
  });
}

void Store(const fs::path& library, std::span<const StoredTake> takes) {
  if (takes.empty()) return;
  Catalogue catalogue(library, SqliteDatabase::Access::kCreate);
  SqliteTransaction transaction(catalogue.database(), SqliteTransaction::Kind::kWrite);
  for (const StoredTake& take : takes) catalogue.PutTake(take);
  transaction.Commit();
}

// A label of all frames is one of the take as a whole: tables have no other way to say it.
StoredLabel Labelled(std::string_view text, std::int64_t first_frame, std::int64_t last_frame,
                     std::int64_t frames) {
  const bool is_whole = first_frame <= 1 && last_frame >= frames;
  if (is_whole) return {std::string(Trim(text))};
  return {std::string(Trim(text)), first_frame, std::min(last_frame, frames)};
}

StoredLabel ToStored(const SegmentLabel& label, std::int64_t frames, const Place& place) {
  if (label.first_frame > frames) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("begins at frame {}, but {} has {} frames", label.first_frame,
                            Quoted(label.recording), frames),
                place);
  }
  if (Trim(label.label).empty()) {
    throw Error(ErrorCode::kInvalidArgument, "the label is empty", place);
  }
  return Labelled(label.label, label.first_frame, label.last_frame, frames);
}

}  // namespace

LabelReport ChangeLabels(const fs::path& library, const TakeChoice& choice,
                         const LabelChange& change) {
  CheckChange(change);
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  LabelReport report;
  std::vector<StoredTake> changed;
  for (const StoredTake* chosen : ChooseTakesToChange(opened, choice)) {
    CheckWithin(change, *chosen);
    StoredTake take = *chosen;
    report.removed += static_cast<std::int64_t>(Remove(change, take));
    for (const std::string& label : change.add) {
      const StoredLabel added =
          change.first_frame == 0
              ? StoredLabel{std::string(Trim(label))}
              : Labelled(label, change.first_frame, change.last_frame, take.frame_count);
      report.added += Add(added, take) ? 1 : 0;
    }
    if (take.labels != chosen->labels) changed.push_back(std::move(take));
  }
  Store(library, changed);
  report.takes = std::ssize(changed);
  return report;
}

LabelReport AddSegmentLabels(const fs::path& library, const TakeChoice& choice,
                             std::span<const SegmentLabel> labels, const fs::path& table) {
  internal::CheckIsLibrary(library);
  const internal::LibraryLock lock(library);
  const TakeLibrary opened(library);
  const internal::NamedRecordings recordings(ChooseTakesToChange(opened, choice));
  LabelReport report;
  std::map<const StoredTake*, StoredTake> changed;
  for (const SegmentLabel& label : labels) {
    const Place place{table, label.line};
    const StoredTake* take = recordings.Find(label.file, label.recording, place);
    if (take == nullptr) {
      ++report.passed_over;
      continue;
    }
    const StoredLabel stored = ToStored(label, take->frame_count, place);
    report.added += Add(stored, changed.try_emplace(take, *take).first->second) ? 1 : 0;
  }
  if (changed.empty()) {
    throw Error(ErrorCode::kNotFound, "labels no recording that the library holds",
                {.file = table});
  }
  std::vector<StoredTake> takes;
  takes.reserve(changed.size());
  for (auto& [before, after] : changed) {
    if (after.labels.size() != before->labels.size()) takes.push_back(std::move(after));
  }
  Store(library, takes);
  report.takes = std::ssize(takes);
  return report;
}

std::string FormatLabelTable(std::span<const StoredTake* const> takes) {
  std::string text = "file,class,first_frame,last_frame\n";
  for (const StoredTake* take : takes) {
    for (const StoredLabel& label : take->labels) {
      const bool is_whole = label.first_frame == 0;
      text += fmt::format("{},{},{},{}\n", CsvField(take->path.string()), CsvField(label.text),
                          is_whole ? 1 : label.first_frame,
                          is_whole ? take->frame_count : label.last_frame);
    }
  }
  return text;
}

}  // namespace kinebase
