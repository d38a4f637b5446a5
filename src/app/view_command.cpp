// tailwater view: runs and cases in a browser.
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "app/case_templates.h"
#include "app/child.h"
#include "app/commands.h"
#include "app/processes.h"
#include "app/ranks.h"
#include "app/sweep_plan.h"
#include "case/help.h"
#include "io/folder_lock.h"
#include "io/messages.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "run/provenance.h"
#include "run/resume.h"
#include "server/view_server.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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

std::string name_of_folder(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(fs::absolute(folder));
  return whole.filename().string();
}

/// What the paths of the command line are.
ViewContent content_of(const std::vector<fs::path>& paths) {
  ViewContent content{.mode = "run", .runs = {}, .case_file = {}};
  for (const fs::path& path : paths) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
      if (is_sweep(path)) {
        content.mode = "sweep";
        add_members(path, content);
      } else if (is_run(path)) {
        content.runs.push_back({name_of_folder(path), fs::absolute(path)});
      } else {
        throw InputError(fmt::format("'{}' is not the folder of a run or of a sweep: it has neither {} nor {}",
                                     path.string(), effective_case_name, sweep_record_name));
      }
    } else if (fs::is_regular_file(path, error) && path.extension() == ".toml") {
      if (paths.size() > 1) throw InputError("a case is shown alone; remedy: name one case, or runs only");
      content.mode = "case";
      content.case_file = fs::absolute(path);
    } else {
      throw InputError(fmt::format("'{}' is neither the folder of a run nor a case file (.toml)", path.string()));
    }
  }
  return content;
}

/// The title in the text of a case.
std::string title_of(std::string_view text) {
  constexpr std::string_view key = "\ntitle = \"";
  const std::size_t begin = text.find(key);
  if (begin == text.npos) return "";
  text.remove_prefix(begin + key.size());
  return std::string(text.substr(0, text.find('"')));
}

/// The folder in which new runs are made, and whose files a case may name.
fs::path working_folder(const ViewContent& content) {
  return content.case_file ? content.case_file->parent_path() : content.runs.front().path.parent_path();
}

/// my_run, my_run_2, ...: the first that is free.
std::string free_name(const fs::path& folder, const std::string& stem) {
  std::error_code error;
  for (int k = 1;; ++k) {
    std::string name = k == 1 ? stem + "_run" : fmt::format("{}_run_{}", stem, k);
    if (!fs::exists(folder / name, error)) return name;
  }
}

void require_plain_name(const std::string& name) {
  const bool is_plain = !name.empty() && name.find('/') == name.npos && name.front() != '.' && name.front() != '-' &&
                        std::ranges::none_of(name, [](char c) { return static_cast<unsigned char>(c) < 32; });
  if (is_plain) return;
  throw InputError(fmt::format("\"{}\" is no name for a folder beside the case; remedy: a name without '/'", name));
}

/// Whether the run in a folder has become ready since.
std::function<bool()> becomes_ready(const fs::path& run) {
  const auto last_start = [summary = run / summary_name] {
    std::error_code error;
    return fs::last_write_time(summary, error);
  };
  return [before = last_start(), last_start] { return last_start() != before; };
}

ViewActions actions_for(const ViewContent& content) {
  const fs::path folder = working_folder(content);
  const std::optional<fs::path> case_file = content.case_file;
  const std::string stem = case_file ? case_file->stem().string() : content.runs.front().name;
  ViewActions actions;
  actions.version = version_line();
  actions.most_ranks = usable_cores();
  actions.free_name = [folder, stem] { return free_name(folder, stem); };
  actions.templates = [] {
    Json names = Json::array();
    for (const auto& [name, text] : case_templates()) names.push_back({{"name", name}, {"title", title_of(text)}});
    return names;
  };
  actions.template_text = [](const std::string& name) -> std::optional<std::string> {
    const auto found = case_templates().find(name);
    return found == case_templates().end() ? std::nullopt : std::optional<std::string>(found->second);
  };
  actions.spec = [] { return Json::parse(case_reference_json()); };
  actions.resume = [](const fs::path& run) {
    start_apart({this_program(), "resume", run.string(), "--quiet"}, run.parent_path(), becomes_ready(run),
                std::chrono::seconds(20));
  };
  const auto one_at_a_time = std::make_shared<std::mutex>();
  actions.check = [folder, one_at_a_time](const std::string& text) {
    const std::lock_guard lock(*one_at_a_time);
    const ChildEnd end = run_child({this_program(), "check", "-", "--json"}, folder, text, std::chrono::seconds(20));
    Json answer = Json::parse(end.output, nullptr, false);
    if (answer.is_object()) return answer;
    throw IoError(end.code == 128 + SIGKILL ? "the check takes more than 20 s; remedy: a larger particles.spacing"
                                            : fmt::format("the check has ended: {}", end.errors));
  };
  actions.start = [folder, case_file](const std::string& text, const std::string& out, int ranks) {
    require_plain_name(out);
    if (ranks < 1 || ranks > usable_cores()) throw InputError(fmt::format("{} ranks: 1 to {}", ranks, usable_cores()));
    const fs::path run = folder / out;
    const fs::path saved = case_file ? *case_file : folder / (out + ".toml");
    std::error_code error;
    if (fs::exists(run, error)) throw InputError(fmt::format("'{}' is there already; remedy: another name", out));
    if (!case_file && fs::exists(saved, error)) {
      throw InputError(fmt::format("'{}' is there already; remedy: another name", saved.string()));
    }
    write_text_file(saved, text);
    start_apart({this_program(), "run", saved.string(), "--out", run.string(), "-n", std::to_string(ranks), "--quiet"},
                folder, becomes_ready(run), std::chrono::seconds(20));
    return run;
  };
  return actions;
}

/// Opens the address in the user's browser. Other users see the words of a command, so the token is in a file that only
/// this user can read, which sends the browser on; it is gone with this object.
class Browser {
 public:
  explicit Browser(const std::string& address) {
    const char* own = getenv("XDG_RUNTIME_DIR");
    const fs::path folder = own != nullptr && *own != '\0' ? fs::path(own) : fs::temp_directory_path();
    std::string name = (folder / "tailwater-view-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) return;
    folder_ = name;
    try {
      write_text_file(folder_ / "open.html", fmt::format("<!DOCTYPE html><title>Tailwater</title>"
                                                         "<meta http-equiv=\"refresh\" content=\"0; url={0}\">"
                                                         "<a href=\"{0}\">Tailwater</a>\n",
                                                         address));
      start_apart(
          {"xdg-open", (folder_ / "open.html").string()}, folder_, [] { return true; }, std::chrono::seconds(1));
    } catch (const UserError&) {
      // There is no browser here; the address is printed.
    }
  }
  ~Browser() {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

 private:
  fs::path folder_;
};

void serve(const ViewContent& content, const ViewOptions& options) {
  const AwaitedSignals signals;  // before there are threads, which then leave all signals to `next`
  ViewServer server(content, actions_for(content), options.port);
  fmt::print("{}\n", server.address());
  std::fflush(stdout);
  tell(
      fmt::format("open this address in a browser; from another machine: ssh -L {0}:127.0.0.1:{0} ..., then the same "
                  "address. Ctrl-C ends",
                  server.port()));
  std::thread serving([&server] { server.serve(); });
  std::optional<Browser> browser;
  if (!options.opens_no_browser) browser.emplace(server.address());
  int signal = 0;
  while (signal != SIGINT && signal != SIGTERM && signal != SIGHUP) signal = signals.next();
  server.stop();
  serving.join();
}

void view(const ViewOptions& options) {
  const ViewContent content = content_of(options.paths);
  if (options.export_file.empty()) return serve(content, options);
  if (content.case_file) throw InputError("--export: a case has nothing to show before it has run");
  write_text_file(options.export_file, exported_page(content, version_line()));
  fmt::print("{}\n", options.export_file.string());
}

}  // namespace

void add_view_command(CLI::App& app, ExitCode&) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* command = app.add_subcommand("view", "Look at runs, or edit and run a case, in a browser");
  command->add_option("path", options->paths, "Folders of runs, going or done; the folder of a sweep; or a case file")
      ->required()
      ->type_name("");
  command->add_option("--port", options->port, "Port of 127.0.0.1 to listen to; default: one that is free")
      ->check(CLI::Range(1, 65535))
      ->type_name("PORT");
  command->add_flag("--no-browser", options->opens_no_browser, "Print the address only");
  command
      ->add_option("--export", options->export_file,
                   "Write one HTML file with all that the page shows, which any browser opens without this program")
      ->type_name("FILE");
  command->footer(
      "Examples: tailwater view my_run\n"
      "          tailwater view my_run other_run\n"
      "          tailwater view my.toml\n"
      "          tailwater view my_run --export my_run.html\n"
      "The address that is printed has a secret in it: whoever knows it can look at these runs, and stop them, on "
      "this\n"
      "machine. Nobody else is answered, and no other machine. Runs do not end with this program.");
  command->callback([options] { view(*options); });
}

}  // namespace tailwater
