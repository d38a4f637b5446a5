#include "linear/session.h"

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
/// MPI's plugins stay loaded: the leak checker could not name one that is gone, and leaves out what it allocates by its
/// name (tests/support/leaks.supp).
extern "C" int dlclose(void*) { return 0; }
#endif

namespace tailwater {
namespace {

/// Alone, Open MPI would start a daemon for processes that this one might spawn, and make folders in one that all its
/// programs share and remove when they end: of two, one may lose its folder while it makes it, and then does not start.
/// And it would ask for networks that need a quarter of a second to say that they are not there. A process alone needs
/// none of this. Processes that it starts itself get no word of it.
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
  // Open MPI's hwloc looks for graphics cards by asking every X server of this machine, also where DISPLAY is not set.
  // If one ends just then, as those of pictures do, Xlib ends the whole program. By OpenCL it loads a compiler.
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
  // The rest tells how MPI was built.
  return fmt::format("{}{}{}", petsc, petsc.empty() ? "" : ", ", name.substr(0, name.find_first_of(",\n")));
}

}  // namespace tailwater
