// The scheme's choice of gradient and divergence. Both use the same pairs and volumes; the two defaults are negative
// adjoints of each other.
#pragma once

#include "flow/flow.h"

namespace tailwater {

/// Gradient of a pressure field at fluid particle i [its unit/m]. 0 where the consistent operator is chosen and does
/// not exist, so that spray falls freely.
template <int Dim>
Vec<Dim> gradient_at(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure);

/// What wall particle i pushes the fluid with by a pressure field, over its volume [the field's unit * m^(Dim - 1)]:
/// the reactions of its shares in the gradients at its fluid neighbours. The consistent gradient has no reactions; for
/// it this is what the conservative one would push with.
template <int Dim>
Vec<Dim> push_of_wall_particle(const Flow<Dim>& flow, std::size_t i, const std::vector<double>& pressure);

/// div of a velocity at fluid particles [1/s]; 0 where the consistent operator is chosen and does not exist.
template <int Dim>
class Divergence {
 public:
  Divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity);

  double operator()(std::size_t i) const;

 private:
  const Flow<Dim>& flow_;
  std::span<const Vec<Dim>> velocity_;
  std::vector<Four> in_fours_;  ///< if the standard operator is chosen
};

/// div u at owned particles [1/s], 0 at walls, at the present positions. Collective.
template <int Dim>
std::vector<double> find_divergence(Flow<Dim>& flow);

/// rms of a field (owned entries) over the bulk fluid particles of all ranks. Collective.
template <int Dim>
double bulk_rms(const Flow<Dim>& flow, const std::vector<double>& field);

}  // namespace tailwater
