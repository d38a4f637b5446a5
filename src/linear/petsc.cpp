#include "linear/petsc.h"

#include <dlfcn.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/fp_traps.h"
#include "linear/ignore_leaks.h"

namespace tailwater {
namespace {

void* library = nullptr;
bool is_running = false;

/// Loads the library from its place when this program was built, or from where the system has libraries of that name.
void* load() {
  const std::string path = TAILWATER_PETSC;
  for (const std::string& file : {path, path.substr(path.rfind('/') + 1)}) {
    if (void* loaded = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL)) return loaded;
  }
  throw SolverError("PETSc cannot be loaded: {}; remedy: install it, or build this program again", dlerror());
}

/// PETSc's message at the place of an error; its functions return only the code.
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

void* petsc_address(const char* name) {
  void* address = dlsym(library, name);
  if (address == nullptr) throw SolverError("PETSc's library has no {}; remedy: build this program again", name);
  return address;
}

void need_petsc() {
  if (is_running) return;
  const SuspendFpTraps suspended;
  const IgnoreLeaks ignored;
  if (library == nullptr) library = load();
  // PETSc must not handle signals: Ctrl-C must end a run in order.
  check_petsc(PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr));
  check_petsc(PetscInitializeNoArguments());
  is_running = true;
  check_petsc(PetscPushErrorHandler(keep_reason, nullptr));
}

void end_petsc() {
  if (std::exchange(is_running, false)) PetscFinalize();
}

std::string petsc_version() {
  if (library == nullptr) return "";
  std::array<PetscInt, 3> number{};
  check_petsc(PetscGetVersionNumber(&number[0], &number[1], &number[2], nullptr));
  return fmt::format("PETSc {}", fmt::join(number, "."));
}

void check_petsc(PetscErrorCode code) {
  if (code == 0) return;
  const char* kind = nullptr;
  PetscErrorMessage(code, &kind, nullptr);
  std::string reason = std::exchange(last_reason(), "");
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  throw SolverError("PETSc failed (code {}): {}{}{}", static_cast<int>(code), kind ? kind : "",
                    kind && !reason.empty() ? ": " : "", reason);
}

}  // namespace tailwater
