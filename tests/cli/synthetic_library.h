// A small library of made-up motion for tests of the program, and bad files made from it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "support/temporary_folder.h"

namespace kinebase::test {

// Actors sa and sb, two clips each of squat1Reps, kickRFront1Reps and jumpingJack1Reps.
class SyntheticLibrary {
 public:
  SyntheticLibrary();

  [[nodiscard]] std::filesystem::path folder() const { return root_.path() / "library"; }
  [[nodiscard]] std::filesystem::path scratch() const { return root_.path(); }
  [[nodiscard]] std::filesystem::path list() const { return folder() / "clips.csv"; }

  // repetition  1 or 2.
  [[nodiscard]] std::filesystem::path Clip(std::string_view class_name, std::string_view actor,
                                           int repetition) const;
  // A squat of actor sa.
  [[nodiscard]] std::string Squat() const { return Clip("squat1Reps", "sa", 1).string(); }

  // A template of the class from the clips of actor sa, in the scratch folder.
  [[nodiscard]] std::string Learn(const std::string& class_name) const;

  // A motion of actor sa with other contents, beside a skeleton of its own: <scratch>/bad/<name>.
  [[nodiscard]] std::string BadMotion(std::string_view contents,
                                      const std::string& name = "SYN_sa_bad_001_120.amc") const;

 private:
  TemporaryFolder root_;
};

// Everything below a folder, sorted: what a command left behind.
std::vector<std::string> NamesBelow(const std::filesystem::path& folder);

}  // namespace kinebase::test
