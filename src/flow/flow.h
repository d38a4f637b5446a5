// A flow by lifetime: the setup, which does not change; the state, which a checkpoint saves; tools, which keep memory
// between steps and can be rebuilt; and what is known about the present positions. Work fields of one step are values
// that its stages pass to each other (stages.h).
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
#include "neighbours/decomposition.h"
#include "neighbours/neighbourhood.h"
#include "particles/wall_forces.h"
#include "walls/near_walls.h"

namespace tailwater {

template <int Dim>
struct Flow {
  /// Builds the particles, walls and parts of a case (published/make_flow.h). Each rank keeps its share of the
  /// particles and of the rows of walls; all ranks have the faces of all walls. Collective. Throws InputError for an
  /// impossible geometry.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks);

  Setup<Dim> setup;
  State<Dim> state;
  std::vector<std::unique_ptr<Part<Dim>>> parts;  ///< those that the case has, in the order of their calls
  const Pores<Dim>* pores = nullptr;              ///< of one of them; null: water can fill all of space

  // Tools.
  Decomposition<Dim> decomposition;
  Neighbourhood<Dim> neighbourhood;
  std::shared_ptr<PairWorkspace> pair_workspace;  ///< of the pair vectors, then of the weights of `pressure_rows`
  LinearSystem pressure_rows;
  LinearSolver pressure_solver;

  // Now.
  Walls<Dim> walls;                ///< at their present positions
  SharedRows<Dim> shared_rows;     ///< where other rows are, if there are other ranks
  NearWalls<Dim> near_walls;       ///< which rows are among the particles
  Surroundings<Dim> surroundings;  ///< as `locate` found them
  bool is_located = false;         ///< whether no particle has moved since
  bool has_matrix = false;         ///< whether a second projection has left the matrix of these positions
  WallForces<Dim> wall_forces;     ///< of the last step; empty if no probe asks for them
  std::vector<Role> role;          ///< of owned particles in this step
  std::vector<Vec<Dim>>
      wall_turn_acceleration;  ///< m/s^2; of water along walls that turn, for owned particles; or empty

  /// Builds a case that is already drawn.
  Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
       const Communicator& ranks, Drawing<Dim> drawing);

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

  /// Frees the matrix of the pressure equation and what solvers have made of it.
  void forget_matrix() {
    has_matrix = false;
    pressure_solver.forget();
    pressure_rows.forget_weights();
  }

  /// Saves the state and that of the parts, from which `restore` goes on. Uses the memory of what was saved before.
  void save(SavedFlow<Dim>& saved) const;
  /// Continues from a saved flow of the same case. Returns false if its parts are of another one. Collective.
  bool restore(SavedFlow<Dim> saved);

  const Pairs<Dim>& pairs() const { return neighbourhood.pairs(); }
  const Halo<Dim>& halo() const { return neighbourhood.halo(); }
  Discretisation<Dim>& discretisation() const { return *setup.formulation.discretisation; }
  const WallModel<Dim>& wall_model() const { return *setup.formulation.walls; }
  WallScene<Dim> wall_scene() const { return {pairs(), state.particles, walls, surroundings}; }

  WallForce<Dim> wall_force(std::span<const Vec<Dim>> acceleration) const {
    return {setup.liquid.density, setup.gravity, acceleration, wall_turn_acceleration};
  }

  /// Whether statistics of the bulk count particle i.
  bool is_inside(std::size_t i) const { return role[i] == Role::water && surroundings.interior[i] > 0.5; }
  /// m^Dim; of the water of particle i, which is its volume unless it shares it with grains.
  double water_volume_of(std::size_t i) const {
    const double volume = state.particles.volume[i];
    return pores == nullptr ? volume : volume * pores->at(state.particles.position[i]).fraction;
  }
  /// m/s; of all particles: discharge over area, which is the velocity where water can fill all of space.
  std::vector<Vec<Dim>> filter_velocity() const;
  /// Sums over a full lattice of particles like particle i.
  LatticeSums lattice_of(std::size_t i) const {
    if (setup.graded != nullptr) {
      return setup.graded->lattice(pairs().relative_spacing_of(i), state.particles.volume[i]);
    }
    return pores == nullptr ? setup.scale.lattice : pores->lattice_of(state.particles.volume[i]);
  }
  double kinetic_energy_of(std::size_t i) const {
    const double energy =
        0.5 * setup.liquid.density * state.particles.volume[i] * state.particles.velocity[i].squaredNorm();
    if (pores == nullptr) return energy;
    const PoreSpace space = pores->at(state.particles.position[i]);
    return space.fraction * space.inertia * energy;
  }
  /// The box around all walls, where they are now, and what parts have of the case's edges; empty if there is nothing.
  Box<Dim> box() const;
  /// Relative to the origin; there is none along periodic directions.
  double potential_energy_of(std::size_t i) const {
    return -setup.liquid.density * water_volume_of(i) * setup.gravity_across.dot(state.particles.position[i]);
  }
};

}  // namespace tailwater
