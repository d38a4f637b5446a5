// Boundary layers of walls with friction: the eddy viscosity that they give the water (closures/spalart_allmaras.h). It
// and the distance from the walls are fields of the particles.
#pragma once

#include <vector>

#include "flow/part.h"
#include "particles/particles.h"

namespace tailwater {

template <int Dim>
class BoundaryLayers final : public Part<Dim> {
 public:
  std::string_view name() const override { return "boundary_layers"; }
  StepLimits step_limits(const Flow<Dim>& flow) const override;
  void add_viscosity(const Flow<Dim>& flow, std::span<double> viscosity) const override;
  /// The layers are then as they are after dt.
  void follow_friction(Flow<Dim>& flow, std::span<const FrictionWall<Dim>> walls,
                       std::span<const Mat<Dim>> velocity_gradient, double dt) override;
  void stay(Flow<Dim>& flow) override;

 private:
  void swap_with(Particles<Dim>& particles);

  // The layers before the last prediction, ghosts too.
  std::vector<double> viscosity_;      ///< m^2/s; nu~
  std::vector<double> wall_distance_;  ///< m
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_boundary_layers(const CaseSpec& spec, const Setup<Dim>& setup,
                                                const Boundary<Dim>& boundary);

}  // namespace tailwater
