#include "cli/take_filter.h"

namespace kinebase::cli {

std::vector<CLI::Option*> AddTakeFilterOptions(CLI::App& command, TakeFilter& filter) {
  const auto names = [&](const char* option, std::vector<std::string>& values, const char* help) {
    return command.add_option(option, values, help)->delimiter(',')->type_name("NAMES");
  };
  return {names("--actors", filter.actors, "Only takes of these actors: a,b"),
          names("--classes", filter.classes, "Only takes of these classes: a,b"),
          names("--labelled", filter.labels, "Only takes with one of these labels: a,b"),
          names("--formats", filter.formats, "Only takes of these formats: amc,c3d"),
          command
              .add_option("--text", filter.text,
                          "Only takes with all these words, or words that begin so, in names, "
                          "labels or description")
              ->type_name("WORDS")};
}

void AddTakeChoiceOptions(CLI::App& command, TakeChoice& choice) {
  command.add_option("TAKE", choice.names,
                     "Files as 'list' shows them, their names, or folders above them");
  AddTakeFilterOptions(command, choice.filter);
}

}  // namespace kinebase::cli
