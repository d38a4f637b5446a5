// tailwater view: runs and cases in a browser.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "app/child.h"
#include "app/commands.h"
#include "app/files_of_others.h"
#include "app/processes.h"
#include "app/sweep_plan.h"
#include "app/temporary_folder.h"
#include "app/view_actions.h"
#include "base/json.h"
#include "io/messages.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "results/provenance.h"
#include "server/folder_reader.h"
#include "server/view_server.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view report_name = "report.json";
constexpr std::string_view study_name = "study.json";

struct ViewOptions {
  std::vector<fs::path> paths;
  int port = 0;
  bool opens_no_browser = false;
  fs::path export_file;
};

bool is_run(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / effective_case_name, error);
}

void add_members(const fs::path& sweep, ViewContent& content) {
  const SweepPlan plan = read_sweep_record(sweep);
  for (const SweepMember& member : plan.members) {
    Json parameters = Json::object();
    for (std::size_t k = 0; k < plan.keys.size(); ++k) parameters[plan.keys[k]] = member.values[k];
    content.runs.push_back({member.folder, fs::absolute(sweep / member.folder), std::move(parameters)});
  }
}

/// Adds a report of `tailwater validate`, and those of its runs that it shows.
void add_report(const fs::path& folder, ViewContent& content) {
  content.mode = "report";
  content.report = Json::parse(FolderReader(folder).text_of({std::string(report_name)}), nullptr, false);
  std::set<std::string> names;
  try {
    for (const Json& compared : content.report.at("studies")) {
      if (compared.at("shown").is_string()) names.insert(compared.at("shown"));
    }
  } catch (const Json::exception&) {
    throw InputError("'{}' is not a report of tailwater validate", (folder / report_name).string());
  }
  for (const std::string& name : names) {
    const fs::path run = folder / "runs" / fs::path(name).filename();
    if (is_run(run)) content.runs.push_back({name, fs::absolute(run)});
  }
}

bool goes_up(const fs::path& path) { return path.is_absolute() || std::ranges::find(path, "..") != path.end(); }

/// Adds the results of `tailwater study`, and its runs at the spacings.
void add_study(const fs::path& folder, ViewContent& content) {
  content.mode = "study";
  content.report = Json::parse(FolderReader(folder).text_of({std::string(study_name)}), nullptr, false);
  try {
    content.report.at("results");
    for (const Json& run : content.report.at("runs")) {
      const std::string name = run;
      if (!goes_up(name) && is_run(folder / name)) content.runs.push_back({name, fs::absolute(folder / name)});
    }
  } catch (const Json::exception&) {
    throw InputError("'{}' is not the table of tailwater study", (folder / study_name).string());
  }
}

std::string name_of_folder(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(folder));
  return whole.filename().string();
}

/// Describes a folder that cannot be shown: its runs, with the command that shows them, or the missing files.
std::string what_it_has(const fs::path& folder) {
  constexpr std::size_t max_named = 4;
  std::vector<std::string> runs;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory(error) && is_run(entry.path())) runs.push_back(entry.path().string());
  }
  if (runs.empty()) {
    return fmt::format("none of {}, {}, {} and {}", effective_case_name, sweep_record_name, report_name, study_name);
  }
  std::ranges::sort(runs);
  if (runs.size() > max_named) runs.resize(max_named);
  return fmt::format("runs in it; remedy: tailwater view {}", fmt::join(runs, " "));
}

/// Classifies the paths of the command line; adds those that are sweeps to `sweeps`.
ViewContent content_of(const std::vector<fs::path>& paths, std::vector<fs::path>& sweeps) {
  ViewContent content{.mode = "run", .runs = {}, .case_file = {}};
  for (const fs::path& path : paths) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      if (is_sweep(path)) {
        content.mode = "sweep";
        sweeps.push_back(fs::absolute(path));
        add_members(path, content);
      } else if (fs::exists(path / report_name, error)) {
        if (paths.size() > 1)
          throw InputError("only one report can be shown at a time; remedy: name one report, or only runs");
        add_report(path, content);
      } else if (fs::exists(path / study_name, error)) {
        if (paths.size() > 1)
          throw InputError("only one study can be shown at a time; remedy: name one study, or only runs");
        add_study(path, content);
      } else if (is_run(path)) {
        content.runs.push_back({name_of_folder(path), fs::absolute(path)});
      } else {
        throw InputError("'{}' is not the folder of a run, of a sweep, of a report or of a study: it has {}",
                         path.string(), what_it_has(path));
      }
    } else if (fs::is_regular_file(path, error) && path.extension() == ".toml") {
      if (paths.size() > 1)
        throw InputError("only one case can be shown at a time; remedy: name one case, or only runs");
      content.mode = "case";
      content.case_file = fs::absolute(path);
    } else {
      throw InputError("'{}' is neither the folder of a run nor a case file (.toml)", path.string());
    }
  }
  return content;
}

/// The folder for files that only this user may read, as set by a desktop; empty if there is none.
fs::path runtime_folder() {
  const char* folder = getenv("XDG_RUNTIME_DIR");
  return folder == nullptr ? "" : folder;
}

/// Opens the address in the user's browser. Other users can see the words of a command, so the token is in a file of
/// `folder`, which redirects the browser. Where this fails the user opens the printed address.
void open_in_browser(const std::string& address, const fs::path& folder) {
  if (folder.empty()) return;
  try {
    write_text_file(folder / "open.html",
                    fmt::format("<!DOCTYPE html><title>Tailwater</title><meta http-equiv=\"refresh\" content=\"0; "
                                "url={0}\"><a href=\"{0}\">Tailwater</a>\n",
                                address));
    start_apart(
        {"xdg-open", (folder / "open.html").string()}, folder, [] { return true; }, std::chrono::seconds(1));
  } catch (const UserError&) {
    // There is no browser here.
  }
}

void serve(const ViewContent& content, const std::vector<fs::path>& sweeps, const ViewOptions& options) {
  const AwaitedSignals signals;  // before there are threads, which then leave all signals to `next`
  ViewServer server(content, view_actions(content, sweeps), options.port);
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  tell(
      "open this address in a browser; from another machine: ssh -L {0}:127.0.0.1:{0} ..., then the same address. "
      "Ctrl-C ends",
      server.port());
  std::thread serving([&server] { server.serve(); });
  std::optional<TemporaryFolder> folder;
  if (!options.opens_no_browser) open_in_browser(server.address(), folder.emplace(runtime_folder()).path());
  int signal = 0;
  while (signal != SIGINT && signal != SIGTERM && signal != SIGHUP) signal = signals.next();
  server.stop();
  serving.join();
}

void view(const ViewOptions& options) {
  std::vector<fs::path> sweeps;
  const ViewContent content = content_of(options.paths, sweeps);
  if (options.export_file.empty()) return serve(content, sweeps, options);
  if (content.case_file) throw InputError("--export: a case has nothing to show before it has run");
  if (options.export_file.extension() != ".html") {
    throw InputError("--export {}: is written as HTML; remedy: name a file that ends in .html",
                     options.export_file.string());
  }
  require_own_regular_file(options.export_file);
  write_text_file(options.export_file, exported_page(content, version_line()));
  fmt::print("{}\n", options.export_file.string());
}

}  // namespace

void add_view_command(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("view", "Show runs, or edit and run a case, in a browser");
  command
      ->add_option("path", options->paths,
                   "Folders of runs, running or finished; the folder of a sweep, a study or a validation; or a case "
                   "file")
      ->required()
      ->type_name("");
  command->add_option("--port", options->port, "Port on 127.0.0.1 (default: a free port)")
      ->check(CLI::Range(1, 65535).description(""))
      ->type_name("PORT");
  command->add_flag("--no-browser", options->opens_no_browser, "Print the address; open no browser");
  command
      ->add_option("--export", options->export_file,
                   "Write the viewer with its data as one HTML file, which opens in any browser without this program. "
                   "It holds about 200 frames, positions rounded to dx/32, 128 colour steps and numbers of 7 digits.")
      ->type_name("FILE");
  command->footer(
      "Examples: tailwater view my_run\n"
      "          tailwater view my_run other_run\n"
      "          tailwater view my.toml\n"
      "          tailwater view my_run --export my_run.html\n"
      "The printed address contains a secret token. Anyone on this machine with the\n"
      "address can view these runs and stop them. Requests without the token are\n"
      "refused, as are other machines. Runs continue when the viewer ends.");
  command->callback([options] { view(*options); });
}

}  // namespace tailwater
