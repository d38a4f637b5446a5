// Interface between walls and water. A wall model represents the walls by particles of its own. It determines three of
// their properties: the velocity that they show to the water, their rows of the pressure equation, and their pressure.
// Each model is one file, the dummies in this module and those of the papers in `published`. No module depends on the
// choice. The loops run over wall particles only and are dispatched once per loop.
#pragma once

#include <span>
#include <vector>

#include "closures/surroundings.h"
#include "geometry/boundary.h"
#include "linear/linear_system.h"
#include "neighbours/neighbourhood.h"
#include "particles/particles.h"
#include "sampling/wall_particles.h"

namespace tailwater {

/// The walls of a case at their present positions. The table begins with the rows of walls that move, on all ranks.
/// Then come the rows of walls at rest that this rank keeps, and the halo rows (shared_rows.h). The first two groups
/// are in order of their numbers.
template <int Dim>
struct Walls {
  Boundary<Dim> boundary;              ///< faces
  WallParticles<Dim> particles;        ///< the table that Particles::wall_row points into
  std::vector<double> friction;        ///< lambda of each row of the table: 0 free slip, 1 no slip
  std::vector<double> roughness;       ///< m; k_s of each row
  std::vector<double> depth;           ///< m; distance of each row behind its wall, where it has friction
  std::vector<Mat<Dim>> curvature;     ///< 1/m; curvature of each row's wall as drawn (turning_walls.h); empty if flat
  std::vector<double> share_of_water;  ///< of the force of a pair; for a force probe, as drawn (facing_walls.h)
  bool is_curved = false;              ///< whether any wall is curved; the same on all ranks
  std::size_t moving = 0;              ///< rows of walls that move
  std::size_t kept = 0;                ///< rows without halo rows
  std::int64_t all = 0;                ///< rows of the case on all ranks

  /// Calls body with references to all fields of the rows.
  template <class Body>
  void apply_to_rows(Body&& body) {
    particles.apply_to_fields([&](auto&... field) {
      if (is_curved) {
        body(field..., friction, roughness, depth, curvature, share_of_water);
      } else {
        body(field..., friction, roughness, depth, share_of_water);
      }
    });
  }
};

/// Entry of a row of the table in a field of the rows of moving walls; 0 for other rows.
template <int Dim>
Vec<Dim> entry_of(std::span<const Vec<Dim>> field, std::int32_t row) {
  return static_cast<std::size_t>(row) < field.size() ? field[row] : Vec<Dim>(Vec<Dim>::Zero());
}

/// Properties of a model that the rest of the step needs.
struct WallTraits {
  WallRows pairs = WallRows::all;  ///< pairs that its particles need

  /// The rows of particles on the wall itself are the fluid's pressure equation.
  bool solves_on_wall = false;
};

/// The water and the walls at the present positions.
template <int Dim>
struct WallScene {
  const Pairs<Dim>& pairs;
  const Particles<Dim>& particles;
  const Walls<Dim>& walls;
  const Surroundings<Dim>& surroundings;
};

/// The body force in the walls' own frame.
template <int Dim>
struct WallForce {
  double density;                          ///< kg/m^3
  Vec<Dim> gravity;                        ///< m/s^2
  std::span<const Vec<Dim>> acceleration;  ///< m/s^2; of each moving row, along the directions that the wall blocks

  std::span<const Vec<Dim>> turning = {};  ///< m/s^2; of the water at each owned wall particle (turning_walls.h)

  /// g - a at a row of the table.
  Vec<Dim> felt(std::int32_t row) const { return gravity - entry_of<Dim>(acceleration, row); }

  /// Excess of the pressure at wall particle i over that at a place from which the particle is d [m] away: rho (g - a)
  /// . d, the hydrostatic difference in the wall's frame. With it the wall row prescribes grad p . n = rho (g - a) . n
  /// (F37).
  double hydrostatic_difference(const Particles<Dim>& particles, std::size_t i, const Vec<Dim>& d) const {
    Vec<Dim> force = felt(particles.wall_row[i]);
    if (i < turning.size()) force -= turning[i];
    return density * force.dot(d);
  }
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
