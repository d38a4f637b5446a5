// Common base of the wall models whose particles stand on the wall itself. Nothing flows through the wall.
//
//   velocity   u_w = V + (1 - lambda) (I - M) (mean_w - V), which includes the wall's friction lambda
//
// V is the wall's own velocity, M the projector onto the directions the wall blocks, mean_w the Shepard mean of the
// fluid in reach.
#pragma once

#include "walls/wall_model.h"

namespace tailwater {

template <int Dim>
class OnWall : public WallModel<Dim> {
 public:
  void show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                     std::span<Vec<Dim>> velocity) const final;

  /// The wall's own velocity.
  void find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                             std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> no_slip) const final;

  /// Bodies do not float with these models, because a part of the wall's effect is in the prediction, or in the
  /// weights.
  void set_sources(const WallScene<Dim>&, const WallForce<Dim>&, LinearSystem&) const final {}

  /// No pressure is set: the particles keep the pressure of their rows.
  bool follow_pressure(const WallScene<Dim>&, const WallForce<Dim>&, std::span<double>) const final { return false; }
};

}  // namespace tailwater
