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
  pairs.d.resize(list.j.size());

  // Rows are packed one behind the other, so this loop goes in order. A rejected candidate is overwritten by the next
  // one, without a branch: whether a candidate is within the support is unpredictable.
  const double radius = kernel_radius(kernel);
  const double radius_squared = radius * radius;
  const double least_squared = least_distance * least_distance;
  std::int32_t* const pair_j = pairs.j.data();
  Vec<Dim>* const d = pairs.d.data();
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
      d[n] = r_ij;
      n += squared < radius_squared;
    }
    pairs.row_begin[i + 1] = n;
  }
  pairs.j.resize(n);
  pairs.d.resize(n);
  pairs.W.resize(n);
  pairs.F.resize(n);

  std::visit(
      [&](const auto& chosen) {
        for_each(n, [d = pairs.d.data(), W = pairs.W.data(), F = pairs.F.data(), kernel = chosen](std::size_t k) {
          const double r = d[k].norm();
          W[k] = kernel.value(r);
          F[k] = -kernel.derivative(r) / r;
        });
      },
      kernel);
}

template void evaluate_pairs<2>(const Kernel<2>&, std::span<const Vec<2>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<2>&);
template void evaluate_pairs<3>(const Kernel<3>&, std::span<const Vec<3>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<3>&);

}  // namespace tailwater
