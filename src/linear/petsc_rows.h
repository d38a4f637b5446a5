// The rows of a LinearSystem as a PETSc matrix, for the preconditioners of PETSc that need one.
#pragma once

#include <vector>

#include "linear/linear_system.h"
#include "linear/petsc.h"

namespace tailwater {

class PetscRows {
 public:
  /// Copies the rows of the system. Collective.
  void take(const LinearSystem& system);
  Mat get() const { return matrix_.get(); }

 private:
  /// The entries of all rows in one kind of column, in compressed rows.
  struct Block {
    std::vector<int> begin{0};
    std::vector<int> column;  ///< ascending in each row
    std::vector<double> value;

    void add(std::int64_t of_column, double of_value) {
      column.push_back(static_cast<int>(of_column));
      value.push_back(of_value);
    }
    void end_row() { begin.push_back(static_cast<int>(column.size())); }
  };

  void make_matrix(const LinearSystem& system);

  std::uint64_t pattern_number_ = 0;
  Block own_;     ///< unknowns of this rank, columns counted from its first
  Block others_;  ///< unknowns of other ranks, columns counted over all ranks until PETSc renumbers them
  PetscMatrix matrix_;
};

}  // namespace tailwater
