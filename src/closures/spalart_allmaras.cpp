#include "closures/spalart_allmaras.h"

#include "neighbours/pair_lanes.h"
#include "operators/laplacian_morris.h"

namespace tailwater::spalart_allmaras {

template <int Dim>
double diffusion(const Pairs<Dim>& pairs, const Particles<Dim>& particles, double molecular, double spacing,
                 std::size_t i) {
  const std::vector<double>& nu = particles.layer_viscosity;
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = pairs.j[k];
    if (!particles.is_fluid(j)) continue;
    const double mean = molecular + 0.5 * (nu[i] + nu[j]);
    const double weight = (1.0 + c_b2) * mean - c_b2 * (molecular + nu[i]);
    sum += weight * morris_laplacian_weight(particles.volume[j], pairs.F(i, k), pairs.d(i, k).squaredNorm(), spacing) *
           (nu[j] - nu[i]);
  }
  return sum / sigma;
}

TAILWATER_IN_2D_AND_3D(diffusion);

}  // namespace tailwater::spalart_allmaras
