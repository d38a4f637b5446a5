#include "flow/formulation.h"

#include "base/assert.h"

namespace tailwater {

template <int Dim>
void Discretisation<Dim>::find_air_weights(const Flow<Dim>& /*flow*/, std::span<const std::size_t> /*particles*/,
                                           std::span<double> /*weights*/) const {
  TAILWATER_ASSERT(false, "enclosed air has a pressure in the robust formulation only");
}

template <int Dim>
void Discretisation<Dim>::find_gradient_at(const Flow<Dim>& /*flow*/, std::span<const std::size_t> /*particles*/,
                                           const std::vector<double>& /*pressure*/,
                                           std::span<Vec<Dim>> /*gradient*/) const {
  TAILWATER_ASSERT(false, "enclosed air has a pressure in the robust formulation only");
}

#define TAILWATER_INSTANTIATE(Dim)                                                                    \
  template void Discretisation<Dim>::find_air_weights(const Flow<Dim>&, std::span<const std::size_t>, \
                                                      std::span<double>) const;                       \
  template void Discretisation<Dim>::find_gradient_at(const Flow<Dim>&, std::span<const std::size_t>, \
                                                      const std::vector<double>&, std::span<Vec<Dim>>) const;
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
