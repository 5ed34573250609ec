// kinebase manual and completion: made from the commands' own descriptions, so that they cannot
// differ.

#include <algorithm>
#include <string>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "fmt/ranges.h"

namespace kinebase::cli {
namespace {

std::vector<const CLI::App*> Subcommands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<std::string> OptionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  std::ranges::sort(names);
  return names;
}

// Text for roff: a dash that is meant, no line that looks like a request.
std::string Roff(const std::string& text) {
  std::string out;
  bool at_line_start = true;
  for (const char c : text) {
    if (at_line_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') out += '\\';
    if (c == '-') out += '\\';
    out += c;
    at_line_start = c == '\n';
  }
  return out;
}

// What comes behind an option's name in a list of options; empty for flags.
std::string ValueName(const CLI::Option& option) {
  return option.get_items_expected_max() == 0 ? std::string() : option.get_type_name();
}

void AppendOptions(std::string& out, const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string value = ValueName(*option);
    out += fmt::format(".TP\n.B {}{}\n{}\n", Roff(option->get_name(false, true)),
                       value.empty() ? "" : " \\fI" + Roff(value) + "\\fR",
                       Roff(option->get_description()));
  }
}

void AppendCommand(std::string& out, const CLI::App& command, const std::string& path) {
  const std::string name = path + ' ' + command.get_name();
  const auto subcommands = Subcommands(command);
  if (subcommands.empty()) {
    out += fmt::format(".SS {}\n{}\n", Roff(name), Roff(command.get_description()));
    AppendOptions(out, command);
    if (!command.get_footer().empty()) {
      out += fmt::format(".PP\n.nf\n{}\n.fi\n", Roff(command.get_footer()));
    }
  }
  for (const CLI::App* subcommand : subcommands) AppendCommand(out, *subcommand, name);
}

std::string ManPage(const CLI::App& program) {
  std::string out = ".TH KINEBASE 1 \"\" \"Kinebase " KINEBASE_VERSION "\" \"User Commands\"\n";
  out += ".SH NAME\nkinebase \\- find motions in motion\\-capture recordings\n";
  out += ".SH SYNOPSIS\n.B kinebase\n\\fICOMMAND\\fR [\\fIOPTION\\fR]...\n";
  out += ".SH DESCRIPTION\n.nf\n" + Roff(program.get_description()) + "\n.fi\n.SH COMMANDS\n";
  for (const CLI::App* command : Subcommands(program)) AppendCommand(out, *command, "kinebase");
  out +=
      ".SH EXIT STATUS\n.TP\n.B 0\nDone.\n.TP\n.B 1\nCould not: a file is missing or bad.\n"
      ".TP\n.B 2\nWrong usage.\n.TP\n.B 3\nPart of a batch failed; the rest was done.\n";
  return out;
}

// What may follow a command, on one line: its subcommands and its options.
std::string WordsOf(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* subcommand : Subcommands(command)) words.push_back(subcommand->get_name());
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;  // SHELL is "bash|zsh|fish".
    std::string type = option->get_type_name();
    if (type.find('|') == std::string::npos) continue;
    std::ranges::replace(type, '|', ' ');
    words.push_back(std::move(type));
  }
  std::ranges::copy(OptionNames(command), std::back_inserter(words));
  return fmt::format("{}", fmt::join(words, " "));
}

// The lines of a case statement: from "search" or "template show" to `choices`. bash and zsh agree
// on these.
std::string WordsOfCommands(const CLI::App& program) {
  std::string cases = fmt::format("    \"\") choices=\"{}\" ;;\n", WordsOf(program));
  for (const CLI::App* command : Subcommands(program)) {
    cases += fmt::format("    {}) choices=\"{}\" ;;\n", command->get_name(), WordsOf(*command));
    for (const CLI::App* action : Subcommands(*command)) {
      cases += fmt::format("    \"{} {}\") choices=\"{}\" ;;\n", command->get_name(),
                           action->get_name(), WordsOf(*action));
    }
  }
  return cases;
}

std::string BashCompletion(const CLI::App& program) {
  return fmt::format(R"(_kinebase() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} command= choices=
  [[ COMP_CWORD -gt 1 ]] && command=${{COMP_WORDS[1]}}
  [[ $command == template && COMP_CWORD -gt 2 ]] && command+=" ${{COMP_WORDS[2]}}"
  case $command in
{}  esac
  if [[ $current == -* || -z $command || $command == template || $command == completion ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -o filenames -F _kinebase kinebase
)",
                     WordsOfCommands(program));
}

std::string ZshCompletion(const CLI::App& program) {
  return fmt::format(R"(#compdef kinebase
_kinebase() {{
  local command= choices=
  (( CURRENT > 2 )) && command=${{words[2]}}
  [[ $command == template ]] && (( CURRENT > 3 )) && command+=" ${{words[3]}}"
  case $command in
{}  esac
  if [[ $PREFIX == -* || -z $command || $command == template || $command == completion ]]; then
    compadd -- ${{=choices}}
  else
    _files
  fi
}}
compdef _kinebase kinebase
)",
                     WordsOfCommands(program));
}

std::string FishQuoted(std::string text) {
  for (std::size_t at = 0; (at = text.find_first_of("\\'", at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '\\');
  }
  return "'" + text + "'";
}

void AppendFishOptions(std::string& out, const CLI::App& command, std::string_view condition) {
  for (const CLI::Option* option : command.get_options()) {
    for (const auto& name : option->get_lnames()) {
      out += fmt::format("complete -c kinebase -n '{}' -l {}{} -d {}\n", condition, name,
                         ValueName(*option).empty() ? "" : " -r",
                         FishQuoted(option->get_description()));
    }
  }
}

std::string FishCompletion(const CLI::App& program) {
  std::string out;
  for (const CLI::App* command : Subcommands(program)) {
    out += fmt::format("complete -c kinebase -n __fish_use_subcommand -f -a {} -d {}\n",
                       command->get_name(), FishQuoted(command->get_description()));
    // `render` is a command and what one does with a template.
    const std::string seen = fmt::format("__fish_seen_subcommand_from {}", command->get_name());
    const auto actions = Subcommands(*command);
    if (actions.empty()) {
      AppendFishOptions(out, *command, seen + "; and not __fish_seen_subcommand_from template");
    }
    for (const CLI::App* action : actions) {
      out += fmt::format("complete -c kinebase -n '{}' -f -a {} -d {}\n", seen, action->get_name(),
                         FishQuoted(action->get_description()));
      AppendFishOptions(
          out, *action,
          fmt::format("{}; and __fish_seen_subcommand_from {}", seen, action->get_name()));
    }
  }
  return out;
}

}  // namespace

void AddManualCommands(CLI::App& program, int& exit_code) {
  CLI::App* manual = program.add_subcommand("manual", "Print the man page");
  manual->footer("Example:\n  kinebase manual | man -l -");
  manual->callback([&program, &exit_code] {
    Print(ManPage(program));
    exit_code = kDone;
  });

  auto shell = std::make_shared<std::string>();
  CLI::App* completion = program.add_subcommand("completion", "Print completions for a shell");
  completion->add_option("SHELL", *shell, "Whose completions")
      ->required()
      ->check(OneOf({"bash", "zsh", "fish"}))
      ->type_name("bash|zsh|fish");
  completion->footer("Example:\n  source <(kinebase completion bash)");
  completion->callback([&program, &exit_code, shell] {
    if (*shell == "fish") {
      Print(FishCompletion(program));
    } else if (*shell == "zsh") {
      Print(ZshCompletion(program));
    } else {
      Print(BashCompletion(program));
    }
    exit_code = kDone;
  });
}

}  // namespace kinebase::cli
