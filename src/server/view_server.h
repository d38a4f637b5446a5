// The server behind `tailwater view`: a page, and what it shows of runs, for the browser of whoever started it
// (docs/reference/view.md). It reads the folders of runs, and asks runs by the files that any user can make.
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
  Json parameters = {};  ///< of a member of a sweep: values by key
};

/// What is shown.
struct ViewContent {
  std::string mode;  ///< "run", "sweep", "case", "report" or "study"
  std::vector<ViewedRun> runs;
  std::optional<std::filesystem::path> case_file;
  Json report = {};  ///< what `tailwater validate` or `tailwater study` found
};

/// What only the whole program can do. Each may be called by several threads at once; a failure is a UserError.
struct ViewActions {
  std::function<Json(const std::string& text)> check;
  std::function<Json(const std::string& text)> estimate;  ///< the same with the time that a run takes; slower
  std::function<std::filesystem::path(const std::string& text, const std::string& out, int ranks)> start;
  std::function<void(const std::filesystem::path& run)> resume;
  std::function<Json()> sweeps;  ///< how each is
  /// Asks a sweep to "stop" or to "resume"; false: there is no such sweep or request.
  std::function<bool(std::size_t sweep, const std::string& what)> ask_sweep;
  std::function<Json()> spec;
  std::function<Json()> templates;
  std::function<std::optional<std::string>(const std::string& name)> template_text;
  std::function<std::string()> free_name;  ///< of a folder for a new run
  int most_ranks = 1;
  std::string version;
};

class ViewServer {
 public:
  /// Listens on 127.0.0.1 alone, on a port of the system's choice if it is 0. Throws IoError if it is taken.
  ViewServer(ViewContent content, ViewActions actions, int port);
  ~ViewServer();
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;

  int port() const;
  /// http://127.0.0.1:PORT/TOKEN/
  std::string address() const;

  /// Serves until `stop`, which another thread calls.
  void serve();
  void stop();

 private:
  class Service;
  std::unique_ptr<Service> service_;
};

/// The page with all that it shows of these runs in it, for a browser without this program. Throws IoError if a run has
/// nothing to show.
std::string exported_page(const ViewContent& content, const std::string& version);

/// The scene of a run: what it has written, or, of one without a stream, made from its case.
Json scene_of_run(const std::filesystem::path& run);

}  // namespace tailwater
