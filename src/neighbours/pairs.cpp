#include "neighbours/pairs.h"

#include <cmath>

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
void evaluate_pairs(const Kernel<Dim>& kernel, std::span<const Vec<Dim>> position, std::span<const std::int64_t> id,
                    double least_distance, const NeighbourList& list, Pairs<Dim>& pairs) {
  const std::size_t rows = list.row_begin.size() - 1;
  pairs.row_begin.resize(rows + 1);
  pairs.j.resize(list.j.size());
  pairs.e.resize(list.j.size());
  pairs.r.resize(list.j.size());

  // Rows are packed one behind the other, so this loop goes in order. A rejected candidate is overwritten by the next
  // one, without a branch: whether a candidate is within the support is unpredictable.
  const double radius = kernel_radius(kernel);
  const double radius_squared = radius * radius;
  const double least_squared = least_distance * least_distance;
  std::int32_t* const pair_j = pairs.j.data();
  Vec<Dim>* const e = pairs.e.data();
  double* const r = pairs.r.data();
  std::size_t n = 0;
  pairs.row_begin[0] = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    const Vec<Dim> r_i = position[i];
    const std::size_t end = list.row_begin[i + 1];
    for (std::size_t k = list.row_begin[i]; k < end; ++k) {
      const std::int32_t j = list.j[k];
      Vec<Dim> r_ij = r_i - position[j];
      double squared = r_ij.squaredNorm();
      if (squared <= least_squared) [[unlikely]] {
        squared = least_squared;
        r_ij = (id[j] > id[i] ? least_distance : -least_distance) * Vec<Dim>::UnitX();
      }
      pair_j[n] = j;
      e[n] = r_ij;
      r[n] = squared;
      n += squared < radius_squared;
    }
    pairs.row_begin[i + 1] = n;
  }
  pairs.j.resize(n);
  pairs.e.resize(n);
  pairs.r.resize(n);
  pairs.W.resize(n);
  pairs.dW.resize(n);

  std::visit(
      [&](const auto& chosen) {
        for_each(n, [r = pairs.r.data(), W = pairs.W.data(), dW = pairs.dW.data(), kernel = chosen](std::size_t k) {
          r[k] = std::sqrt(r[k]);
          W[k] = kernel.value(r[k]);
          dW[k] = kernel.derivative(r[k]);
        });
      },
      kernel);
  for_each(n, [r = pairs.r.data(), e = pairs.e.data()](std::size_t k) {
    const double inverse = 1.0 / r[k];
    for (int d = 0; d < Dim; ++d) e[k].data()[d] *= inverse;
  });
}

template void evaluate_pairs<2>(const Kernel<2>&, std::span<const Vec<2>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<2>&);
template void evaluate_pairs<3>(const Kernel<3>&, std::span<const Vec<3>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<3>&);

}  // namespace tailwater
