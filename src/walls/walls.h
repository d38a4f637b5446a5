// The walls of a flow, and how they meet the water.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "geometry/boundary.h"
#include "particles/particles.h"
#include "particles/wall_forces.h"
#include "sampling/wall_table.h"

namespace tailwater {

template <int Dim>
struct Pairs;
template <int Dim>
struct Surroundings;
template <int Dim>
class PatchesOfWalls;

/// The walls of a case at their present positions. The table begins with the rows of walls that move, on all ranks.
/// Then come the rows of walls at rest that this rank keeps, and the halo rows (shared_rows.h). The first two groups
/// are in order of their numbers.
template <int Dim>
struct Walls {
  Boundary<Dim> boundary;               ///< faces
  WallParticles<Dim> particles;         ///< the table that Particles::wall_row points into
  std::vector<double> friction;         ///< lambda of each row of the table: 0 free slip, 1 no slip
  std::vector<double> roughness;        ///< m; k_s of each row
  std::vector<double> depth;            ///< m; distance of each row behind its wall, where it has friction
  std::vector<Mat<Dim>> curvature;      ///< 1/m; curvature of each row's wall as drawn (turning_walls.h); empty if flat
  std::vector<Vec<Dim>> normal_in_gap;  ///< of each row's wall in a narrow gap, else 0; as drawn (facing_walls.h)
  bool is_curved = false;               ///< whether any wall is curved; the same on all ranks
  std::size_t moving = 0;               ///< rows of walls that move
  std::size_t kept = 0;                 ///< rows without halo rows
  std::int64_t all = 0;                 ///< rows of the case on all ranks
  WallForces<Dim> forces;               ///< in the last step; empty if neither a probe nor a part needs them
  std::shared_ptr<PatchesOfWalls<Dim>> patches;  ///< null if nothing needs the forces on them
  /// m/s^2; of each row of walls that move, along the directions that it blocks: that of the rows of the last pressure.
  std::vector<Vec<Dim>> acceleration;
  std::vector<Vec<Dim>> turn_acceleration;  ///< m/s^2; of water along walls that turn, of owned particles; or empty

  /// Calls body with references to all fields of the rows.
  template <class Body>
  void apply_to_rows(Body&& body) {
    particles.apply_to_fields([&](auto&... field) {
      if (is_curved) {
        body(field..., friction, roughness, depth, curvature, normal_in_gap);
      } else {
        body(field..., friction, roughness, depth, normal_in_gap);
      }
    });
  }
};

/// Entry of a row of the table in a field of the rows of moving walls; 0 for other rows.
template <int Dim>
Vec<Dim> entry_of(std::span<const Vec<Dim>> field, std::int32_t row) {
  return static_cast<std::size_t>(row) < field.size() ? field[row] : Vec<Dim>(Vec<Dim>::Zero());
}

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

}  // namespace tailwater
