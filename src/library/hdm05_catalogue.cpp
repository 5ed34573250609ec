// The tables of data/hdm05 as types.

#include <algorithm>
#include <ranges>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/hdm05.h"

namespace kinebase {

namespace internal {
std::string_view EmbeddedData_actors();
std::string_view EmbeddedData_classes();
std::string_view EmbeddedData_parts();
std::string_view EmbeddedData_scenes();
std::string_view EmbeddedData_steps();
std::string_view EmbeddedData_takes();
std::string_view EmbeddedData_videos();
}  // namespace internal

namespace {

// A row of a table, fields by name.
class Row {
 public:
  Row(const CsvTable& table, std::size_t row) : table_(&table), row_(row) {}

  [[nodiscard]] const std::string& Text(std::string_view column) const {
    return table_->rows[row_][table_->Column(column)];
  }
  [[nodiscard]] std::optional<std::int64_t> Number(std::string_view column) const {
    const std::string& text = Text(column);
    if (text.empty()) return std::nullopt;
    const auto number = ParseInteger(text);
    if (!number) {
      throw Error(ErrorCode::kMalformedFile,
                  fmt::format("column {}: expected a whole number, found {}", column, Quoted(text)),
                  {table_->file, table_->lines[row_]});
    }
    return number;
  }
  [[nodiscard]] int Int(std::string_view column) const {
    return static_cast<int>(Number(column).value_or(0));
  }
  [[nodiscard]] std::vector<std::string> Words(std::string_view column) const {
    const auto tokens = SplitTokens(Text(column));
    return {tokens.begin(), tokens.end()};
  }

 private:
  const CsvTable* table_;
  std::size_t row_;
};

template <typename Record, typename Make>
std::vector<Record> ReadTable(std::string_view text, const char* file, Make make) {
  const CsvTable table = ParseCsv(text, file);
  std::vector<Record> records;
  records.reserve(table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) records.push_back(make(Row(table, i)));
  return records;
}

Hdm05Defect ReadDefect(const Row& row) {
  Hdm05Defect defect{.text = row.Text("comment")};
  const auto on = row.Words("comment_on");
  for (const Hdm05Format format : kHdm05Formats) {
    defect.formats[static_cast<std::size_t>(format)] =
        std::ranges::find(on, ToLower(ToString(format))) != on.end();
  }
  return defect;
}

std::vector<Hdm05Scene> ReadScenes() {
  auto scenes = ReadTable<Hdm05Scene>(internal::EmbeddedData_scenes(), "scenes.csv", [](Row row) {
    return Hdm05Scene{
        .part = row.Int("part"), .scene = row.Int("scene"), .title = row.Text("title")};
  });
  const CsvTable steps = ParseCsv(internal::EmbeddedData_steps(), "steps.csv");
  for (std::size_t i = 0; i < steps.rows.size(); ++i) {
    const Row row(steps, i);
    const auto scene = std::ranges::find_if(scenes, [&](const Hdm05Scene& candidate) {
      return candidate.part == row.Int("part") && candidate.scene == row.Int("scene");
    });
    if (scene == scenes.end()) {
      throw Error(ErrorCode::kMalformedFile, "scenes.csv has no such scene",
                  {steps.file, steps.lines[i]});
    }
    scene->steps.push_back(
        {.number = row.Int("step"), .text = row.Text("text"), .classes = row.Words("classes")});
  }
  return scenes;
}

Hdm05Take ReadTake(const Row& row) {
  return {.actor = row.Text("actor"),
          .part = row.Int("part"),
          .scene = row.Int("scene"),
          .take = row.Int("take"),
          .frame_count = row.Number("frames"),
          .description = row.Text("description"),
          .defect = ReadDefect(row)};
}

Hdm05Class ReadClass(const Row& row, std::span<const Hdm05Actor> actors) {
  Hdm05Class motion_class{.name = row.Text("class"),
                          .clip_count = row.Int("clips"),
                          .description = row.Text("description"),
                          .defect = ReadDefect(row)};
  motion_class.defect.clip = row.Int("comment_clip");
  for (const Hdm05Actor& actor : actors) {
    motion_class.clips_of_actor.push_back(row.Int(actor.id));
  }
  return motion_class;
}

Hdm05Video ReadVideo(const Row& row) {
  return {.file = row.Text("video"),
          .take = row.Text("take"),
          .first_frame = row.Number("first"),
          .last_frame = row.Number("last"),
          .take_end = row.Number("take_end"),
          .comment = row.Text("comment")};
}

Hdm05Catalogue ReadCatalogue() {
  Hdm05Catalogue catalogue;
  catalogue.actors = ReadTable<Hdm05Actor>(
      internal::EmbeddedData_actors(), "actors.csv",
      [](Row row) { return Hdm05Actor{.id = row.Text("actor"), .name = row.Text("name")}; });
  catalogue.parts = ReadTable<Hdm05Part>(internal::EmbeddedData_parts(), "parts.csv", [](Row row) {
    return Hdm05Part{.part = row.Int("part"), .title = row.Text("title")};
  });
  catalogue.scenes = ReadScenes();
  catalogue.takes = ReadTable<Hdm05Take>(internal::EmbeddedData_takes(), "takes.csv", &ReadTake);
  catalogue.classes =
      ReadTable<Hdm05Class>(internal::EmbeddedData_classes(), "classes.csv",
                            [&](Row row) { return ReadClass(row, catalogue.actors); });
  catalogue.videos =
      ReadTable<Hdm05Video>(internal::EmbeddedData_videos(), "videos.csv", &ReadVideo);
  return catalogue;
}

// The first of `range` for which `test` holds, or null.
template <typename Range, typename Test>
auto FindOrNull(const Range& range, Test test) -> const std::ranges::range_value_t<Range>* {
  const auto found = std::ranges::find_if(range, test);
  return found == range.end() ? nullptr : &*found;
}

}  // namespace

std::string_view ToString(Hdm05Format format) {
  return format == Hdm05Format::kAmc ? "AMC" : "C3D";
}

std::string Hdm05Take::name() const {
  return fmt::format("HDM_{}_{:02}-{:02}_{:02}", actor, part, scene, take);
}

const Hdm05Scene* Hdm05Catalogue::FindScene(int part, int scene) const {
  return FindOrNull(scenes, [=](const Hdm05Scene& candidate) {
    return candidate.part == part && candidate.scene == scene;
  });
}

const Hdm05Class* Hdm05Catalogue::FindClass(std::string_view name) const {
  return FindOrNull(classes, [=](const Hdm05Class& candidate) { return candidate.name == name; });
}

const Hdm05Take* Hdm05Catalogue::FindTake(std::string_view name) const {
  return FindOrNull(takes, [=](const Hdm05Take& candidate) { return candidate.name() == name; });
}

std::optional<std::size_t> Hdm05Catalogue::FindActor(std::string_view id) const {
  const auto found = std::ranges::find(actors, id, &Hdm05Actor::id);
  if (found == actors.end()) return std::nullopt;
  return static_cast<std::size_t>(found - actors.begin());
}

int Hdm05Catalogue::TakeCount(std::string_view actor, int part) const {
  return static_cast<int>(std::ranges::count_if(takes, [&](const Hdm05Take& take) {
    return (actor.empty() || take.actor == actor) && (part == 0 || take.part == part);
  }));
}

int Hdm05Catalogue::ClipCount() const {
  int count = 0;
  for (const Hdm05Class& motion_class : classes) count += motion_class.clip_count;
  return count;
}

int Hdm05Catalogue::ClipCount(std::size_t actor) const {
  int count = 0;
  for (const Hdm05Class& motion_class : classes) count += motion_class.clips_of_actor[actor];
  return count;
}

const Hdm05Catalogue& Hdm05() {
  static const Hdm05Catalogue catalogue = ReadCatalogue();
  return catalogue;
}

Hdm05ClipNumbers ClipNumbers(const Hdm05Class& motion_class, std::size_t actor) {
  int first = 1;
  for (std::size_t i = 0; i < actor; ++i) first += motion_class.clips_of_actor[i];
  return {.first = first, .last = first + motion_class.clips_of_actor[actor] - 1};
}

std::string Hdm05ClipName(const Hdm05Class& motion_class, std::size_t actor, int number) {
  return fmt::format("HDM_{}_{}_{:03}", Hdm05().actors[actor].id, motion_class.name, number);
}

}  // namespace kinebase
