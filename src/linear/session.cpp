#include "linear/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/petsc.h"
#include "parallel/process_limits.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>

/// MPI's plugins stay loaded: the leak checker could not name one that is gone, and leaves out what it allocates by its
/// name (tests/support/leaks.supp).
extern "C" int dlclose(void*) { return 0; }
#endif

namespace tailwater {
namespace {

/// MPI keeps what it allocates at its start until the process ends. The leak checker need not report that.
struct IgnoreLeaks {
#ifdef __SANITIZE_ADDRESS__
  IgnoreLeaks() { __lsan_disable(); }
  ~IgnoreLeaks() { __lsan_enable(); }
#else
  IgnoreLeaks() {}  // NOLINT(modernize-use-equals-default): a trivial one would leave the variable below unused
#endif
};

/// Lets a process that was started without mpirun start MPI by itself. It never starts others through MPI, so it needs
/// neither the daemon that Open MPI would start for it nor a folder for messages, which programs that start at the same
/// time dispute. What it starts later, mpirun too, must not see these settings.
class StartAlone {
 public:
  StartAlone() : alone_(std::getenv("PMIX_RANK") == nullptr) {
    if (!alone_) return;
    setenv("OMPI_MCA_ess_singleton_isolated", "1", 1);
    setenv("OMPI_MCA_orte_create_session_dirs", "0", 1);
  }
  ~StartAlone() {
    if (!alone_) return;
    unsetenv("OMPI_MCA_ess_singleton_isolated");
    unsetenv("OMPI_MCA_orte_create_session_dirs");
  }
  StartAlone(const StartAlone&) = delete;
  StartAlone& operator=(const StartAlone&) = delete;

 private:
  bool alone_;
};

/// What PETSc says where an error arises; its functions pass on only the code.
std::string& last_reason() {
  static std::string reason;
  return reason;
}

PetscErrorCode keep_reason(MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType type,
                           const char* reason, void*) {
  if (type == PETSC_ERROR_INITIAL) last_reason() = reason == nullptr ? "" : reason;
  return code;
}

}  // namespace

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const char* kind = nullptr;
  PetscErrorMessage(code, &kind, nullptr);
  std::string reason = std::exchange(last_reason(), "");
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw SolverError(fmt::format("PETSc failed (code {}): {}{}{}", static_cast<int>(code), kind ? kind : "",
                                kind && !reason.empty() ? ": " : "", reason));
}

LinearSession::LinearSession() {
  require_room_for_mpi();
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  // Open MPI's hwloc looks for graphics cards by asking every X server of this machine, also where DISPLAY is not set.
  // If one ends just then, as those of pictures do, Xlib ends the whole program.
  setenv("HWLOC_COMPONENTS", "-gl", 0);
  const StartAlone alone;
  // Signals stay ours: Ctrl-C must end a run in order.
  check_petsc(PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr));
  check_petsc(PetscInitializeNoArguments());
  check_petsc(PetscPushErrorHandler(keep_reason, nullptr));
}

LinearSession::~LinearSession() {
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  PetscFinalize();
}

std::string linear_library_version() {
  char mpi[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(mpi, &length);
  const std::string_view name(mpi, static_cast<std::size_t>(length));
  // The rest tells how MPI was built.
  return fmt::format("PETSc {}.{}.{}, {}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR,
                     name.substr(0, name.find_first_of(",\n")));
}

}  // namespace tailwater
