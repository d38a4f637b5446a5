// How walls act on the water. A wall model stands for the walls by particles of its own and decides three things about
// them: the velocity they show to the water, their rows of the pressure equation, and which pressure they keep. Each
// model is one file; above this room nothing asks which one was chosen. Its loops run over wall particles only and are
// dispatched once per loop.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "case/choices.h"
#include "closures/surroundings.h"
#include "geometry/boundary.h"
#include "geometry/wall_particles.h"
#include "linear/linear_system.h"
#include "neighbours/neighbourhood.h"
#include "particles/particles.h"

namespace tailwater {

/// The walls of a case where they are now.
template <int Dim>
struct Walls {
  Boundary<Dim> boundary;        ///< faces
  WallParticles<Dim> particles;  ///< the table that Particles::wall_row points into
  std::vector<double> friction;  ///< lambda of each row of the table: 0 free slip, 1 no slip
};

/// What a model tells the rest of the step about itself.
struct WallTraits {
  WallRows pairs = WallRows::all;  ///< which pairs its particles need

  /// The particles on the wall itself have the fluid's pressure equation for their row.
  bool solves_on_wall = false;

  /// Gravity acts in the prediction, as published in both schemes, not in the correction: the wall rows see it, and
  /// the wall's own motion, in the fluid that comes down on them. The other rows ask for grad p . n = rho (g - a) . n,
  /// where gravity in the prediction would count twice.
  bool gravity_in_prediction = false;

  /// The velocity they show to the water carries the wall's friction, so a Laplacian over them needs no other.
  bool shows_friction = true;

  /// Where there is air they may hold a pressure below 0.
  bool pulls = true;

  /// Its rows use the renormalisation tensors.
  bool needs_tensors = false;
};

/// The water at the walls, where everything is now.
template <int Dim>
struct WallScene {
  const Pairs<Dim>& pairs;
  const Particles<Dim>& particles;
  const Walls<Dim>& walls;
  const Surroundings<Dim>& here;
};

/// The body force that walls feel, as seen by themselves.
template <int Dim>
struct WallForce {
  double density;                          ///< kg/m^3
  Vec<Dim> gravity;                        ///< m/s^2
  std::span<const Vec<Dim>> acceleration;  ///< m/s^2; of each row of the table, in the directions the wall blocks

  /// g - a at a row of the table.
  Vec<Dim> felt(std::int32_t row) const { return gravity - acceleration[row]; }

  /// What the pressure at wall particle i exceeds that at its neighbour of pair k by: rho (g - a) . r_ij, hydrostatic
  /// between the two as the wall feels it. With it the wall row asks for grad p . n = rho (g - a) . n (F37).
  double hydrostatic_difference(const Pairs<Dim>& pairs, const Particles<Dim>& particles, std::size_t i,
                                std::size_t k) const {
    return density * pairs.r[k] * felt(particles.wall_row[i]).dot(pairs.e[k]);
  }
};

template <int Dim>
class WallModel {
 public:
  virtual ~WallModel() = default;

  virtual WallTraits traits() const = 0;

  /// The particles that stand for the walls; `layers` rows of them where the model has rows behind the wall.
  virtual WallParticles<Dim> make_particles(const Boundary<Dim>& boundary, double spacing, int layers) const = 0;

  /// Sets the entries of owned wall particles in `velocity` from its fluid entries, which must be up to date on ghosts,
  /// and the walls' own velocity `V` [m/s], one entry per row of the table. Dry wall particles get 0.
  virtual void show_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                             std::span<Vec<Dim>> velocity) const = 0;

  /// For each owned wall particle the velocity [m/s] that water beside it has where it does not slip along the wall.
  /// Arguments as above; `no_slip` has one entry per particle.
  virtual void find_no_slip_velocity(const WallScene<Dim>& scene, std::span<const Vec<Dim>> V,
                                     std::span<const Vec<Dim>> velocity, std::span<Vec<Dim>> no_slip) const = 0;

  /// Writes the rows of owned wall particles, but for those that have the fluid's equation.
  virtual void assemble_rows(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const = 0;

  /// Where there is air and the fluid's pressure has been changed since the solve: sets the pressure of owned wall
  /// particles again. Returns whether the model has anything to set.
  virtual bool follow_pressure(const WallScene<Dim>& scene, const WallForce<Dim>& force,
                               std::span<double> pressure) const = 0;
};

/// The model of that name.
template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_wall_model(WallTreatment name);

}  // namespace tailwater
