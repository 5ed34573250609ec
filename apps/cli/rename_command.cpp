// kinebase rename: new names from a table.

#include <memory>

#include "cli/commands.h"
#include "cli/console.h"
#include "cli/file_move_output.h"

namespace kinebase::cli {
namespace {

struct RenameCommandOptions {
  CommonOptions common;
  std::filesystem::path folder;
  std::filesystem::path table;
  bool dry_run = false;
};

}  // namespace

void AddRenameCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<RenameCommandOptions>();
  CLI::App* command = program.add_subcommand("rename", "Rename files by a table");
  command->add_option("FOLDER", options->folder, "Folder that the names begin in")->required();
  command
      ->add_option("--table", options->table,
                   "CSV with the columns old and new, or those two without titles")
      ->required()
      ->type_name("FILE");
  command->add_flag("--dry-run", options->dry_run, "Only say what would be renamed");
  AddOutputOptions(*command, options->common);
  command->footer("Example:\n  kinebase rename clips --table names.csv --dry-run");
  command->callback([options, &exit_code] {
    exit_code = ShowAndApply(PlanRename(options->folder, options->table), options->dry_run, "",
                             options->common);
  });
}

}  // namespace kinebase::cli
