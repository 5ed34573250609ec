// read(write(read(f))) equals read(f) for CSM, MNM, TRC, MOT and STO: for every real file, and for
// any that could be.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "formats/generators.h"
#include "formats/texts.h"
#include "kinebase/formats/csm.h"
#include "kinebase/formats/mnm.h"
#include "kinebase/formats/sto.h"
#include "kinebase/formats/trc.h"
#include "support/files.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

// As generators.h, without what the formats take for a separator.
std::string Name() {
  return "n" + *rc::gen::container<std::string>(rc::gen::elementOf(std::string("abXY01_:.-+()ä$")));
}

std::string Sentence() {
  std::string text = Name();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) text += ' ' + Name();
  return text;
}

std::string MaybeSentence() { return *rc::gen::arbitrary<bool>() ? Sentence() : ""; }

std::vector<std::string> Names(int least, int most) {
  std::vector<std::string> names;
  for (int i = *rc::gen::inRange(least, most); i > 0; --i) names.push_back(Name());
  return names;
}

std::vector<std::int64_t> FrameNumbers() {
  std::int64_t number = *rc::gen::inRange(-5, 1000);
  std::vector<std::int64_t> numbers;
  for (int i = *rc::gen::inRange(1, 6); i > 0; --i) {
    numbers.push_back(number);
    number += *rc::gen::inRange(1, 4);
  }
  return numbers;
}

// Places, some of them missing, some in part.
std::vector<double> Places(std::size_t count) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_missing = *rc::gen::inRange(0, 3) == 0;
    for (int axis = 0; axis < 3; ++axis) values.push_back(is_missing ? kNaN : test::AnyDouble());
  }
  return values;
}

std::optional<double> MaybeNumber() {
  if (*rc::gen::arbitrary<bool>()) return std::nullopt;
  return test::FiniteDouble();
}

std::optional<std::int64_t> MaybeInteger() {
  if (*rc::gen::arbitrary<bool>()) return std::nullopt;
  return *rc::gen::arbitrary<std::int64_t>();
}

CsmTalent AnyTalent() {
  CsmTalent talent;
  talent.unit = *rc::gen::element(CsmTalent::Unit::kUnstated, CsmTalent::Unit::kInches,
                                  CsmTalent::Unit::kMillimetres);
  for (const auto name : CsmTalentNames()) {
    if (*rc::gen::arbitrary<bool>()) {
      talent.measures.push_back({std::string(name), test::FiniteDouble()});
    }
  }
  if (*rc::gen::arbitrary<bool>()) talent.measures.push_back({Name(), test::FiniteDouble()});
  return talent;
}

CsmRecording AnyCsm() {
  CsmRecording csm;
  csm.file_name = MaybeSentence();
  csm.capture_date = MaybeSentence();
  csm.capture_time = MaybeSentence();
  csm.actor = MaybeSentence();
  if (*rc::gen::arbitrary<bool>()) csm.comments = {Sentence(), "", Sentence(), "$" + Sentence()};
  csm.rate_hz = MaybeNumber();
  csm.spine_links = MaybeInteger();
  if (*rc::gen::arbitrary<bool>()) csm.talent = AnyTalent();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    csm.unknown_sections.push_back({Name(), {MaybeSentence(), "", Sentence()}});
  }
  csm.labels = Names(1, 5);
  csm.frame_numbers = FrameNumbers();
  csm.values = Places(csm.frame_count() * csm.marker_count());
  return csm;
}

TrcRecording AnyTrc() {
  TrcRecording trc;
  trc.path_file_type = *rc::gen::element<std::string>("4", "", "5");
  trc.axes = *rc::gen::element<std::string>("(X/Y/Z)", "");
  trc.file_name = MaybeSentence();
  trc.data_rate_hz = MaybeNumber();
  trc.camera_rate_hz = MaybeNumber();
  trc.units = *rc::gen::element<std::string>("mm", "m", "", "odd unit");
  trc.original_rate_hz = MaybeNumber();
  trc.original_first_frame = MaybeInteger();
  trc.original_frame_count = MaybeInteger();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    trc.other_fields.push_back({Sentence(), MaybeSentence()});
  }
  for (int i = *rc::gen::inRange(1, 5); i > 0; --i) trc.labels.push_back(MaybeSentence());
  trc.frame_numbers = FrameNumbers();
  for (std::size_t i = 0; i < trc.frame_count(); ++i) trc.times_s.push_back(test::FiniteDouble());
  trc.values = Places(trc.frame_count() * trc.marker_count());
  return trc;
}

StoTable AnySto() {
  StoTable table;
  table.name = MaybeSentence();
  for (int i = *rc::gen::inRange(0, 3); i > 0; --i) {
    table.header.push_back({*rc::gen::arbitrary<bool>() ? Name() : "", Sentence()});
  }
  if (*rc::gen::arbitrary<bool>()) table.in_degrees = *rc::gen::arbitrary<bool>();
  if (*rc::gen::arbitrary<bool>()) {
    table.data_type = "Quaternion";
    table.component_count = 4;
  }
  table.labels = Names(0, 4);
  for (int i = *rc::gen::inRange(0, 4); i > 0; --i) table.times_s.push_back(test::FiniteDouble());
  const std::size_t count = table.row_count() * table.column_count() * table.component_count;
  for (std::size_t i = 0; i < count; ++i) table.values.push_back(test::AnyDouble());
  return table;
}

TEST(CsmWriter, GivesBackEveryRealRecording) {
  KINEBASE_NEEDS_TEST_DATA();
  const auto files = test::FilesBelow(test::TestData("data"), ".csm");
  EXPECT_GE(files.size(), 2);
  for (const auto& file : files) {
    SCOPED_TRACE(file);
    const CsmRecording csm = ReadCsm(file, {.strict = true});
    const std::string text = FormatCsm(csm);
    const CsmRecording again = ParseCsm(text, file, {.strict = true});
    EXPECT_EQ(again, csm);
    EXPECT_EQ(again.diagnostics, csm.diagnostics);
    EXPECT_EQ(FormatCsm(again), text);
  }
}

RC_GTEST_PROP(CsmWriter, GivesBackAnyRecording, ()) {
  const CsmRecording csm = AnyCsm();
  RC_ASSERT(ParseCsm(FormatCsm(csm), "any.csm", {.strict = true}) == csm);
}

RC_GTEST_PROP(CsmReader, IsIndifferentToLineEnds, ()) {
  const std::string text = FormatCsm(AnyCsm());
  const auto ending = *rc::gen::element<std::string>("\r\n", "\r");
  RC_ASSERT(ParseCsm(test::WithLineEnds(text, ending), "any.csm") == ParseCsm(text, "any.csm"));
}

RC_GTEST_PROP(MnmWriter, GivesBackAnyNames, ()) {
  MarkerNames names;
  for (int i = *rc::gen::inRange(1, 5); i > 0; --i) {
    names.rows.push_back({Name() + std::to_string(i), Name() + std::to_string(i)});
  }
  if (*rc::gen::arbitrary<bool>()) names.comments.push_back("# " + Sentence());
  RC_ASSERT(ParseMnm(FormatMnm(names), "any.mnm", {.strict = true}) == names);
}

RC_GTEST_PROP(TrcWriter, GivesBackAnyRecording, ()) {
  TrcRecording trc = AnyTrc();
  RC_ASSERT(ParseTrc(FormatTrc(trc), "any.trc", {.strict = true}) == trc);
}

RC_GTEST_PROP(TrcReader, IsIndifferentToLineEnds, ()) {
  const std::string text = FormatTrc(AnyTrc());
  const auto ending = *rc::gen::element<std::string>("\r\n", "\r");
  RC_ASSERT(ParseTrc(test::WithLineEnds(text, ending), "any.trc") == ParseTrc(text, "any.trc"));
}

RC_GTEST_PROP(StoWriter, GivesBackAnyTable, ()) {
  const StoTable table = AnySto();
  RC_ASSERT(ParseSto(FormatSto(table), "any.sto") == table);
}

}  // namespace
}  // namespace kinebase
