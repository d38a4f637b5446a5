// The commands of the program. Each adds itself to the command line; its callback runs it and sets the exit code.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "base/error.h"
#include "parallel/communicator.h"

namespace tailwater {

void add_new_command(CLI::App& app, ExitCode& code);
void add_check_command(CLI::App& app, ExitCode& code);
void add_explain_command(CLI::App& app, ExitCode& code);
void add_migrate_command(CLI::App& app, ExitCode& code);
/// `words` are the words of the command line after the program, with which other ranks are started.
void add_run_command(CLI::App& app, ExitCode& code, const Communicator& ranks, const std::vector<std::string>& words);
void add_resume_command(CLI::App& app, ExitCode& code, const Communicator& ranks,
                        const std::vector<std::string>& words);
void add_info_command(CLI::App& app, ExitCode& code);
/// `bench`, `validate`, `study`, `waves`, `bed` and `pictures`.
void add_python_commands(CLI::App& app);
void add_view_command(CLI::App& app, ExitCode& code);
/// `man` and `completion`, generated from all commands of `app`.
void add_help_commands(CLI::App& app);

}  // namespace tailwater
