// What wall models share whose particles stand on the wall itself: nothing goes through it.
//
//   velocity   u_w = V + (1 - lambda) (I - M) (mean_w - V), which carries the wall's friction lambda
//
// V is the wall's own velocity, M the projector on the directions the wall blocks, mean_w the Shepard mean of the fluid
// in reach.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
class OnWall : public WallModel<Dim> {
 public:
  void show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                     std::span<Vec<Dim>> velocity) const final;

  /// The wall's own.
  void find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                             std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> no_slip) const final;

  /// Their pressure is what their rows said.
  bool follow_pressure(const WallScene<Dim>&, const WallForce<Dim>&, std::span<double>) const final { return false; }
};

}  // namespace tailwater
