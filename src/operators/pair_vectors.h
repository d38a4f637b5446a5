// Pair vectors: the weights of a pair of particles in gradient and divergence.
//
//   grad p_i = sum_j w_j (p_i + p_j) a_ij          (gradient_conservative.h)
//   div u_i  = sum_j w_j (u_j - u_i) . a_ij        (divergence.h)
//
// Any a_ij = -a_ji conserves momentum, and makes gradient and divergence negative adjoints of each other: the pressure
// of a divergence-free velocity does no work. The kernel's gradient, a_ij = dW e_ij, is the usual choice. It scales
// linear fields by the first moment M_i = sum_j w_j r (-dW) e e, which is not I on a strained or disordered set: water
// then acts on waves like an elastic medium. Better vectors with the same two properties are
//
//   a_ij = -F [ (B_i + B_j)/2 d_ij - (l_i - l_j) ],    d_ij = r_i - r_j,  F = -(dW/dr)/r
//
//   B_i    corrects the first moment: B_i = <M>_i^-1 inside, I at the surface and at walls, blended by `interior`. The
//          mean <M> over the neighbours follows the strain of the set. M of single particles is not used: the force of
//          a uniform pressure would have a curl from particle to particle, which drives rolls in water at rest.
//   l_i    closes half of the faces. A uniform pressure p has the force -2 p sum_j w_j a_ij, which orders the particles
//          and hinders the flow. A graph Laplacian, sum_j w_j F_ij (l_i - l_j) = -1/2 sum_j w_j a_ij, removes half of
//          it (the idea of Trask, Bochev & Perego 2020). `closing_sweeps` Jacobi sweeps solve it sufficiently: they
//          remove variations from particle to particle. The row is divided by `interior`, so l is 0 at the surface.
//
// This is the reach `inside`. The outermost rows then behave like an elastic skin. The reach `surface` corrects them
// too:
//
//   B_i    tends to T_i = lambda_min M_i^-1 at the surface, so that B_i M_i is isotropic and a stretched surface is not
//          treated as compressed. Across the surface the kernel's gradient stays, which fits the air (robust/rows.cpp).
//   l_i    at the surface makes the force of a uniform pressure that of the kernel's gradients, which has a potential,
//          sum_j w_j a_ij -> sum_j w_j dW e_ij. Otherwise water at rest would roll. `interior` blends both equations.
//
// The corrections are continuous in the positions and need no surface detection. docs/theory/operators.md derives them,
// with their exactness and the effect of each.
//
// Only B and l are stored, per particle. A pair vector is computed from the data of its two ends where needed: an array
// with an entry per pair would be the largest of all.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "neighbours/pair_lanes.h"
#include "operators/symmetric.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
struct Halo;
template <int Dim>
struct SupportTerms;

/// Region in which pair vectors are corrected.
enum class CorrectionReach { inside, surface };

/// Number of sweeps for the equation for l.
constexpr int closing_sweeps(CorrectionReach reach) { return reach == CorrectionReach::inside ? 3 : 10; }

/// Input of the corrections. All arrays have an entry per particle, ghosts included and up to date.
template <int Dim>
struct CorrectionInput {
  double radius;                               ///< m; of the support at the case's spacing
  std::span<const double> volume;              ///< m^Dim
  std::span<const ParticleKind> kind;          ///< only fluid has an l
  std::span<const double> interior;            ///< 0 at the surface and at walls, 1 inside
  std::span<const Packed<Dim>> first_moment;   ///< M; I at walls
  const SupportTerms<Dim>* support = nullptr;  ///< null: all particles have one spacing
};

/// Data of a particle for its pair vectors, stored together so that a loop reads a neighbour in one place.
template <int Dim>
struct alignas(Dim == 2 ? 32 : 64) PairVectorEnd {
  std::array<std::uint32_t, Dim> at;                  ///< as in Place
  float signed_volume;                                ///< as in Place
  std::array<float, Dim> l;                           ///< m
  std::array<float, symmetric_size<Dim>> correction;  ///< B, packed
};

/// Data of several pairs of a particle.
template <int Dim>
struct PairVectorLanes {
  PlaceLanes<Dim> place;
  Lanes F;          ///< 1/m^(Dim+2); of the kernel
  VecLanes<Dim> a;  ///< 1/m^(Dim+1); the pair vectors
};

template <int Dim>
struct PairVectorField {
  std::vector<PairVectorEnd<Dim>> ends;  ///< of all particles, ghosts included

  template <bool is_full, bool is_graded>
  [[gnu::always_inline]] PairVectorLanes<Dim> operator()(const PairBatch<Dim, is_full, is_graded>& batch) const {
    using End = PairVectorEnd<Dim>;
    static_assert(offsetof(End, at) == offsetof(Place<Dim>, at) &&
                  offsetof(End, signed_volume) == offsetof(Place<Dim>, signed_volume));
    constexpr std::size_t l = offsetof(End, l) / sizeof(float);
    constexpr std::size_t correction = offsetof(End, correction) / sizeof(float);
    const auto other = batch.j.numbers(ends.data());
    const End& own = ends[batch.i];
    PairVectorLanes<Dim> pair{batch.place_of(other), {}, {}};
    pair.F = batch.F(pair.place.d);
    SymmetricLanes<Dim> corrections;
    for (int n = 0; n < symmetric_size<Dim>; ++n) corrections.packed[n] = own.correction[n] + other[correction + n];
    const VecLanes<Dim> corrected = corrections.times(pair.place.d);
    for (int a = 0; a < Dim; ++a) pair.a.at[a] = -pair.F * (0.5F * corrected.at[a] - (own.l[a] - other[l + a]));
    return pair;
  }

  /// a_ij of pair k of particle i.
  Vec<Dim> at(const Pairs<Dim>& pairs, std::size_t i, std::size_t k) const {
    const VecLanes<Dim> a = with_one_pair(pairs, i, k, [this](const auto& pair) { return (*this)(pair).a; });
    return Vec<Dim>::NullaryExpr([&a](int n) { return a.at[n][0]; });
  }
};

/// The kernel's gradient at i, dW e_ij, for every pair.
template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, PairVectorField<Dim>& pair_vectors);

/// Computes the corrected vectors with `sweeps` sweeps. `open_faces` receives the remaining sum_j w_j a_ij [1/m] of
/// each owned particle; with the reach `inside` it is 0 where `interior` is 0. `mean_interior` receives the
/// kernel-weighted mean of `interior` over the fluid neighbours, where `interior` is not 0. `room` is a workspace with
/// an entry per pair. Collective.
template <int Dim>
void find_corrected_pair_vectors(const Pairs<Dim>& pairs, const Halo<Dim>& halo, const CorrectionInput<Dim>& input,
                                 CorrectionReach reach, int sweeps, std::span<float> room,
                                 PairVectorField<Dim>& pair_vectors, std::vector<Vec<Dim>>& open_faces,
                                 std::span<double> mean_interior);

}  // namespace tailwater
