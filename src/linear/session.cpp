#include "linear/session.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/ignore_leaks.h"
#include "linear/petsc.h"
#include "parallel/process_limits.h"

#ifdef __SANITIZE_ADDRESS__
/// Keeps MPI's plugins loaded. The leak checker identifies the memory to ignore by the name of the plugin
/// (tests/support/leaks.supp), which it cannot determine after the plugin is unloaded.
extern "C" int dlclose(void*) noexcept { return 0; }
#endif

namespace tailwater {
namespace {

/// Without this, Open MPI would start a daemon for processes that this one might spawn. It would make folders in one
/// that all its programs use, and remove when they end. Of two programs, one may lose its folder while making it, and
/// then does not start. Open MPI would also query networks that take a quarter of a second to report that they are
/// absent. A single process needs none of this. Processes that it starts itself do not inherit the settings.
class StartAlone {
 public:
  StartAlone() {
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMIX_RANK") != nullptr) return;
    for (const auto& [name, value] : settings_) {
      if (std::getenv(name) == nullptr && setenv(name, value, 0) == 0) set_.push_back(name);
    }
    if (std::getenv(chosen_) == nullptr) set_.push_back(chosen_);
  }
  ~StartAlone() {
    for (const char* name : set_) unsetenv(name);
  }
  StartAlone(const StartAlone&) = delete;
  StartAlone& operator=(const StartAlone&) = delete;

 private:
  static constexpr std::pair<const char*, const char*> settings_[] = {{"OMPI_MCA_ess_singleton_isolated", "1"},
                                                                      {"OMPI_MCA_orte_create_session_dirs", "0"},
                                                                      {"OMPI_MCA_pml", "ob1"},
                                                                      {"OMPI_MCA_btl", "self"}};
  static constexpr const char* chosen_ = "OMPI_MCA_pmix";  ///< Open MPI sets this itself
  std::vector<const char*> set_;
};

}  // namespace

LinearSession::LinearSession() {
  require_room_for_mpi();
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  // Open MPI's hwloc searches for graphics cards by querying every X server of this machine, even if DISPLAY is not
  // set. If an X server ends during the query, as those of pictures do, Xlib ends the whole program. OpenCL loads a
  // compiler.
  setenv("HWLOC_COMPONENTS", "-gl,-opencl", 0);
  const StartAlone alone;
  int is_running = 0;  // Python may have started it
  MPI_Initialized(&is_running);
  if (is_running != 0) return;
  int threads = MPI_THREAD_SINGLE;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &threads) != MPI_SUCCESS) {
    throw SolverError("MPI does not start");
  }
  has_started_mpi_ = true;
}

LinearSession::~LinearSession() {
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  end_petsc();
  if (has_started_mpi_) MPI_Finalize();
}

std::string linear_library_version() {
  char mpi[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(mpi, &length);
  const std::string_view name(mpi, static_cast<std::size_t>(length));
  const std::string petsc = petsc_version();
  // The rest of the name describes how MPI was built.
  return fmt::format("{}{}{}", petsc, petsc.empty() ? "" : ", ", name.substr(0, name.find_first_of(",\n")));
}

}  // namespace tailwater
