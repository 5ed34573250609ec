// kinebase sort: clips into a folder for each motion class.

#include <algorithm>
#include <memory>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/file_move_output.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::cli {
namespace {

struct SortCommandOptions {
  CommonOptions common;
  std::filesystem::path folder;
  std::string start;
  SortOptions sort;
  bool dry_run = false;
};

int Run(SortCommandOptions& options) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (options.start.empty() || !std::ranges::all_of(options.start, is_digit)) {
    options.sort.start_text = options.start;
  } else {
    options.sort.start_position = ParseInteger(options.start).value_or(0);
    if (options.sort.start_position < 1) {
      throw UsageError(fmt::format(
          "--start takes a position from 1 or the text before the folder's name, not '{}'",
          options.start));
    }
  }
  const std::string_view left =
      options.start.empty() ? "no motion class in the name" : "no folder by the name";
  return ShowAndApply(PlanSort(options.folder, options.sort), options.dry_run, left,
                      options.common);
}

}  // namespace

void AddSortCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<SortCommandOptions>();
  CLI::App* command =
      program.add_subcommand("sort", "Move clips into folders named by their motion classes");
  command->add_option("FOLDER", options->folder, "Folder with the clips")->required();
  CLI::Option* start =
      command
          ->add_option("--start", options->start,
                       "Where the folder's name begins in a file's: a position from 1, or the text "
                       "before it (default: at the motion class of HDM05's names)")
          ->type_name("N|TEXT");
  command->add_option("--delimiter", options->sort.delimiter, "Text that ends the folder's name")
      ->needs(start)
      ->capture_default_str()
      ->type_name("TEXT");
  command->add_flag("--dry-run", options->dry_run, "Only say what would be moved");
  AddOutputOptions(*command, options->common);
  command->footer("Example:\n  kinebase sort clips --dry-run");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
