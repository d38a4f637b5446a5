// Small vectors and matrices as NumPy's arrays, copied.
#pragma once

#include <pybind11/eigen.h>

#include "base/eigen.h"

namespace pybind11::detail {

template <int Rows, int Columns>
struct type_caster<tailwater::SmallMatrix<Rows, Columns>> {
  using Matrix = tailwater::SmallMatrix<Rows, Columns>;
  using Copy = Eigen::Matrix<double, Rows, Columns>;
  PYBIND11_TYPE_CASTER(Matrix, make_caster<Copy>::name);

  bool load(handle array, bool converts) {
    make_caster<Copy> caster;
    if (!caster.load(array, converts)) return false;
    value = tailwater::from_eigen(cast_op<Copy&>(caster));
    return true;
  }
  static handle cast(const Matrix& matrix, return_value_policy /*policy*/, handle parent) {
    return make_caster<Copy>::cast(Copy(tailwater::to_eigen(matrix)), return_value_policy::move, parent);
  }
};

}  // namespace pybind11::detail
