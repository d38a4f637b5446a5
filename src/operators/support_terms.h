// Terms of divergence and gradient where supports vary with the place. The filled fraction of space at a particle is
//
//   g_i = C_i/c_i,    C_i = w_i W(0, s_i) + sum_j w_j W(r_ij, (s_i + s_j)/2),    c_i = C_0(s_i, w_i) C*(x_i)
//
// (graded_sums.h). Where the relative support s varies, g_i changes as well because the particles change their
// supports and because c varies. With these terms the divergence is -dg_i/dt, and the gradient is its adjoint:
//
//   div u_i  = (1/c_i) { sum_j w_j (u_j - u_i) . (a_ij - Q_ij G_j) - delta_i . (u_i - U) - s_i . U }
//   grad p_i = sum_j w_j { (m_i + m_j) a_ij + Q_ij (m_j G_i - m_i G_j) } + m_i delta_i - <m (delta - s)>
//
//   m_i = p_i/c_i,    G_i = grad s_i,    Q_ij = (1/2) dW/ds
//   delta_i = sum_j w_j Q_ij (G_i + G_j) + w_i dW(0, s_i)/ds G_i - C_i grad ln c_i
//
// With a_ij = dW e_ij a particle that goes around through a border therefore gathers no false change of volume, on
// which the pressure would do work. In a continuum delta is 0 inside, and s near a surface, which cuts larger supports
// more. On a set of particles delta - s is the error of this sum. U is the mean velocity of the water in the border,
// <m ...> the mean over the same water by volume: water that flows through a border as a whole does not see that error,
// the two operators stay adjoint, and the momentum is exact inside.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/vec.h"
#include "operators/symmetric.h"

namespace tailwater {

template <int Dim>
class ContinuumTable;

/// The contribution of a particle to these terms, in one piece, so that a neighbour is read in one place.
struct alignas(16) SupportEnd {
  std::array<float, 3> slope{};    ///< 1/m; G
  float inverse_reference = 1.0F;  ///< C_0 of the case's lattice over c
};

/// The terms of all particles. Those of ghosts are computed from places and volumes, like those of owned particles.
template <int Dim>
struct SupportTerms {
  std::vector<SupportEnd> ends;           ///< of all particles; empty: all have one spacing
  std::vector<double> reference;          ///< c of all particles
  std::vector<Packed<Dim>> first_moment;  ///< M* of all particles
  std::vector<std::int32_t> border;       ///< of all particles: the zone whose border is near; -1: none
  std::vector<double> kept_correction;    ///< of owned particles: applied fraction of the correction by <M>
  std::vector<Vec<Dim>> log_slope;        ///< 1/m; of owned particles: grad ln c
  std::vector<Vec<Dim>> crowding;         ///< 1/m; of owned particles: gradient of C in a continuum
  std::vector<Vec<Dim>> delta;            ///< 1/m; of owned particles
  std::vector<Vec<Dim>> faces;            ///< 1/m; of owned particles: these terms in half of the gradient of p = 1
  std::shared_ptr<ContinuumTable<Dim>> continuum;  ///< kept for speed

  bool is_empty() const { return ends.empty(); }
  /// Whether supports vary within that of particle i.
  bool is_near_border(std::size_t i) const { return !ends.empty() && border[i] >= 0; }
};

}  // namespace tailwater
