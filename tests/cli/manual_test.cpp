// The man page and the shells' completions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "cli/run_program.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Manual, IsAManPageOfEveryCommand) {
  const ProgramResult result = RunKinebase({"manual"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const auto lines = Lines(result.out);
  EXPECT_TRUE(lines.front().starts_with(".TH KINEBASE 1 "));
  EXPECT_THAT(lines, IsSupersetOf({".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION", ".SH COMMANDS",
                                   ".SH EXIT STATUS", ".SS kinebase info", ".SS kinebase search",
                                   ".SS kinebase template mirror"}));
  EXPECT_THAT(lines, Contains("kinebase \\- find motions in motion\\-capture recordings"));
  EXPECT_THAT(lines, Contains(HasSubstr("\\-\\-tau")));
}

// Each line is text or one of the requests that we mean; dashes are those that can be copied.
TEST(Manual, IsSoundRoff) {
  int no_fill = 0;
  for (const std::string& line : Lines(RunKinebase({"manual"}).out)) {
    if (line.starts_with('.')) {
      const std::string request = line.substr(0, line.find(' '));
      EXPECT_THAT((std::vector<std::string>{".TH", ".SH", ".SS", ".TP", ".B", ".PP", ".nf", ".fi"}),
                  Contains(request));
      no_fill += request == ".nf" ? 1 : request == ".fi" ? -1 : 0;
    }
    EXPECT_FALSE(line.starts_with('\'')) << line;
    EXPECT_THAT(line, Not(::testing::ContainsRegex("[^\\]--"))) << "a dash without backslash";
    EXPECT_LT(line.size(), 160U);
    EXPECT_THAT(no_fill, ::testing::AnyOf(0, 1)) << line;
  }
  EXPECT_EQ(no_fill, 0);
}

// What bash offers for the last of `words`.
std::vector<std::string> BashOffers(const std::vector<std::string>& words,
                                    const std::filesystem::path& folder = {}) {
  std::string script = RunKinebase({"completion", "bash"}).out + "\nCOMP_WORDS=(";
  for (const std::string& word : words) script += " '" + word + "'";
  script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
            "\n_kinebase\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n";
  const ProgramResult result = RunCommand({"bash", "-c", script}, {.folder = folder});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  return Lines(result.out);
}

TEST(BashCompletion, IsSoundBash) {
  const TemporaryFolder folder;
  const auto script = folder.path() / "completion";
  WriteText(script, RunKinebase({"completion", "bash"}).out);
  const ProgramResult result = RunCommand({"bash", "-n", script});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
}

TEST(BashCompletion, OffersCommandsAndOptions) {
  EXPECT_THAT(BashOffers({"kinebase", "se"}), ElementsAre("search"));
  EXPECT_THAT(BashOffers({"kinebase", ""}), IsSupersetOf({"info", "learn", "search", "template"}));
  EXPECT_THAT(BashOffers({"kinebase", "--v"}), ElementsAre("--version"));
  EXPECT_THAT(BashOffers({"kinebase", "search", "--ta"}), ElementsAre("--tau"));
  EXPECT_THAT(BashOffers({"kinebase", "search", "a.json", "--mi"}), ElementsAre("--mirror"));
  EXPECT_THAT(BashOffers({"kinebase", "template", "mi"}), ElementsAre("mirror"));
  EXPECT_THAT(BashOffers({"kinebase", "template", "render", "--qua"}), ElementsAre("--quantized"));
  EXPECT_THAT(BashOffers({"kinebase", "render", "--"}),
              AllOf(Contains("--poses"), Not(Contains("--quantized"))));
  EXPECT_THAT(BashOffers({"kinebase", "completion", "z"}), ElementsAre("zsh"));
}

TEST(BashCompletion, OffersFiles) {
  const TemporaryFolder folder;
  WriteText(folder.path() / "my take.amc", "");
  EXPECT_THAT(BashOffers({"kinebase", "info", "my"}, folder.path()), ElementsAre("my take.amc"));
  EXPECT_THAT(BashOffers({"kinebase", "template", "show", "my"}, folder.path()),
              ElementsAre("my take.amc"));
}

TEST(ZshCompletion, KnowsEveryCommand) {
  const ProgramResult result = RunKinebase({"completion", "zsh"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("#compdef kinebase\n"));
  EXPECT_THAT(Lines(result.out), IsSupersetOf({"compdef _kinebase kinebase", "    _files"}));
  EXPECT_THAT(result.out, HasSubstr("\"template mirror\") choices=\""));
  EXPECT_THAT(result.out, Not(HasSubstr("mapfile")));  // zsh has none.
}

TEST(FishCompletion, IsOneCommandALine) {
  const ProgramResult result = RunKinebase({"completion", "fish"});
  EXPECT_EQ(result.exit_code, 0);
  const auto lines = Lines(result.out);
  for (const std::string& line : lines) {
    EXPECT_TRUE(line.starts_with("complete -c kinebase -n ")) << line;
    std::size_t quotes = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '\\') {
        ++i;
      } else if (line[i] == '\'') {
        ++quotes;
      }
    }
    EXPECT_EQ(quotes % 2, 0U) << line;
  }
  EXPECT_THAT(lines, Contains(HasSubstr("-a search")));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("from template; and"), HasSubstr("from render"),
                                    HasSubstr("-l quantized"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("from search;"), HasSubstr("-l tau -r"))));
}

}  // namespace
}  // namespace kinebase::test
