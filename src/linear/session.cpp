#include "linear/session.h"

#include <fmt/format.h>

#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/petsc.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
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

}  // namespace

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const char* text = nullptr;
  char* specific = nullptr;
  PetscErrorMessage(code, &text, &specific);
  throw SolverError(fmt::format("PETSc failed (code {}): {} {}", static_cast<int>(code), text ? text : "unknown error",
                                specific ? specific : ""));
}

LinearSession::LinearSession() {
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  // Signals stay ours: Ctrl-C must end a run in order.
  check_petsc(PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr));
  check_petsc(PetscInitializeNoArguments());
  check_petsc(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr));
}

LinearSession::~LinearSession() {
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  PetscFinalize();
}

std::string linear_library_version() {
  return fmt::format("PETSc {}.{}.{}", PETSC_VERSION_MAJOR, PETSC_VERSION_MINOR, PETSC_VERSION_SUBMINOR);
}

}  // namespace tailwater
