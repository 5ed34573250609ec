#include "cli/synthetic_library.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cli/run_program.h"
#include "kinebase/synth/synthetic_motion.h"
#include "support/files.h"

namespace kinebase::test {

namespace fs = std::filesystem;

SyntheticLibrary::SyntheticLibrary() {
  WriteSyntheticLibrary(folder(), {.actors = 2,
                                   .repetitions = 2,
                                   .takes = 0,
                                   .classes = {"squat1Reps", "kickRFront1Reps", "jumpingJack1Reps"},
                                   .threads = 1});
}

fs::path SyntheticLibrary::Clip(std::string_view class_name, std::string_view actor,
                                int repetition) const {
  const int number = (actor == "sa" ? 0 : 2) + repetition;  // Numbers run through all actors.
  return folder() / "cut_amc" / class_name /
         fmt::format("SYN_{}_{}_{:03}_120.amc", actor, class_name, number);
}

std::string SyntheticLibrary::Learn(const std::string& class_name) const {
  std::string output = scratch() / (class_name + ".template.json");
  const ProgramResult result = RunKinebase({"learn", "--list", list(), "--class", class_name,
                                            "--actors", "sa", "-o", output, "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return output;
}

std::string SyntheticLibrary::BadMotion(std::string_view contents, const std::string& name) const {
  const fs::path file = scratch() / "bad" / name;
  WriteText(file, contents);
  fs::copy_file(folder() / "asf" / "SYN_sa.asf", file.parent_path() / "SYN_sa.asf",
                fs::copy_options::overwrite_existing);
  return file;
}

std::vector<std::string> NamesBelow(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.push_back(fs::relative(entry.path(), folder));
  }
  std::ranges::sort(names);
  return names;
}

}  // namespace kinebase::test
