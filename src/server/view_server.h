// Server of `tailwater view`: a page, and its data about runs, for the browser of the user who started it
// (docs/reference/view.md). It reads the folders of runs, and sends requests to runs by the files that any user can
// create.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/json.h"

namespace tailwater {

struct ViewedRun {
  std::string name;
  std::filesystem::path path;
  Json parameters = {};  ///< for a member of a sweep: values by key
};

/// The content that is shown.
struct ViewContent {
  std::string mode;  ///< "run", "sweep", "case", "report" or "study"
  std::vector<ViewedRun> runs;
  std::optional<std::filesystem::path> case_file;
  Json report = {};  ///< result of `tailwater validate` or `tailwater study`
};

/// Actions that need the whole program. Several threads may call each at once; a failure is a UserError.
struct ViewActions {
  std::function<Json(const std::string& text)> check;
  std::function<Json(const std::string& text)> estimate;  ///< with an estimate of the run time; slower
  std::function<std::filesystem::path(const std::string& text, const std::string& out, int ranks)> start;
  std::function<void(const std::filesystem::path& run)> resume;
  std::function<Json()> sweeps;  ///< state of each sweep
  /// Sends a sweep the request "stop" or "resume"; false: there is no such sweep or request.
  std::function<bool(std::size_t sweep, const std::string& what)> ask_sweep;
  std::function<Json()> spec;
  std::function<Json()> templates;
  std::function<std::optional<std::string>(const std::string& name)> template_text;
  std::function<std::string()> free_name;  ///< for the folder of a new run
  int max_ranks = 1;
  std::string version;
};

class ViewServer {
 public:
  /// Listens on 127.0.0.1 only; port 0 means any free port. Throws IoError if the port is taken.
  ViewServer(ViewContent content, ViewActions actions, int port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;
  /// http://127.0.0.1:PORT/TOKEN/
  std::string address() const;

  /// Serves until another thread calls `stop`.
  void serve();
  void stop();

 private:
  class Service;
  std::unique_ptr<Service> service_;
};

/// The page with all its data about these runs in it, for a browser without this program. Throws IoError if a run has
/// no data to show.
std::string exported_page(const ViewContent& content, const std::string& version);

/// The scene of a run: the file that it has written or, without a stream, made from its case.
Json scene_of_run(const std::filesystem::path& run);

}  // namespace tailwater
