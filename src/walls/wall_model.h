// Interface between walls and water. A wall model represents the walls by particles of its own. It determines three of
// their properties: the velocity that they show to the water, their rows of the pressure equation, and their pressure.
// Each model is one file, the dummies in this module and those of the papers in `published`. No module depends on the
// choice. The loops run over wall particles only and are dispatched once per loop.
#pragma once

#include <span>
#include <vector>

#include "closures/surroundings.h"
#include "linear/linear_system.h"
#include "neighbours/pairs.h"
#include "sampling/lattice_axis.h"
#include "walls/walls.h"

namespace tailwater {

struct SpaceShare;

/// Properties of a model that the rest of the step needs.
struct WallTraits {
  WallRows pairs = WallRows::all;  ///< pairs that its particles need

  /// The rows of particles on the wall itself are the fluid's pressure equation.
  bool solves_on_wall = false;
};

template <int Dim>
class WallModel {
 public:
  virtual ~WallModel() = default;

  virtual WallTraits traits() const = 0;

  /// The particles that represent the walls in one part of space (wall_particles.h). A model with rows behind the wall
  /// makes `layers` of them; behind meshes they stand on the nodes of the water's `lattice`.
  virtual WallParticles<Dim> make_particles(const Boundary<Dim>& boundary, double spacing, int layers,
                                            const SpaceShare& share, const Lattice<Dim>& lattice) const = 0;

  /// Sets the entries of owned wall particles in `velocity`. They follow from its fluid entries, which must be up to
  /// date on ghosts, and from the walls' own velocity `V` [m/s], one entry per moving row of the table. Dry wall
  /// particles get 0.
  virtual void show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                             std::span<Vec<Dim>> velocity) const = 0;

  /// Computes the velocity [m/s] of each owned wall particle in the no-slip stress (wall_friction.h). Arguments as
  /// above; `no_slip` has one entry per particle.
  virtual void find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                                     std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> no_slip) const = 0;

  /// Writes the rows of owned wall particles, except those that have the fluid's equation.
  virtual void assemble_rows(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const = 0;

  /// Sets the right-hand sides of these rows again, for another acceleration of the walls; the weights stay. For
  /// floating bodies, which only the dummies support.
  virtual void set_sources(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const = 0;

  /// Sets the pressure of owned wall particles again. Called where there is air, after the fluid's pressure has changed
  /// since the solve. Returns whether the model has set anything.
  virtual bool follow_pressure(const WallScene<Dim>& scene, const WallForce<Dim>& force,
                               std::span<double> pressure) const = 0;
};

}  // namespace tailwater
