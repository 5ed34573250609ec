#include "kinebase/library/hdm05.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "kinebase/motion/motion_file.h"

namespace kinebase {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

// Counts and sums below were taken from the documentation apart from the tables: of files listed,
// of column totals.
struct ActorTotals {
  int takes;
  std::int64_t frames;
  int clips;
};
const std::map<std::string, ActorTotals> kTotals = {{"bd", {62, 268500, 501}},
                                                    {"bk", {63, 351758, 510}},
                                                    {"dg", {77, 314469, 477}},
                                                    {"mm", {61, 289973, 400}},
                                                    {"tr", {63, 301249, 455}}};

std::vector<std::string> Names(const std::vector<Hdm05Match>& matches) {
  std::vector<std::string> names;
  for (const Hdm05Match& match : matches) {
    names.push_back(std::to_string(match.part) + '-' + std::to_string(match.scene));
  }
  return names;
}

std::vector<int> Numbers(const Hdm05Match& match) {
  std::vector<int> numbers;
  for (const Hdm05Step* step : match.steps) numbers.push_back(step->number);
  return numbers;
}

TEST(Hdm05Takes, AreAsManyAndAsLongAsDocumented) {
  const Hdm05Catalogue& catalogue = Hdm05();
  EXPECT_EQ(catalogue.TakeCount(), 326);
  std::int64_t frames = 0;
  for (const auto& [id, totals] : kTotals) {
    EXPECT_EQ(catalogue.TakeCount(id), totals.takes) << id;
    std::int64_t own = 0;
    for (const Hdm05Take& take : catalogue.takes) {
      if (take.actor == id) own += take.frame_count.value_or(0);
    }
    EXPECT_EQ(own, totals.frames) << id;
    frames += own;
  }
  EXPECT_EQ(frames, 1525949);
  EXPECT_NEAR(static_cast<double>(frames) / 120 / 60, 211.9, 0.05);
}

TEST(Hdm05Takes, LackAFrameCountOnlyWhereTheDocumentationLostIt) {
  std::vector<std::string> unknown;
  for (const Hdm05Take& take : Hdm05().takes) {
    if (!take.frame_count) unknown.push_back(take.name());
  }
  EXPECT_THAT(unknown, ElementsAre("HDM_mm_01-02_01", "HDM_mm_01-02_02"));
}

TEST(Hdm05Takes, AreNumberedFromOneWithoutGapsWithinAScene) {
  const Hdm05Take* before = nullptr;
  for (const Hdm05Take& take : Hdm05().takes) {
    const bool follows = before != nullptr && before->actor == take.actor &&
                         before->part == take.part && before->scene == take.scene;
    EXPECT_EQ(take.take, follows ? before->take + 1 : 1) << take.name();
    before = &take;
  }
}

TEST(Hdm05Takes, AreSortedAndHaveTheNamesOfTheirFiles) {
  const auto& takes = Hdm05().takes;
  EXPECT_TRUE(std::ranges::is_sorted(takes, {}, &Hdm05Take::name));
  for (const Hdm05Take& take : takes) {
    const TakeName name = ParseTakeName(take.name() + "_120.amc");
    EXPECT_EQ(name.actor, take.actor);
    EXPECT_TRUE(take.name().ends_with(name.take));
    EXPECT_EQ(name.rate_hz, 120);
    EXPECT_EQ(Hdm05().FindTake(take.name()), &take);
  }
}

TEST(Hdm05Takes, HaveAScriptOrADescription) {
  for (const Hdm05Take& take : Hdm05().takes) {
    const bool scripted = Hdm05().FindScene(take.part, take.scene) != nullptr;
    EXPECT_TRUE(scripted || !take.description.empty()) << take.name();
    EXPECT_EQ(scripted, take.part <= 5) << take.name();
  }
}

TEST(Hdm05Takes, SayWhatIsWrongWithFourOfThem) {
  std::vector<std::string> wrong;
  for (const Hdm05Take& take : Hdm05().takes) {
    if (!take.defect.text.empty()) wrong.push_back(take.name());
  }
  EXPECT_THAT(wrong, ElementsAre("HDM_dg_03-04_02", "HDM_dg_03-09_01", "HDM_dg_03-09_02",
                                 "HDM_dg_03-09_03"));
}

TEST(Hdm05Script, HasPartsScenesAndStepsInOrder) {
  const Hdm05Catalogue& catalogue = Hdm05();
  EXPECT_THAT(catalogue.parts, SizeIs(5));
  EXPECT_THAT(catalogue.scenes, SizeIs(22));
  for (const Hdm05Scene& scene : catalogue.scenes) {
    EXPECT_FALSE(scene.title.empty());
    EXPECT_FALSE(scene.steps.empty()) << scene.title;
    for (std::size_t i = 0; i < scene.steps.size(); ++i) {
      EXPECT_EQ(scene.steps[i].number, static_cast<int>(i) + 1) << scene.title;
      EXPECT_FALSE(scene.steps[i].text.empty());
    }
    // Each was performed by somebody.
    EXPECT_TRUE(std::ranges::any_of(catalogue.takes, [&](const Hdm05Take& take) {
      return take.part == scene.part && take.scene == scene.scene;
    })) << scene.title;
  }
  EXPECT_THAT(catalogue.FindScene(4, 1)->steps, SizeIs(32));
}

TEST(Hdm05Script, ShowsEveryMotionClassAndNoOther) {
  std::set<std::string> shown;
  for (const Hdm05Scene& scene : Hdm05().scenes) {
    for (const Hdm05Step& step : scene.steps)
      shown.insert(step.classes.begin(), step.classes.end());
  }
  std::set<std::string> known;
  for (const Hdm05Class& motion_class : Hdm05().classes) known.insert(motion_class.name);
  EXPECT_EQ(shown, known);
}

// An actor who has clips of a class has a take of a scene that shows it.
TEST(Hdm05Script, WasPerformedByTheActorsOfEachClass) {
  const Hdm05Catalogue& catalogue = Hdm05();
  std::set<std::pair<std::string, std::string>> performed;  // Actor, class.
  for (const Hdm05Take& take : catalogue.takes) {
    const Hdm05Scene* scene = catalogue.FindScene(take.part, take.scene);
    if (scene == nullptr) continue;
    for (const Hdm05Step& step : scene->steps) {
      for (const std::string& name : step.classes) performed.emplace(take.actor, name);
    }
  }
  for (const Hdm05Class& motion_class : catalogue.classes) {
    for (std::size_t actor = 0; actor < catalogue.actors.size(); ++actor) {
      if (motion_class.clips_of_actor[actor] == 0) continue;
      EXPECT_TRUE(performed.contains({catalogue.actors[actor].id, motion_class.name}))
          << catalogue.actors[actor].id << ' ' << motion_class.name;
    }
  }
}

TEST(Hdm05Classes, AddUpInBothDirections) {
  const Hdm05Catalogue& catalogue = Hdm05();
  EXPECT_THAT(catalogue.classes, SizeIs(130));
  EXPECT_TRUE(std::ranges::is_sorted(catalogue.classes, {}, &Hdm05Class::name));
  for (const Hdm05Class& motion_class : catalogue.classes) {
    const auto& counts = motion_class.clips_of_actor;
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), motion_class.clip_count)
        << motion_class.name;
    EXPECT_FALSE(motion_class.description.empty());
  }
  EXPECT_EQ(catalogue.ClipCount(), 2343);
  for (const auto& [id, totals] : kTotals) {
    EXPECT_EQ(catalogue.ClipCount(*catalogue.FindActor(id)), totals.clips) << id;
  }
}

TEST(Hdm05Classes, NumberTheirClipsActorByActor) {
  for (const Hdm05Class& motion_class : Hdm05().classes) {
    int next = 1;
    for (std::size_t actor = 0; actor < Hdm05().actors.size(); ++actor) {
      const Hdm05ClipNumbers numbers = ClipNumbers(motion_class, actor);
      EXPECT_EQ(numbers.first, next);
      next += numbers.count();
    }
    EXPECT_EQ(next - 1, motion_class.clip_count);
  }
  const Hdm05Class* throws = Hdm05().FindClass("throwBasketball");
  ASSERT_NE(throws, nullptr);
  EXPECT_EQ(Hdm05ClipName(*throws, 1, 4), "HDM_bk_throwBasketball_004");  // As in the video table.
  EXPECT_EQ(ClipNumbers(*throws, 1).first, 4);
}

TEST(Hdm05Classes, SayWhatIsWrongWithThirteenOfThem) {
  int arms = 0;
  for (const Hdm05Class& motion_class : Hdm05().classes) {
    const Hdm05Defect& defect = motion_class.defect;
    if (defect.text.empty()) continue;
    EXPECT_TRUE(defect.formats[0]);
    EXPECT_FALSE(defect.formats[1]);
    if (motion_class.name == "sitDownKneelTieShoes") {
      EXPECT_EQ(defect.clip, 0);
      continue;
    }
    EXPECT_TRUE(motion_class.name.starts_with("rotateArms")) << motion_class.name;
    const std::size_t dg = *Hdm05().FindActor("dg");
    EXPECT_TRUE(ClipNumbers(motion_class, dg).contains(defect.clip)) << motion_class.name;
    ++arms;
  }
  EXPECT_EQ(arms, 12);
}

// Whose clip a video of a clip shows, by the counts.
void ExpectClipOfItsActor(const Hdm05Video& video) {
  const TakeName name = ParseTakeName(video.file);
  const auto actor = Hdm05().FindActor(name.actor);
  const Hdm05Class* motion_class = Hdm05().FindClass(name.class_name);
  ASSERT_TRUE(actor) << video.file;
  ASSERT_NE(motion_class, nullptr) << video.file;
  EXPECT_TRUE(ClipNumbers(*motion_class, *actor).contains(std::stoi(name.take))) << video.file;
  if (!video.take.empty()) {
    EXPECT_EQ(ParseTakeName(video.take + "_120").actor, name.actor);
  }
}

TEST(Hdm05Videos, ShowKnownTakesAndClips) {
  const auto& videos = Hdm05().videos;
  EXPECT_THAT(videos, SizeIs(21 + 81));
  std::set<std::string> files;
  int whole = 0;
  for (const Hdm05Video& video : videos) {
    EXPECT_TRUE(files.insert(video.file).second) << video.file;
    EXPECT_EQ(ParseTakeName(video.file).rate_hz, 25);
    if (ParseTakeName(video.file).class_name.empty()) {
      EXPECT_TRUE(video.file.starts_with(video.take)) << video.file;
      ++whole;
    } else {
      ExpectClipOfItsActor(video);
    }
  }
  EXPECT_EQ(whole, 21);
}

TEST(Hdm05Videos, LieInTheirTakes) {
  int ranges = 0;
  for (const Hdm05Video& video : Hdm05().videos) {
    if (video.take.empty()) continue;
    const Hdm05Take* take = Hdm05().FindTake(video.take);
    ASSERT_NE(take, nullptr) << video.file;
    ASSERT_TRUE(take->frame_count) << video.file;
    if (video.first_frame) {
      EXPECT_GE(*video.first_frame, 1) << video.file;
    }
    if (video.last_frame) {
      EXPECT_LE(*video.last_frame, *take->frame_count) << video.file;
    }
    if (video.first_frame && video.last_frame) {
      EXPECT_LT(*video.first_frame, *video.last_frame) << video.file;
      ++ranges;
    }
  }
  EXPECT_EQ(ranges, 20 + 45);
}

// The takes' lengths once more: the table of videos names each take's last frame, counted from 0
// but for two.
TEST(Hdm05Videos, EndWhereTheirTakesEnd) {
  int ends = 0;
  for (const Hdm05Video& video : Hdm05().videos) {
    if (!video.take_end) continue;
    const bool counts_from_one = video.take == "HDM_mm_04-01_01" || video.take == "HDM_tr_04-01_01";
    EXPECT_EQ(*video.take_end, *Hdm05().FindTake(video.take)->frame_count - !counts_from_one)
        << video.file;
    ++ends;
  }
  EXPECT_EQ(ends, 21);
}

// Scenes whose steps show the class of a video are those of its take.
TEST(Hdm05Videos, ShowClassesOfTheirScenes) {
  for (const Hdm05Video& video : Hdm05().videos) {
    const std::string class_name = ParseTakeName(video.file).class_name;
    if (class_name.empty() || video.take.empty()) continue;
    const Hdm05Take* take = Hdm05().FindTake(video.take);
    const Hdm05Scene* scene = Hdm05().FindScene(take->part, take->scene);
    ASSERT_NE(scene, nullptr);
    EXPECT_TRUE(std::ranges::any_of(scene->steps, [&](const Hdm05Step& step) {
      return std::ranges::find(step.classes, class_name) != step.classes.end();
    })) << video.file;
  }
}

TEST(Hdm05Search, FindsTheShelfByItsWords) {
  const auto matches = FindHdm05Takes({.words = "grab item from shelf"});
  ASSERT_THAT(Names(matches), ElementsAre("2-2", "2-3"));
  EXPECT_THAT(Numbers(matches[0]), ElementsAre(2, 8, 14));
  EXPECT_THAT(Numbers(matches[1]), ElementsAre(1, 3, 5));
  EXPECT_THAT(matches[0].takes, SizeIs(2 + 3 + 4 + 3 + 4));
  EXPECT_THAT(matches[1].takes, SizeIs(2 + 4 + 3 + 3 + 3));
}

TEST(Hdm05Search, TakesAnyCaseAndBeginningsOfWords) {
  const auto whole = FindHdm05Takes({.words = "jumping jacks"});
  const auto begun = FindHdm05Takes({.words = "JUMP  jac"});
  ASSERT_THAT(Names(whole), ElementsAre("3-5"));
  EXPECT_EQ(Names(begun), Names(whole));
  EXPECT_EQ(Numbers(begun[0]), Numbers(whole[0]));
  EXPECT_THAT(FindHdm05Takes({.words = "acks"}), IsEmpty());
}

TEST(Hdm05Search, FindsEveryMotionClassByItsName) {
  for (const Hdm05Class& motion_class : Hdm05().classes) {
    const auto matches = FindHdm05Takes({.words = motion_class.name});
    ASSERT_FALSE(matches.empty()) << motion_class.name;
    for (const Hdm05Match& match : matches) {
      for (const Hdm05Step* step : match.steps) {
        EXPECT_THAT(step->classes, Contains(testing::StartsWith(motion_class.name)));
      }
    }
    EXPECT_THAT(FindHdm05Classes(motion_class.name), Contains(&motion_class));
  }
}

TEST(Hdm05Search, PutsScenesWithAllWordsInOneStepFirst) {
  // In 3-4 one step each; elsewhere the words are in different steps or titles at best.
  EXPECT_EQ(Names(FindHdm05Takes({.words = "rotate both arms"})).front(), "3-4");
  // "sit down on the floor" is a step of 3-3 and 4-1; 3-8 has "lying on the floor" and "up".
  const auto matches = FindHdm05Takes({.words = "sit floor"});
  ASSERT_GE(matches.size(), 2U);
  EXPECT_EQ(Names(matches)[0], "3-3");
  EXPECT_EQ(Names(matches)[1], "4-1");
  // Words of the title count for every step: the script does not repeat "badminton".
  const auto smash = FindHdm05Takes({.words = "badminton smash"});
  ASSERT_THAT(Names(smash), ElementsAre("3-11"));
  EXPECT_THAT(Numbers(smash[0]), ElementsAre(4));
}

TEST(Hdm05Search, FindsFreestyleByItsDescription) {
  const auto matches = FindHdm05Takes({.words = "inline skating backwards"});
  ASSERT_THAT(matches, SizeIs(1));
  EXPECT_EQ(matches[0].script, nullptr);
  ASSERT_THAT(matches[0].takes, SizeIs(2));
  EXPECT_EQ(matches[0].takes[0]->name(), "HDM_dg_07-01_04");
  EXPECT_EQ(matches[0].takes[1]->name(), "HDM_dg_07-01_08");
}

TEST(Hdm05Search, FindsASpecialTakeOfASceneByItself) {
  const auto matches = FindHdm05Takes({.words = "rope one leg"});
  ASSERT_THAT(matches, SizeIs(1));
  ASSERT_THAT(matches[0].takes, SizeIs(1));
  EXPECT_EQ(matches[0].takes[0]->name(), "HDM_mm_03-10_02");
}

TEST(Hdm05Search, GivesAllTakesForNoWordsAndNoneForUnknownOnes) {
  std::set<const Hdm05Take*> takes;
  for (const Hdm05Match& match : FindHdm05Takes({})) {
    takes.insert(match.takes.begin(), match.takes.end());
  }
  EXPECT_THAT(takes, SizeIs(326));
  EXPECT_THAT(FindHdm05Takes({.words = "grab xylophone"}), IsEmpty());
  EXPECT_THAT(FindHdm05Classes(""), SizeIs(130));
  EXPECT_THAT(FindHdm05Classes("xylophone"), IsEmpty());
}

TEST(Hdm05Search, KeepsToAnActorAndAPart) {
  std::int64_t frames = 0;
  for (const Hdm05Match& match : FindHdm05Takes({.actor = "bk"})) {
    for (const Hdm05Take* take : match.takes) {
      EXPECT_EQ(take->actor, "bk");
      frames += take->frame_count.value_or(0);
    }
  }
  EXPECT_EQ(frames, kTotals.at("bk").frames);
  const auto third = FindHdm05Takes({.words = "walk", .part = 3});
  EXPECT_THAT(third, Not(IsEmpty()));
  for (const Hdm05Match& match : third) EXPECT_EQ(match.part, 3);
}

TEST(Hdm05Search, FindsClassesByTheirDescription) {
  const auto classes = FindHdm05Classes("kick left once");
  ASSERT_THAT(classes, SizeIs(2));
  EXPECT_EQ(classes[0]->name, "kickLFront1Reps");
  EXPECT_EQ(classes[1]->name, "kickLSide1Reps");
}

}  // namespace
}  // namespace kinebase
