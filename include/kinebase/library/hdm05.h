// The HDM05 database as it is documented: actors, script, takes, motion classes, videos.
//
// library/hdm05_check.h compares a copy with it.
// Source: Documentation Mocap Database HDM05 (CG-2007-2), Sect. 2. How its tables were repaired,
// and what stays empty because it is lost: docs/hdm05.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinebase {

enum class Hdm05Format : std::size_t { kAmc, kC3d };
inline constexpr std::array kHdm05Formats = {Hdm05Format::kAmc, Hdm05Format::kC3d};
[[nodiscard]] std::string_view ToString(Hdm05Format format);  // "AMC", "C3D".

struct Hdm05Actor {
  std::string id;  // "bd", as in file names.
  std::string name;
};

struct Hdm05Part {
  int part = 0;
  std::string title;
};

// One thing that the script asks for.
struct Hdm05Step {
  int number = 0;  // Within its scene, from 1.
  std::string text;
  std::vector<std::string> classes;  // Motion classes that show it.
};

// Every take of a scene begins and ends with a short T-pose, which is no step.
struct Hdm05Scene {
  int part = 0;
  int scene = 0;
  std::string title;
  std::vector<Hdm05Step> steps;
};

// What the documentation says is wrong with a take or a clip.
struct Hdm05Defect {
  std::string text;               // Empty: nothing is known.
  std::array<bool, 2> formats{};  // By Hdm05Format: whose files it concerns.
  int clip = 0;                   // Number of the only clip of a class that it concerns; 0: all.
};

struct Hdm05Take {
  std::string actor;
  int part = 0;
  int scene = 0;
  int take = 0;
  std::optional<std::int64_t> frame_count;  // At 120 Hz.
  std::string description;  // Where the script has none or the take is special; else empty.
  Hdm05Defect defect;

  [[nodiscard]] std::string name() const;  // "HDM_bd_01-01_01"; files add "_120".
};

// Clips of all actors are numbered in one row, in the order of the actors.
struct Hdm05Class {
  std::string name;
  int clip_count = 0;
  std::vector<int> clips_of_actor;  // [actor]
  std::string description;
  Hdm05Defect defect;
};

struct Hdm05Video {
  std::string file;  // "HDM_bd_01-01_01_25.avi", "HDM_bd_turnLeft_001_25.avi".
  std::string take;  // "HDM_bd_01-01_01"; empty: lost.
  // Frames of the take that the video shows; the documentation calls them approximate.
  std::optional<std::int64_t> first_frame;
  std::optional<std::int64_t> last_frame;
  std::optional<std::int64_t> take_end;  // The take's last frame, for videos of whole takes.
  std::string comment;
};

struct Hdm05Catalogue {
  std::vector<Hdm05Actor> actors;
  std::vector<Hdm05Part> parts;     // Of the script; takes of parts 6 to 8 are freestyle.
  std::vector<Hdm05Scene> scenes;   // Of the script, in its order.
  std::vector<Hdm05Take> takes;     // By actor, part, scene, take.
  std::vector<Hdm05Class> classes;  // By name.
  std::vector<Hdm05Video> videos;

  // Null where there is none.
  [[nodiscard]] const Hdm05Scene* FindScene(int part, int scene) const;
  [[nodiscard]] const Hdm05Class* FindClass(std::string_view name) const;
  // "HDM_bd_01-01_01".
  [[nodiscard]] const Hdm05Take* FindTake(std::string_view name) const;
  [[nodiscard]] std::optional<std::size_t> FindActor(std::string_view id) const;

  // actor "" and part 0: all.
  [[nodiscard]] int TakeCount(std::string_view actor = {}, int part = 0) const;
  [[nodiscard]] int ClipCount() const;
  [[nodiscard]] int ClipCount(std::size_t actor) const;
};

[[nodiscard]] const Hdm05Catalogue& Hdm05();

// The numbers of an actor's clips of a class; `first` > `last` if there are none.
struct Hdm05ClipNumbers {
  int first = 1;
  int last = 0;

  [[nodiscard]] int count() const { return last - first + 1; }
  [[nodiscard]] bool contains(int number) const { return number >= first && number <= last; }
};
[[nodiscard]] Hdm05ClipNumbers ClipNumbers(const Hdm05Class& motion_class, std::size_t actor);

// "HDM_bk_squat1Reps_013"; files add "_120".
[[nodiscard]] std::string Hdm05ClipName(const Hdm05Class& motion_class, std::size_t actor,
                                        int number);

struct Hdm05Query {
  std::string words;  // Any case. All must be there; the beginning of a word will do. "" = all.
  std::string actor;  // Empty: all.
  std::optional<int> part;  // Empty: all.
};

// A scene whose script has the words, and its takes.
struct Hdm05Match {
  int part = 0;
  int scene = 0;
  const Hdm05Scene* script = nullptr;   // Null for freestyle takes.
  std::vector<const Hdm05Step*> steps;  // Where the words are; empty: in title or description.
  std::vector<const Hdm05Take*> takes;  // May be empty.
};

// Takes by the words of their script: of its steps with the names of the motion classes that they
// show ("kickRFront1Reps" counts as kick, r, front, …), of titles, and of a take's own description.
//
// Best first: scenes that have all words in one step or a take's description; then in one step
// and the titles of scene and part; then anywhere in the scene. Otherwise in the script's order.
[[nodiscard]] std::vector<Hdm05Match> FindHdm05Takes(const Hdm05Query& query);

// Motion classes whose name or description has all words, by name.
[[nodiscard]] std::vector<const Hdm05Class*> FindHdm05Classes(std::string_view words);

}  // namespace kinebase
