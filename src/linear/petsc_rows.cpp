#include "linear/petsc_rows.h"

#include <algorithm>
#include <utility>

namespace tailwater {

static_assert(sizeof(PetscInt) == sizeof(int), "the compressed rows are shared with PETSc");
static_assert(sizeof(PetscScalar) == sizeof(double), "the values are shared with PETSc");

void PetscRows::take(const LinearSystem& system) {
  Block own;
  Block others;
  const std::int64_t first = system.first_number();
  const auto count = static_cast<std::int64_t>(system.size());
  const LinearSystem::Part rows = system.whole();
  std::vector<std::pair<std::int64_t, double>> entries;  // of a row: number over all ranks, value
  for (std::size_t i = 0; i < system.size(); ++i) {
    entries.assign(1, {first + static_cast<std::int64_t>(i), 1.0});
    for (std::size_t k = rows.begin[i]; k < rows.end[i]; ++k) {
      const std::int32_t column = rows.column[k];
      entries.emplace_back(column < count ? first + column : system.number_of_ghost(column),
                           -system.scale(i) * rows.weight[k]);
    }
    std::sort(entries.begin(), entries.end());
    for (const auto& [number, value] : entries) {
      const bool is_own = number >= first && number < first + count;
      is_own ? own.add(number - first, value) : others.add(number, value);
    }
    own.end_row();
    others.end_row();
  }
  if (pattern_number_ == system.pattern_number()) {
    std::ranges::copy(own.value, own_.value.begin());
    std::ranges::copy(others.value, others_.value.begin());
  } else {
    own_ = std::move(own);
    others_ = std::move(others);
    make_matrix(system);
    pattern_number_ = system.pattern_number();
  }
  // The values in the shared arrays have changed, and PETSc chooses the matrix's operations at an assembly.
  check_petsc(MatAssemblyBegin(matrix_.get(), MAT_FINAL_ASSEMBLY));
  check_petsc(MatAssemblyEnd(matrix_.get(), MAT_FINAL_ASSEMBLY));
}

void PetscRows::make_matrix(const LinearSystem& system) {
  const auto rows = static_cast<PetscInt>(system.size());
  if (system.ranks().is_alone()) {
    check_petsc(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, rows, rows, own_.begin.data(), own_.column.data(),
                                          own_.value.data(), matrix_.create()));
  } else {
    check_petsc(MatCreateMPIAIJWithSplitArrays(
        system.ranks().handle(), rows, rows, PETSC_DETERMINE, PETSC_DETERMINE, own_.begin.data(), own_.column.data(),
        own_.value.data(), others_.begin.data(), others_.column.data(), others_.value.data(), matrix_.create()));
  }
  check_petsc(MatSetOption(matrix_.get(), MAT_NEW_NONZERO_LOCATIONS, PETSC_FALSE));
}

}  // namespace tailwater
