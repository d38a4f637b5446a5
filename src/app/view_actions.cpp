#include "app/view_actions.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "app/case_templates.h"
#include "app/check_json.h"
#include "app/child.h"
#include "app/processes.h"
#include "app/ranks.h"
#include "app/sweep_plan.h"
#include "app/sweep_table.h"
#include "base/error.h"
#include "base/json.h"
#include "case_help/help.h"
#include "io/folder_lock.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "results/provenance.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;

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
  if (content.case_file) return content.case_file->parent_path();
  return content.runs.empty() ? fs::current_path() : content.runs.front().path.parent_path();  // a report may show none
}

/// The first free name of my_run, my_run_2, ...
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
  throw InputError("\"{}\" is no name for a folder beside the case; remedy: a name without '/'", name);
}

/// Returns whether a file has been written since this call.
std::function<bool()> is_written_anew(const fs::path& file) {
  const auto last_time = [file] {
    std::error_code error;
    return fs::last_write_time(file, error);
  };
  return [before = last_time(), last_time] { return last_time() != before; };
}

constexpr auto patience = std::chrono::seconds(20);

void resume(const fs::path& folder, std::string_view written_first) {
  start_apart({this_program(), "resume", folder.string(), "--quiet"}, folder.parent_path(),
              is_written_anew(folder / written_first), patience);
}

/// {name, members, done, is_at_work}
Json sweep_info(const fs::path& sweep) {
  const SweepPlan plan = read_sweep_record(sweep);
  const auto done = std::ranges::count_if(
      plan.members, [&](const SweepMember& member) { return member_status(sweep / member.folder) == "done"; });
  return {{"name", sweep.filename().string()},
          {"members", plan.members.size()},
          {"done", done},
          {"is_at_work", FolderLock::is_held(sweep)}};
}

bool ask_sweep(const fs::path& sweep, const std::string& what) {
  const bool is_at_work = FolderLock::is_held(sweep);
  if (what == "resume") {
    if (is_at_work) throw InputError("the sweep is in progress");
    resume(sweep, sweep_table_name);
  } else if (what == "stop") {
    if (!is_at_work) throw InputError("no process is running this sweep");
    write_text_file(sweep / stop_file_name, "");
  } else {
    return false;
  }
  return true;
}

/// The output of `tailwater check - --json` for a text.
Json check_by_child(const fs::path& folder, const std::string& text, TrialSteps trial) {
  std::vector<std::string> command{this_program(), "check", "-", "--json"};
  if (trial == TrialSteps::some) command.emplace_back("--trial-steps");
  const ChildEnd end = run_child(command, folder, text, patience);
  Json answer = Json::parse(end.output, nullptr, false);
  if (answer.is_object()) return answer;
  throw IoError(end.code == 128 + SIGKILL ? "the check takes more than 20 s; remedy: a larger particles.spacing"
                                          : fmt::format("the check has ended: {}", end.errors));
}

/// One check at a time, for all requests.
std::function<Json(const std::string&)> checking(const fs::path& folder, TrialSteps trial) {
  return [folder, trial, one_at_a_time = std::make_shared<std::mutex>()](const std::string& text) {
    const std::lock_guard lock(*one_at_a_time);
    return check_by_child(folder, text, trial);
  };
}

fs::path start_case(const fs::path& folder, const std::optional<fs::path>& case_file, const std::string& text,
                    const std::string& out, int ranks) {
  require_plain_name(out);
  if (ranks < 1 || ranks > usable_cores()) throw InputError("{} ranks: give 1 to {}", ranks, usable_cores());
  const fs::path run = folder / out;
  const fs::path saved = case_file ? *case_file : folder / (out + ".toml");
  std::error_code error;
  if (fs::exists(run, error)) throw InputError("'{}' exists already; remedy: choose another name", out);
  if (!case_file && fs::exists(saved, error)) {
    throw InputError("'{}' exists already; remedy: choose another name", saved.string());
  }
  write_text_file(saved, text);
  start_apart({this_program(), "run", saved.string(), "--out", run.string(), "-n", std::to_string(ranks), "--quiet"},
              folder, is_written_anew(run / summary_name), patience);
  return run;
}

}  // namespace

ViewActions view_actions(const ViewContent& content, const std::vector<fs::path>& sweeps) {
  const fs::path folder = working_folder(content);
  const std::optional<fs::path> case_file = content.case_file;
  const std::string stem = case_file              ? case_file->stem().string()
                           : content.runs.empty() ? "case"
                                                  : content.runs.front().name;
  ViewActions actions;
  actions.version = version_line();
  actions.max_ranks = usable_cores();
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
  actions.resume = [](const fs::path& run) { resume(run, summary_name); };
  actions.sweeps = [sweeps] {
    Json infos = Json::array();
    for (const fs::path& sweep : sweeps) infos.push_back(sweep_info(sweep));
    return infos;
  };
  actions.ask_sweep = [sweeps](std::size_t k, const std::string& what) {
    return k < sweeps.size() && ask_sweep(sweeps[k], what);
  };
  actions.check = checking(folder, TrialSteps::none);
  actions.estimate = checking(folder, TrialSteps::some);
  actions.start = [folder, case_file](const std::string& text, const std::string& out, int ranks) {
    return start_case(folder, case_file, text, out, ranks);
  };
  return actions;
}

}  // namespace tailwater
