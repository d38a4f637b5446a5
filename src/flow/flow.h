// A flow, grouped by lifetime: the setup, which does not change; the state, which a checkpoint saves; tools, which keep
// memory between steps and can be rebuilt; and data of the present positions. Work fields of one step are values that
// its stages pass to each other (stages.h).
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <utility>
#include <vector>

#include "base/box.h"
#include "closures/surroundings.h"
#include "flow/part.h"
#include "flow/pores.h"
#include "flow/role.h"
#include "flow/setup.h"
#include "flow/state.h"
#include "linear/linear_solver.h"
#include "linear/linear_system.h"
#include "neighbours/neighbourhood.h"
#include "particles/wall_forces.h"
#include "walls/walls.h"

namespace tailwater {

template <int Dim>
class Decomposition;
template <int Dim>
class NearWalls;
template <int Dim>
class SharedRows;

template <int Dim>
struct Flow {
  /// Builds the particles, walls and parts of a case (published/make_flow.h). Each rank keeps its fraction of the
  /// particles and of the rows of walls; all ranks have the faces of all walls. Collective. Throws InputError for an
  /// impossible geometry.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks);

  Setup<Dim> setup;
  State<Dim> state;
  std::vector<std::unique_ptr<Part<Dim>>> parts;  ///< the parts of the case, in the order of their calls
  const Pores<Dim>* pores = nullptr;              ///< belongs to one of the parts; null: water can fill all of space

  // Tools.
  std::unique_ptr<Decomposition<Dim>> decomposition;
  Neighbourhood<Dim> neighbourhood;
  LinearSystem pressure_rows;  ///< whose workspace the pair vectors use first
  LinearSolver pressure_solver;

  // Data of the present positions.
  Walls<Dim> walls;                              ///< at their present positions
  std::unique_ptr<SharedRows<Dim>> shared_rows;  ///< locates other rows, if there are other ranks
  std::unique_ptr<NearWalls<Dim>> near_walls;    ///< the rows that have particles
  Surroundings<Dim> surroundings;                ///< as computed by `locate`
  bool is_located = false;                       ///< whether no particle has moved since `locate`
  bool has_matrix = false;                       ///< whether a second projection has left the matrix of these positions
  WallForces<Dim> wall_forces;                   ///< of the last step; empty if neither a probe nor a part needs them
  std::vector<Role> role;                        ///< of owned particles in this step
  std::vector<Vec<Dim>>
      wall_turn_acceleration;  ///< m/s^2; of water along walls that turn, for owned particles; or empty

  /// Builds a case whose walls and water have already been made.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks, Drawing<Dim> drawing);
  ~Flow();

  /// The part of type P; an empty one if the case has none.
  template <class P>
  const P& part() const {
    for (const auto& any : parts) {
      if (const auto* const found = dynamic_cast<const P*>(any.get())) return *found;
    }
    static const P none;
    return none;
  }
  template <class P>
  P& part() {
    return const_cast<P&>(std::as_const(*this).template part<P>());
  }
  /// Whether water can leave or enter the domain.
  bool is_open() const {
    return std::ranges::any_of(parts, [](const auto& part) { return part->is_open(); });
  }
  /// Whether the matrix of a second projection serves the next step's first one too.
  bool keeps_matrix() const {
    return setup.formulation.has_second_projection &&
           std::ranges::none_of(parts, [](const auto& part) { return part->changes_rows(); });
  }

  /// Frees the matrix of the pressure equation and the solver's data derived from it.
  void forget_matrix() {
    has_matrix = false;
    pressure_solver.forget();
    pressure_rows.forget_weights();
  }

  /// Saves the state and that of the parts for `restore`. Reuses the memory of `saved`.
  void save(SavedFlow<Dim>& saved) const;
  /// Continues from a saved flow of the same case. Returns false if its parts belong to another case. Collective.
  bool restore(SavedFlow<Dim> saved);

  const Pairs<Dim>& pairs() const { return neighbourhood.pairs(); }
  const Halo<Dim>& halo() const { return neighbourhood.halo(); }
  Discretisation<Dim>& discretisation() const { return *setup.formulation.discretisation; }
  const WallModel<Dim>& wall_model() const { return *setup.formulation.walls; }
  WallScene<Dim> wall_scene() const { return {pairs(), state.particles, walls, surroundings}; }

  WallForce<Dim> wall_force(std::span<const Vec<Dim>> acceleration) const {
    return {setup.liquid.density, setup.gravity, acceleration, wall_turn_acceleration};
  }

  /// kg/m^3; of fluid particle i.
  double density_of(std::size_t i) const {
    const ParticleLiquids& liquids = setup.liquids;
    return liquids.are_several() ? liquids.density[liquids.of(state.particles.id[i])] : setup.liquid.density;
  }
  /// Whether statistics of the bulk include particle i.
  bool is_inside(std::size_t i) const { return role[i] == Role::water && surroundings.interior[i] > 0.5; }
  /// m^Dim; volume of water of particle i: its volume, except where grains take part of it.
  double water_volume_of(std::size_t i) const {
    const double volume = state.particles.volume[i];
    return pores == nullptr ? volume : volume * pores->at(state.particles.position[i]).fraction;
  }
  /// m/s; of all particles: discharge over area, which equals the velocity where water can fill all of space.
  std::vector<Vec<Dim>> filter_velocity() const;
  /// Sums over a full lattice of particles like particle i.
  LatticeSums lattice_of(std::size_t i) const;
  double kinetic_energy_of(std::size_t i) const {
    const double energy = 0.5 * density_of(i) * state.particles.volume[i] * state.particles.velocity[i].squaredNorm();
    if (pores == nullptr) return energy;
    const PoreSpace space = pores->at(state.particles.position[i]);
    return space.fraction * space.inertia * energy;
  }
  /// The box around all walls at their present positions and the edges of the case that parts define; empty if there is
  /// nothing.
  Box<Dim> box() const;
  /// J; relative to the origin; periodic directions do not contribute.
  double potential_energy_of(std::size_t i) const {
    return -density_of(i) * water_volume_of(i) * setup.gravity_across().dot(state.particles.position[i]);
  }
};

}  // namespace tailwater
