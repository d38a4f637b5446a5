#include "neighbours/pairs.h"

#include <cmath>

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
void evaluate_pairs(const Kernel<Dim>& kernel, std::span<const Vec<Dim>> position, double least_distance,
                    Pairs<Dim>& pairs) {
  const std::size_t count = pairs.j.size();
  pairs.e.resize(count);
  pairs.r.resize(count);
  pairs.W.resize(count);
  pairs.dW.resize(count);
  std::visit(
      [&](const auto& chosen) {
        for_each(pairs.owned(), [&](std::size_t i) {
          for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
            const Vec<Dim> r_ij = position[i] - position[pairs.j[k]];
            const double squared = r_ij.squaredNorm();
            if (squared > least_distance * least_distance) {
              const double r = std::sqrt(squared);
              pairs.r[k] = r;
              pairs.e[k] = r_ij / r;
            } else {
              pairs.r[k] = least_distance;
              const double sign = static_cast<std::size_t>(pairs.j[k]) > i ? 1.0 : -1.0;
              pairs.e[k] = sign * Vec<Dim>::UnitX();
            }
            pairs.W[k] = chosen.value(pairs.r[k]);
            pairs.dW[k] = chosen.derivative(pairs.r[k]);
          }
        });
      },
      kernel);
}

template void evaluate_pairs<2>(const Kernel<2>&, std::span<const Vec<2>>, double, Pairs<2>&);
template void evaluate_pairs<3>(const Kernel<3>&, std::span<const Vec<3>>, double, Pairs<3>&);

}  // namespace tailwater
