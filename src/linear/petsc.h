// PETSc handles as move-only values whose error codes become exceptions. Only this room includes PETSc.
#pragma once

#include <petscksp.h>

#include <utility>

namespace tailwater {

/// Throws SolverError with PETSc's own message when `code` says that a call failed.
void check_petsc(PetscErrorCode code);

/// Owns a PETSc object and destroys it. Destroy is the PETSc function for its type.
template <class Handle, PetscErrorCode (*Destroy)(Handle*)>
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
    if (handle_ != nullptr) Destroy(&handle_);
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
