// Vectors of PETSc as spans, and spans as vectors of PETSc.
#pragma once

#include <span>

#include "linear/petsc.h"
#include "parallel/communicator.h"

namespace tailwater {

/// Access to the entries of two PETSc vectors during the lifetime of this object.
class VectorAccess {
 public:
  VectorAccess(Vec from, Vec to) : from_(from), to_(to) {
    check_petsc(VecGetLocalSize(from, &size_));
    check_petsc(VecGetArrayRead(from, &read_));
    check_petsc(VecGetArrayWrite(to, &written_));
  }
  ~VectorAccess() {
    VecRestoreArrayWrite(to_, &written_);
    VecRestoreArrayRead(from_, &read_);
  }
  VectorAccess(const VectorAccess&) = delete;
  VectorAccess& operator=(const VectorAccess&) = delete;

  std::span<const double> from() const { return {read_, static_cast<std::size_t>(size_)}; }
  std::span<double> to() const { return {written_, static_cast<std::size_t>(size_)}; }

 private:
  Vec from_;
  Vec to_;
  PetscInt size_ = 0;
  const PetscScalar* read_ = nullptr;
  PetscScalar* written_ = nullptr;
};

/// Makes a PETSc vector of which `values` are the entries, without a copy.
inline void wrap(const Communicator& ranks, std::span<const double> values, PetscVector& vector) {
  const auto rows = static_cast<PetscInt>(values.size());
  check_petsc(ranks.is_alone()
                  ? VecCreateSeqWithArray(PETSC_COMM_SELF, 1, rows, values.data(), vector.create())
                  : VecCreateMPIWithArray(ranks.handle(), 1, rows, PETSC_DETERMINE, values.data(), vector.create()));
}

}  // namespace tailwater
