#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.h"
#include "case/case_toml.h"
#include "case/migration.h"
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
    throw InputError("'{}' exists and is not overwritten; remedy: another name", new_file.string());
  }
  write_text_file(new_file, migration.text);
  fmt::print("Wrote {0}. Next:\n  tailwater check {0}\n", new_file.string());
}

}  // namespace

void add_migrate_command(CLI::App& app, ExitCode&) {
  auto old_file = std::make_shared<std::filesystem::path>();
  auto new_file = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("migrate", "Bring a case file of an earlier version up to date");
  command->add_option("old", *old_file, "The case file")->required()->type_name("");
  command->add_option("new", *new_file, "The file to write; without it: to standard output")->type_name("");
  command->footer(
      "Example: tailwater migrate old.toml new.toml\n"
      "Keys that have another place today are moved; those that are no more become comments. Each change is told, "
      "with\n"
      "its line. All else stays as it is.");
  command->callback([old_file, new_file] { migrate(*old_file, *new_file); });
}

}  // namespace tailwater
