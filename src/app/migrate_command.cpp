#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.h"
#include "case/case_toml.h"
#include "case_help/migration.h"
#include "io/messages.h"
#include "io/write_file.h"

namespace tailwater {
namespace {

void migrate(const std::filesystem::path& old_file, const std::filesystem::path& new_file) {
  const Migration migration = migrate_case(read_case_file(old_file, largest_effective_case), old_file.string());
  for (const std::string& change : migration.changes) tell(change);
  if (migration.changes.empty()) tell("{}: is up to date", old_file.string());
  if (new_file.empty()) {
    fmt::print("{}", migration.text);
    return;
  }
  if (std::filesystem::exists(std::filesystem::symlink_status(new_file))) {
    throw InputError("'{}' exists and is not overwritten; remedy: choose another name", new_file.string());
  }
  write_text_file(new_file, migration.text);
  fmt::print("Wrote {0}. Next:\n  tailwater check {0}\n", new_file.string());
}

}  // namespace

void add_migrate_command(CLI::App& app, ExitCode&) {
  auto old_file = std::make_shared<std::filesystem::path>();
  auto new_file = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("migrate", "Convert a case file from an earlier version");
  command->add_option("old", *old_file, "Case file to convert")->required()->type_name("");
  command->add_option("new", *new_file, "Case file to write (default: standard output)")->type_name("");
  command->footer(
      "Example: tailwater migrate old.toml new.toml\n"
      "Renamed keys are moved to their present place; removed keys become comments.\n"
      "Each change is reported with its line. The rest of the file does not change.");
  command->callback([old_file, new_file] { migrate(*old_file, *new_file); });
}

}  // namespace tailwater
