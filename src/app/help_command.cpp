// `tailwater man` and `tailwater completion SHELL`: the manual page and the completion scripts, generated from the
// commands and options of the program.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/commands.h"
#include "base/text.h"
#include "results/provenance.h"

namespace tailwater {
namespace {

struct OptionText {
  std::vector<std::string> names;  ///< with dashes; bare name of a positional argument
  std::string description;
  bool takes_value;
};

struct CommandText {
  std::string name;
  std::string description;
  std::string footer;
  std::vector<OptionText> options;
  std::vector<CommandText> subcommands;
};

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(option.get_name());
  return names;
}

CommandText command_text(const CLI::App& app) {
  CommandText text{app.get_name(), app.get_description(), app.get_footer(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    text.options.push_back({names_of(*option), option->get_description(), option->get_items_expected_max() > 0});
  }
  for (const CLI::App* subcommand : app.get_subcommands(nullptr)) text.subcommands.push_back(command_text(*subcommand));
  return text;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// ------------------------------------------------------------------------------------------------------- man page

/// Text that troff prints unchanged.
std::string roff(const std::string& text) {
  const std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

/// Lines of an example or a footer, with their breaks.
std::string roff_lines(const std::string& text) {
  std::string lines = ".nf\n";
  for (const std::string_view line : split(text, '\n')) lines += roff(std::string(line)) + "\n";
  return lines + ".fi\n";
}

std::string roff_options(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    text += fmt::format(".TP\n.B {}\n{}\n", roff(fmt::format("{}", fmt::join(option.names, ", "))),
                        roff(option.description));
  }
  return text;
}

std::string man_page(const CommandText& program) {
  std::string page = fmt::format(
      ".TH TAILWATER 1 \"\" \"{}\" \"User commands\"\n.SH NAME\ntailwater \\- simulate free\\-surface water flow with "
      "incompressible smoothed particle hydrodynamics\n.SH SYNOPSIS\n.B tailwater\nCOMMAND [OPTIONS]\n.SH "
      "DESCRIPTION\n{}",
      version_line(), roff_lines(program.description));
  page += ".SH OPTIONS\n" + roff_options(program.options) + ".SH COMMANDS\n";
  for (const CommandText& command : program.subcommands) {
    page += fmt::format(".SS tailwater {}\n{}\n", roff(command.name), roff(command.description));
    page += roff_options(command.options);
    for (const CommandText& nested : command.subcommands) {
      page +=
          fmt::format(".PP\n.B tailwater {} {}\n{}\n", roff(command.name), roff(nested.name), roff(nested.description));
      page += roff_options(nested.options);
    }
    if (!command.footer.empty()) page += ".PP\n" + roff_lines(command.footer);
  }
  return page + ".SH EXIT STATUS\n" + roff_lines(program.footer);
}

// ------------------------------------------------------------------------------------------------------ completion

std::string options_of(const CommandText& command) {
  std::vector<std::string> words;
  for (const OptionText& option : command.options) {
    std::ranges::copy_if(option.names, std::back_inserter(words),
                         [](const std::string& name) { return name.starts_with('-'); });
  }
  for (const CommandText& nested : command.subcommands) words.push_back(nested.name);
  return fmt::format("{}", fmt::join(words, " "));
}

std::string names_of(const std::vector<CommandText>& commands) {
  std::vector<std::string> names;
  for (const CommandText& command : commands) names.push_back(command.name);
  return fmt::format("{}", fmt::join(names, " "));
}

std::string bash_completion(const CommandText& program) {
  std::string cases;
  for (const CommandText& command : program.subcommands) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command.name, options_of(command));
  }
  return fmt::format(R"(# bash completion for tailwater; made by: tailwater completion bash
_tailwater() {{
  local here=${{COMP_WORDS[COMP_CWORD]}} words
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W "{} {}" -- "$here"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$here"))
  [[ $here == -* ]] || COMPREPLY+=($(compgen -f -- "$here"))
}}
complete -o filenames -F _tailwater tailwater
)",
                     names_of(program.subcommands), options_of({"", "", "", program.options, {}}), cases);
}

/// Text inside single quotes of zsh and fish.
std::string quoted(const std::string& text) { return replaced(replaced(text, "\n", " "), "'", "'\\''"); }

std::string zsh_completion(const CommandText& program) {
  std::string commands, cases;
  for (const CommandText& command : program.subcommands) {
    commands += fmt::format("    '{}:{}'\n", command.name, quoted(replaced(command.description, ":", " -")));
    cases += fmt::format("    {}) choices=({}) ;;\n", command.name, options_of(command));
  }
  return fmt::format(R"(#compdef tailwater
# zsh completion for tailwater; made by: tailwater completion zsh
_tailwater() {{
  local -a commands choices
  commands=(
{}  )
  if ((CURRENT == 2)); then
    _describe 'command' commands
    return
  fi
  case $words[2] in
{}  esac
  compadd -a choices
  _files
}}
_tailwater "$@"
)",
                     commands, cases);
}

std::string fish_completion(const CommandText& program) {
  std::string lines = "# fish completion for tailwater; made by: tailwater completion fish\n";
  for (const CommandText& command : program.subcommands) {
    lines += fmt::format("complete -c tailwater -n __fish_use_subcommand -f -a {} -d '{}'\n", command.name,
                         quoted(command.description));
    for (const OptionText& option : command.options) {
      for (const std::string& name : option.names) {
        if (!name.starts_with('-')) continue;
        const bool is_long = name.starts_with("--");
        lines += fmt::format("complete -c tailwater -n '__fish_seen_subcommand_from {}' -{} {}{} -d '{}'\n",
                             command.name, is_long ? "l" : "s", name.substr(is_long ? 2 : 1),
                             option.takes_value ? " -r" : "", quoted(option.description));
      }
    }
  }
  return lines;
}

}  // namespace

void add_help_commands(CLI::App& app) {
  CLI::App* man = app.add_subcommand("man", "Print the manual page");
  man->footer("Example: tailwater man | man -l -");
  man->callback([&app] { fmt::print("{}", man_page(command_text(app))); });

  CLI::App* completion = app.add_subcommand("completion", "Print a completion script for a shell");
  completion->footer(
      "To install it:\n"
      "  bash: tailwater completion bash > ~/.local/share/bash-completion/completions/tailwater\n"
      "  zsh:  tailwater completion zsh > _tailwater, in a folder of $fpath\n"
      "  fish: tailwater completion fish > ~/.config/fish/completions/tailwater.fish");
  auto shell = std::make_shared<std::string>();
  completion->add_option("shell", *shell, "Shell: bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}).description(""))
      ->type_name("");
  completion->callback([&app, shell] {
    const CommandText program = command_text(app);
    fmt::print("{}", *shell == "bash"  ? bash_completion(program)
                     : *shell == "zsh" ? zsh_completion(program)
                                       : fish_completion(program));
  });
}

}  // namespace tailwater
