#include "server/view_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <deque>
#include <mutex>
#include <thread>

#include "base/error.h"
#include "io/folder_lock.h"
#include "io/run_folder.h"
#include "io/write_file.h"
#include "results/run_info.h"
#include "server/answers.h"
#include "server/bounded_queue.h"
#include "server/guard.h"
#include "server/http_server.h"
#include "server/page.h"
#include "server/run_watch.h"

namespace tailwater {
namespace {

namespace fs = std::filesystem;
using httplib::Request;
using httplib::Response;

constexpr std::size_t threads = 48;
constexpr std::size_t waiting_connections = 64;
constexpr int max_streams = 24;                              // streams of events; each takes a thread
constexpr std::size_t largest_case = std::size_t{8} << 20U;  // bytes
constexpr auto time_between_looks = std::chrono::milliseconds(200);
constexpr auto time_between_signs_of_life = std::chrono::seconds(10);

const char* type_of(std::string_view path) {
  if (path.ends_with(".csv")) return "text/csv; charset=utf-8";
  if (path.ends_with(".json")) return "application/json";
  return "text/plain; charset=utf-8";
}

}  // namespace

class ViewServer::Service {
 public:
  Service(ViewContent content, ViewActions actions, int port)
      : actions_(std::move(actions)),
        mode_(std::move(content.mode)),
        case_file_(std::move(content.case_file)),
        report_(std::move(content.report)),
        token_(random_token()) {
    for (ViewedRun& run : content.runs) add(std::move(run));
    http_.set_socket_options([](int socket) {
      const int yes = 1;
      setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    http_.new_task_queue = [] { return new BoundedQueue(threads, waiting_connections); };
    http_.set_payload_max_length(largest_case);
    http_.set_default_headers({{"X-Content-Type-Options", "nosniff"},
                               {"Referrer-Policy", "no-referrer"},
                               {"Cache-Control", "no-store"},
                               {"Cross-Origin-Resource-Policy", "same-origin"},
                               {"Cross-Origin-Opener-Policy", "same-origin"}});
    http_.set_pre_routing_handler([this](const Request& request, Response& response) {
      // `range_of` reads ranges, because the library's own code does not limit them to the size of the file.
      const_cast<Request&>(request).ranges.clear();
      return begin_answer(request, response) ? HttpServer::HandlerResponse::Unhandled
                                             : HttpServer::HandlerResponse::Handled;
    });
    http_.Post(R"(/[\s\S]*)", [this](const Request& request, Response& response) { answer(request, response); });
    http_.set_exception_handler([](const Request&, Response& response, const std::exception_ptr&) {
      answer_error(response, 500, "the server could not answer");
    });
    const char* host = "127.0.0.1";
    port_ = port == 0 ? http_.bind_to_any_port(host) : (http_.bind_to_port(host, port) ? port : -1);
    if (port_ < 0) {
      throw IoError(
          "cannot listen on port {} of 127.0.0.1, which may be in use; remedy: choose another --port, or leave it out",
          port);
    }
    http_.let_many_wait();
  }

  int port() const { return port_; }
  const std::string& token() const { return token_; }
  void serve() { http_.listen_after_bind(); }
  void stop() {
    is_ending_ = true;
    http_.stop();
  }

 private:
  struct Run {
    explicit Run(ViewedRun viewed) : what(std::move(viewed)), folder(what.path), frames(folder) {}
    ViewedRun what;
    FolderReader folder;
    std::mutex mutex;
    FrameIndex frames;  ///< guarded, as the scene is
    std::string scene;
  };

  /// Checks the origin of a request. Answers all requests but those whose body must be read first; returns whether it
  /// is one of these.
  bool begin_answer(const Request& request, Response& response) {
    const std::vector<std::string> path = segments_of(request.path);
    const std::string host = request.get_header_value("Host");
    response.set_header("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
    if (!is_own_host(host) || !is_own_origin(request.get_header_value("Origin"), host)) {
      answer_error(response, 403, "this server answers its own page alone");
      return false;
    }
    if (path.empty() || !is_token(path[0], token_)) {
      answer_error(response, 403, "the address needs the token that `tailwater view` has printed");
      return false;
    }
    if (request.method == "POST") {
      if (request.get_header_value("X-Tailwater") == "page") return true;
      answer_error(response, 403, "this needs the header X-Tailwater: page");
      return false;
    }
    if (request.method != "GET" && request.method != "HEAD") {
      answer_error(response, 405, "only GET and POST are answered");
      return false;
    }
    answer(request, response);
    return false;
  }

  void answer(const Request& request, Response& response) {
    const std::vector<std::string> path = segments_of(request.path);
    try {
      const bool is_known = request.method == "POST" ? post(request, response, path) : get(request, response, path);
      if (!is_known) answer_error(response, 404, "there is no such thing");
    } catch (const UserError& error) {
      answer_error(response, error.code() == ExitCode::io_failed ? 500 : 400, error.what());
    } catch (const Json::exception&) {
      answer_error(response, 400, "the request is not valid");
    }
  }

  // Paths are /TOKEN/..., /TOKEN/api/..., /TOKEN/api/run/ID/...

  bool get(const Request& request, Response& response, const std::vector<std::string>& path) {
    if (path.size() == 1) {
      response.set_redirect(fmt::format("/{}/", token_));
      return true;
    }
    if (path.size() == 2 && path[1].empty()) {
      // The page has its own policy for resources; only the header can restrict framing.
      response.headers.erase("Content-Security-Policy");
      response.set_header("Content-Security-Policy", "frame-ancestors 'none'");
      answer_text(response, std::string(view_page()), "text/html; charset=utf-8");
      return true;
    }
    if (path.size() < 3 || path[1] != "api") return false;
    const std::string& what = path[2];
    if (what == "run" && path.size() >= 5) {
      Run* run = find(path[3]);
      return run != nullptr && get_of_run(request, response, *run, {path.begin() + 4, path.end()});
    }
    if (what == "template" && path.size() == 4) {
      const std::optional<std::string> text = actions_.template_text(path[3]);
      if (text) answer_text(response, *text, "application/toml");
      return text.has_value();
    }
    if (path.size() != 3) return false;
    if (what == "state") {
      answer_json(response, state());
    } else if (what == "spec") {
      answer_json(response, actions_.spec());
    } else if (what == "templates") {
      answer_json(response, actions_.templates());
    } else if (what == "sweeps") {
      answer_json(response, actions_.sweeps());
    } else if (what == "case" && case_file_) {
      const FolderReader folder(folder_of_case());
      answer_text(response, folder.text_of({case_file_->filename().string()}), "application/toml");
    } else {
      return false;
    }
    return true;
  }

  bool get_of_run(const Request& request, Response& response, Run& run, const std::vector<std::string>& path) {
    const std::string& what = path[0];
    if (what == "file") {
      std::string name = path.size() > 1 ? path[1] : "";
      for (std::size_t k = 2; k < path.size(); ++k) name += "/" + path[k];
      const std::vector<std::string> names = names_of_readable_file(name);
      std::optional<OpenFile> file = run.folder.open(names);
      if (file) {
        answer_file(request, response, std::move(*file), type_of(name));
      } else if (run.folder.lacks(names)) {
        response.status = 204;  // a table begins with its first reading
      } else {
        return false;
      }
      return true;
    }
    if (what == "frame" && path.size() == 2) return get_frame(response, run, path[1]);
    if (path.size() != 1) return false;
    if (what == "scene") {
      const std::lock_guard lock(run.mutex);
      if (run.scene.empty()) run.scene = scene_of_run(run.what.path).dump();
      answer_text(response, run.scene, "application/json");
    } else if (what == "frames") {
      answer_json(response, frames_of(run, request.get_param_value("from")));
    } else if (what == "info") {
      answer_json(response, run_info(run.what.path));
    } else if (what == "events") {
      answer_events(request, response, run);
    } else {
      return false;
    }
    return true;
  }

  bool get_frame(Response& response, Run& run, const std::string& number) {
    const std::optional<std::uint32_t> index = whole_number(number);
    if (!index) return false;
    std::unique_lock lock(run.mutex);
    if (!run.frames.frames().contains(*index)) run.frames.look();
    const FrameIndex frames = run.frames;
    lock.unlock();  // reading a field file takes a while
    std::optional<std::string> bytes = frames.bytes_of(*index);
    response.status = bytes ? 200 : 204;  // it may have been removed
    if (bytes) response.set_content(*bytes, "application/octet-stream");
    return true;
  }

  static Json frames_of(Run& run, const std::string& from) {
    const std::uint32_t first = whole_number(from).value_or(0);
    const std::string state = run_info(run.what.path).value("state", "");
    const std::lock_guard lock(run.mutex);
    run.frames.look();
    Json list = Json::array();
    for (auto frame = run.frames.frames().lower_bound(first); frame != run.frames.frames().end(); ++frame) {
      const auto& [index, entry] = *frame;
      list.push_back({{"index", index}, {"time", entry.time}, {"key", entry.is_key}, {"bytes", entry.bytes}});
    }
    return {{"frames", std::move(list)}, {"done", state == "done" || state == "failed" || state == "stopped"}};
  }

  void answer_events(const Request& request, Response& response, const Run& run) {
    if (++streams_ > max_streams) {
      --streams_;
      response.set_header("Retry-After", "5");
      return answer_error(response, 503, "too many pages are open");
    }
    const auto watch =
        std::make_shared<RunWatch>(run.what.path, whole_number(request.get_param_value("from")).value_or(0));
    auto last_word = std::make_shared<std::chrono::steady_clock::time_point>(std::chrono::steady_clock::now());
    response.status = 200;
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, watch, last_word](std::size_t offset, httplib::DataSink& sink) {
          if (is_ending_) {
            sink.done();
            return true;
          }
          if (offset > 0) std::this_thread::sleep_for(time_between_looks);
          std::string news = watch->look();
          const auto now = std::chrono::steady_clock::now();
          // A comment line, by which a closed page is detected.
          if (news.empty() && (offset == 0 || now - *last_word > time_between_signs_of_life)) news = ":\n\n";
          if (news.empty()) return sink.is_writable();
          *last_word = now;
          return sink.write(news.data(), news.size());
        },
        [this](bool) { --streams_; });
  }

  bool post(const Request& request, Response& response, const std::vector<std::string>& path) {
    if (path.size() < 3 || path[1] != "api") return false;
    const std::string& what = path[2];
    if (what == "run" && path.size() == 5) {
      Run* run = find(path[3]);
      return run != nullptr && ask_run(response, *run, path[4]);
    }
    if (what == "sweep" && path.size() == 5) {
      const std::optional<std::uint32_t> index = whole_number(path[3]);
      const bool is_known = index && actions_.ask_sweep(*index, path[4]);
      if (is_known) answer_json(response, {{"ok", true}});
      return is_known;
    }
    if (path.size() != 3) return false;
    if (what == "check" || what == "estimate") {
      answer_json(response, what == "check" ? actions_.check(request.body) : actions_.estimate(request.body));
    } else if (what == "save" && case_file_) {
      write_text_file(*case_file_, request.body);
      answer_json(response, {{"ok", true}});
    } else if (what == "start") {
      const Json wanted = Json::parse(request.body);
      const fs::path folder = actions_.start(wanted.at("text"), wanted.at("out"), wanted.value("ranks", 1));
      answer_json(response, {{"run", add({.name = folder.filename().string(), .path = folder})}});
    } else {
      return false;
    }
    return true;
  }

  bool ask_run(Response& response, const Run& run, const std::string& what) {
    const bool is_at_work = FolderLock::is_held(run.what.path);
    if (what == "stop" || what == "checkpoint") {
      if (!is_at_work) {
        answer_error(response, 409, "no process is running in this folder");
        return true;
      }
      const std::string_view file = what == "stop" ? stop_file_name : checkpoint_file_name;
      if (!run.folder.touch(std::string(file))) {
        answer_error(response, 500, fmt::format("cannot make the file {} in the run's folder", file));
        return true;
      }
    } else if (what == "resume") {
      if (is_at_work) {
        answer_error(response, 409, "the run is in progress");
        return true;
      }
      actions_.resume(run.what.path);
    } else {
      return false;
    }
    answer_json(response, {{"ok", true}});
    return true;
  }

  Json state() {
    Json runs = Json::array();
    {
      const std::lock_guard lock(mutex_);
      for (std::size_t k = 0; k < runs_.size(); ++k) {
        const ViewedRun& run = runs_[k]->what;
        Json shown{{"id", std::to_string(k)}, {"name", run.name}, {"path", run.path.string()}};
        if (!run.parameters.is_null()) shown["parameters"] = run.parameters;
        runs.push_back(std::move(shown));
      }
    }
    return {{"mode", mode_},
            {"runs", std::move(runs)},
            {"case", case_file_ ? Json{{"path", case_file_->string()}} : Json()},
            {"report", report_},
            {"version", actions_.version},
            {"ranks_most", actions_.max_ranks},
            {"out", actions_.free_name()}};
  }

  /// Returns the id of the run.
  std::string add(ViewedRun run) {
    const std::lock_guard lock(mutex_);
    runs_.push_back(std::make_unique<Run>(std::move(run)));
    return std::to_string(runs_.size() - 1);
  }

  Run* find(const std::string& id) {
    const std::optional<std::uint32_t> index = whole_number(id);
    const std::lock_guard lock(mutex_);
    return index && *index < runs_.size() ? runs_[*index].get() : nullptr;
  }

  fs::path folder_of_case() const { return case_file_->has_parent_path() ? case_file_->parent_path() : "."; }

  ViewActions actions_;
  std::string mode_;
  std::optional<fs::path> case_file_;
  Json report_;
  std::string token_;
  int port_ = 0;
  HttpServer http_;
  std::mutex mutex_;
  std::deque<std::unique_ptr<Run>> runs_;  ///< guarded; existing elements stay
  std::atomic<int> streams_ = 0;
  std::atomic<bool> is_ending_ = false;
};

ViewServer::ViewServer(ViewContent content, ViewActions actions, int port)
    : service_(std::make_unique<Service>(std::move(content), std::move(actions), port)) {}
ViewServer::~ViewServer() = default;

int ViewServer::port() const { return service_->port(); }
std::string ViewServer::address() const {
  return fmt::format("http://127.0.0.1:{}/{}/", service_->port(), service_->token());
}
void ViewServer::serve() { service_->serve(); }
void ViewServer::stop() { service_->stop(); }

}  // namespace tailwater
