// The interface of PETSc for this module: PETSc is loaded when the first system needs it, handles are move-only values,
// and error codes become exceptions. Only this module includes PETSc.
#pragma once

#include <petscksp.h>

#include <string>
#include <utility>

namespace tailwater {

/// Loads and starts PETSc, if that has not been done. PETSc brings a hundred libraries, whose loading takes three times
/// as long as the rest of the start of this program, and most runs solve no system that needs it. MPI must run.
/// Collective.
void need_petsc();

/// Ends PETSc where this program started it.
void end_petsc();

/// The version of the library: "PETSc 3.18.5"; empty if none is loaded.
std::string petsc_version();

/// The address of a function of PETSc, which must be loaded.
void* petsc_address(const char* name);

/// A function of PETSc by its name. A call is valid once PETSc is loaded.
template <class Function>
class PetscFunction;

template <class... Arguments>
class PetscFunction<PetscErrorCode(Arguments...)> {
 public:
  constexpr explicit PetscFunction(const char* name) : name_(name) {}

  PetscErrorCode operator()(Arguments... arguments) const {
    if (function_ == nullptr) function_ = reinterpret_cast<PetscErrorCode (*)(Arguments...)>(petsc_address(name_));
    return function_(arguments...);
  }

 private:
  const char* name_;
  mutable PetscErrorCode (*function_)(Arguments...) = nullptr;
};

// In this namespace these names hide PETSc's own functions, with which the program would have to be linked. The linker
// does not find a function that is missing in this list.
#define TAILWATER_LOADED(function) inline const PetscFunction<decltype(::function)> function(#function)
TAILWATER_LOADED(KSPConvergedDefaultSetUIRNorm);
TAILWATER_LOADED(KSPCreate);
TAILWATER_LOADED(KSPDestroy);
TAILWATER_LOADED(KSPFCGSetNprealloc);
TAILWATER_LOADED(KSPGMRESSetRestart);
TAILWATER_LOADED(KSPGetConvergedReason);
TAILWATER_LOADED(KSPGetConvergedReasonString);
TAILWATER_LOADED(KSPGetIterationNumber);
TAILWATER_LOADED(KSPGetPC);
TAILWATER_LOADED(KSPGetResidualHistory);
TAILWATER_LOADED(KSPGetType);
TAILWATER_LOADED(KSPSetFromOptions);
TAILWATER_LOADED(KSPSetInitialGuessNonzero);
TAILWATER_LOADED(KSPSetNormType);
TAILWATER_LOADED(KSPSetOperators);
TAILWATER_LOADED(KSPSetOptionsPrefix);
TAILWATER_LOADED(KSPSetPCSide);
TAILWATER_LOADED(KSPSetResidualHistory);
TAILWATER_LOADED(KSPSetReusePreconditioner);
TAILWATER_LOADED(KSPSetTolerances);
TAILWATER_LOADED(KSPSetType);
TAILWATER_LOADED(KSPSetUp);
TAILWATER_LOADED(KSPSolve);
TAILWATER_LOADED(MatAssemblyBegin);
TAILWATER_LOADED(MatAssemblyEnd);
TAILWATER_LOADED(MatCreateMPIAIJWithSplitArrays);
TAILWATER_LOADED(MatCreateSeqAIJ);
TAILWATER_LOADED(MatCreateSeqAIJWithArrays);
TAILWATER_LOADED(MatCreateShell);
TAILWATER_LOADED(MatDestroy);
TAILWATER_LOADED(MatNullSpaceCreate);
TAILWATER_LOADED(MatNullSpaceDestroy);
TAILWATER_LOADED(MatSetNullSpace);
TAILWATER_LOADED(MatSetOption);
TAILWATER_LOADED(MatSetValues);
TAILWATER_LOADED(MatShellGetContext);
TAILWATER_LOADED(MatShellSetOperation);
TAILWATER_LOADED(PCSORSetOmega);
TAILWATER_LOADED(PCSORSetSymmetric);
TAILWATER_LOADED(PCSetType);
TAILWATER_LOADED(PCShellGetContext);
TAILWATER_LOADED(PCShellSetApply);
TAILWATER_LOADED(PCShellSetContext);
TAILWATER_LOADED(PetscErrorMessage);
TAILWATER_LOADED(PetscFinalize);
TAILWATER_LOADED(PetscGetVersionNumber);
TAILWATER_LOADED(PetscInitializeNoArguments);
TAILWATER_LOADED(PetscObjectTypeCompare);
TAILWATER_LOADED(PetscOptionsClear);
TAILWATER_LOADED(PetscOptionsHasName);
TAILWATER_LOADED(PetscOptionsInsertString);
TAILWATER_LOADED(PetscOptionsLeftGet);
TAILWATER_LOADED(PetscOptionsLeftRestore);
TAILWATER_LOADED(PetscOptionsSetValue);
TAILWATER_LOADED(PetscPushErrorHandler);
TAILWATER_LOADED(VecCreateMPIWithArray);
TAILWATER_LOADED(VecCreateSeqWithArray);
TAILWATER_LOADED(VecDestroy);
TAILWATER_LOADED(VecGetArrayRead);
TAILWATER_LOADED(VecGetArrayWrite);
TAILWATER_LOADED(VecGetLocalSize);
TAILWATER_LOADED(VecRestoreArrayRead);
TAILWATER_LOADED(VecRestoreArrayWrite);
#undef TAILWATER_LOADED

/// Throws SolverError with PETSc's own message when `code` reports a failed call.
void check_petsc(PetscErrorCode code);

/// Owns a PETSc object and destroys it. `destroy` is the PETSc function for its type.
template <class Handle, const PetscFunction<PetscErrorCode(Handle*)>& destroy>
class PetscHandle {
 public:
  PetscHandle() = default;
  PetscHandle(PetscHandle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
  PetscHandle& operator=(PetscHandle&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  PetscHandle(const PetscHandle&) = delete;
  PetscHandle& operator=(const PetscHandle&) = delete;
  ~PetscHandle() { reset(); }

  void reset() {
    if (handle_ != nullptr) destroy(&handle_);
  }
  Handle get() const { return handle_; }
  /// For PETSc's functions that create objects. Destroys the present object first.
  Handle* create() {
    reset();
    return &handle_;
  }

 private:
  Handle handle_ = nullptr;
};

using PetscMatrix = PetscHandle<Mat, MatDestroy>;
using PetscVector = PetscHandle<Vec, VecDestroy>;
using PetscKrylovSolver = PetscHandle<KSP, KSPDestroy>;
using PetscNullSpace = PetscHandle<MatNullSpace, MatNullSpaceDestroy>;

}  // namespace tailwater
