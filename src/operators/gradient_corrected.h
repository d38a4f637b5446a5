// First derivative with the corrected kernel gradient (Randles & Libersky 1996; Bonet & Lok 1999):
//
//   grad v_i = [ sum_j w_j (v_j - v_i) dW e_ij ] . L_i,    L_i = M_i^-1,   M_i of concentration.h
//
// Exact for linear fields where the neighbours span space. M is I on a full lattice and has the eigenvalue 1/2 across a
// flat surface. Where its smallest eigenvalue falls below 0.5 the correction decreases, and below 0.3 (spray) there is
// none; the uncorrected derivative is then too small rather than too large. Continuous in the positions.
#pragma once

#include <algorithm>
#include <span>

#include "neighbours/pair_lanes.h"
#include "operators/symmetric.h"

namespace tailwater {

/// Fraction of the correction that is applied where M has this smallest eigenvalue.
inline double correction_share(double min_eigenvalue_M) { return std::clamp((min_eigenvalue_M - 0.3) / 0.2, 0.0, 1.0); }

/// Fraction of the correction for M. Inside the water the bound of the eigenvalue by Gershgorin's circles suffices for
/// 1.
template <int Dim>
double share_of_correction(const Mat<Dim>& first_moment) {
  const Vec<Dim> off_diagonal = first_moment.cwiseAbs() * Vec<Dim>::Ones() - first_moment.diagonal().cwiseAbs();
  const double min_possible = (first_moment.diagonal() - off_diagonal).minCoeff();
  if (correction_share(min_possible) == 1.0) return 1.0;
  return correction_share(min_eigenvalue<Dim>(first_moment));
}

/// A sum over pairs with the fraction `share` of the correction by M.
template <int Dim>
Mat<Dim> corrected(const Mat<Dim>& sum, const Mat<Dim>& M, double share) {
  if (share == 0.0) return sum;
  return sum * (share * M.inverse() + (1.0 - share) * Mat<Dim>::Identity());
}

/// Gradient of a vector at particle i [1/s for a velocity]: result(a, b) = d field_a / d x_b. `first_moment` is M_i.
template <int Dim>
Mat<Dim> corrected_gradient(const Pairs<Dim>& pairs, std::size_t i, const Mat<Dim>& first_moment,
                            std::span<const Float4> field) {
  MatLanes<Dim> sums{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = place.volume() * batch.F(place.d);
    const VecLanes<Dim> difference = batch.of(field) - field[i];
    for (int b = 0; b < Dim; ++b) sums.column[b] -= weight * place.d.at[b] * difference;
  });
  return corrected<Dim>(sum_of(sums), first_moment, share_of_correction<Dim>(first_moment));
}

/// Gradient as above over neighbours with these volumes, with M of the same sum, and so exact for linear fields. M has
/// the eigenvalue 1/2 across a wall or a surface; the correction is full from 0.25 on, and there is none below 0.1 (a
/// single row).
template <int Dim, class Volume>
Mat<Dim> gradient_over(const Pairs<Dim>& pairs, std::size_t i, std::span<const Float4> field, Volume&& volume) {
  MatLanes<Dim> sums{};
  MatLanes<Dim> moments{};
  for_each_pair(pairs, i, [&](const auto& batch) {
    const PlaceLanes<Dim> place = batch.place();
    const Lanes weight = volume(batch, place) * batch.F(place.d);
    const VecLanes<Dim> difference = batch.of(field) - field[i];
    for (int b = 0; b < Dim; ++b) {
      sums.column[b] -= weight * place.d.at[b] * difference;
      moments.column[b] += weight * place.d.at[b] * place.d;
    }
  });
  const Mat<Dim> moment = sum_of(moments);
  return corrected<Dim>(sum_of(sums), moment, std::clamp((min_eigenvalue<Dim>(moment) - 0.1) / 0.15, 0.0, 1.0));
}

/// Gradient as above over fluid neighbours alone, for water at a no-slip wall, whose dummies show a slip velocity.
template <int Dim>
Mat<Dim> gradient_in_water(const Pairs<Dim>& pairs, std::size_t i, std::span<const Float4> field) {
  return gradient_over<Dim>(
      pairs, i, field, [](const auto& /*batch*/, const PlaceLanes<Dim>& place) { return place.volume_of_fluid(); });
}

/// Gradient as above over neighbours with the same number as particle i in `liquid`, walls included. For a liquid
/// beside another one, at which its velocity may jump.
template <int Dim>
Mat<Dim> gradient_in_liquid(const Pairs<Dim>& pairs, std::size_t i, std::span<const float> liquid,
                            std::span<const Float4> field) {
  return gradient_over<Dim>(pairs, i, field, [&](const auto& batch, const PlaceLanes<Dim>& place) {
    return batch.of(liquid) == liquid[i] ? place.volume() : Lanes{};
  });
}

}  // namespace tailwater
