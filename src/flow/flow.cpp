#include "flow/flow.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "base/assert.h"
#include "base/box.h"
#include "base/for_each.h"
#include "case/spec.h"
#include "flow/distribution.h"
#include "flow/drawing.h"
#include "flow/pores.h"
#include "flow/pressure_equation.h"
#include "flow/saved_flow.h"
#include "flow/stages.h"
#include "flow/wall_particle.h"
#include "geometry/opening.h"
#include "linear/solver_choice.h"
#include "motion/wall_motion.h"
#include "neighbours/neighbourhood.h"
#include "operators/graded_sums.h"
#include "walls/patches.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// [dx]; margin of neighbour lists beyond the support. Half of it is the distance that the fastest particle moves in a
/// step, so a list lasts for about one step with all passes of the implicit iteration. Wider lists cost more at each
/// evaluation than they save in searches (docs/theory/neighbours.md).
constexpr double skin_over_spacing = 0.6;

/// Distance [m] within which water interacts with walls, including its motion in a step. If rows of walls form pairs
/// with each other, they also need the walls around those in reach of the water.
template <int Dim>
double reach_of_walls(const Setup<Dim>& setup) {
  const double supports = setup.formulation.walls->traits().pairs == WallRows::all ? 2.0 : 1.0;
  return supports * kernel_radius(setup.scale.kernel) + setup.scale.spacing;
}

/// Makes equal numbers of particles on each rank, wherever they are: first its part of the fluid, then of the moving
/// walls; the particles of other walls follow later. Ids are in the order of the fluid and of the walls' numbers.
template <int Dim>
Particles<Dim> make_particles(const Setup<Dim>& setup, const FluidParticles<Dim>& fluid, const Walls<Dim>& walls) {
  const auto fluid_count = static_cast<std::size_t>(fluid.all);
  const auto ranks = static_cast<std::size_t>(setup.ranks.size());
  const auto rank = static_cast<std::size_t>(setup.ranks.rank());
  const std::size_t all = fluid_count + walls.moving;
  const std::size_t first = all * rank / ranks;
  TAILWATER_ASSERT(fluid.position.empty() || static_cast<std::size_t>(fluid.first) == first,
                   "the water is distributed as all particles are");
  const std::size_t first_wall = std::max(first, fluid_count);
  const std::size_t end = std::max(all * (rank + 1) / ranks, first_wall);
  const std::size_t own_fluid = fluid.position.size();
  Particles<Dim> particles;
  particles.add(own_fluid + end - first_wall, [&](std::size_t i) -> NewParticle<Dim> {
    if (i >= own_fluid) return wall_particle(setup, walls.particles, first_wall - fluid_count + i - own_fluid);
    return {
        .position = fluid.position[i], .velocity = fluid.velocity[i], .volume = fluid.volume[i], .id = fluid.id_of(i)};
  });
  return particles;
}

template <int Dim>
std::vector<std::unique_ptr<Part<Dim>>> make_parts(const CaseSpec& spec, const Setup<Dim>& setup,
                                                   const Boundary<Dim>& boundary,
                                                   std::span<const PartMaker<Dim>> makers) {
  std::vector<std::unique_ptr<Part<Dim>>> parts;
  for (const PartMaker<Dim> make : makers) {
    if (std::unique_ptr<Part<Dim>> part = make(spec, setup, boundary)) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

template <int Dim>
Flow<Dim>::Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
                const Communicator& ranks)
    : Flow(spec, formulation, makers, ranks, Drawing<Dim>(spec, *formulation.walls, ranks)) {}

template <int Dim>
Flow<Dim>::Flow(const CaseSpec& spec, const FlowFormulation<Dim>& formulation, std::span<const PartMaker<Dim>> makers,
                const Communicator& ranks, Drawing<Dim> drawing)
    : setup(spec, formulation, ranks, drawing),
      parts(make_parts(spec, setup, drawing.walls.boundary, makers)),
      distribution(std::make_unique<Distribution<Dim>>(
          Distribution<Dim>{.decomposition = {ranks, spec.parallel},
                            .shared_rows = std::move(drawing.shared_rows),
                            .near_walls = {ranks, drawing.walls, setup.domain, reach_of_walls(setup)}})),
      neighbourhood(std::make_unique<Neighbourhood<Dim>>(
          setup.scale.kernel, setup.scale.spacing, skin_over_spacing * setup.scale.spacing,
          setup.formulation.walls->traits().pairs, setup.domain, ranks, drawing.spacing_field)),
      equation(std::make_unique<PressureEquation>(
          ranks, spec.pressure_solver,
          SystemTraits{.rows_deep = largest_depth(spec, drawing.fluid) / setup.scale.spacing,
                       .dimension = Dim,
                       .solves = keeps_matrix() ? 3 : 2})),
      walls(std::move(drawing.walls)) {
  Particles<Dim>& particles = state.particles;
  particles = make_particles(setup, drawing.fluid, walls);
  drawing.fluid = {};
  distribution->decomposition.repartition(particles, neighbourhood->work(particles));
  state.wall_velocity.assign(walls.moving, Vec<Dim>::Zero());
  state.motion = initial_motion<Dim>(spec);
  setup.wall_motion->get_velocity(0.0, state.motion, state.wall_velocity);
  equation->rows.set_constant_is_free(setup.is_closed);
  walls.forces.pressure_is_requested = has_force_probe(spec);
  if (has_force_probe(spec) || (setup.formulation.balanced_ramp != nullptr && setup.wall_motion->has_paths())) {
    walls.patches = std::make_shared<PatchesOfWalls<Dim>>(spec, walls);
  }
  walls.forces.are_requested =
      has_force_probe(spec) || std::ranges::any_of(parts, [](const auto& part) { return part->needs_wall_forces(); });
  regather_walls(*this);
  assign_roles(*this);
  for (const auto& part : parts) part->begin(*this);
}

template <int Dim>
Flow<Dim>::~Flow() = default;

template <int Dim>
void Flow<Dim>::save(SavedFlow<Dim>& saved) const {
  saved.state = state;
  saved.parts = Json::object();
  for (const auto& part : parts) {
    if (Json of_part = part->save(); !of_part.is_null()) saved.parts[std::string(part->name())] = std::move(of_part);
  }
}

template <int Dim>
bool Flow<Dim>::restore(SavedFlow<Dim> saved) {
  try {
    for (const auto& part : parts) {
      if (!part->restore(saved.parts.value(std::string(part->name()), Json()))) return false;
    }
  } catch (const Json::exception&) {
    return false;
  }
  state = std::move(saved.state);
  neighbourhood->forget(state.particles);
  surroundings = {};
  [[maybe_unused]] const bool are_found =
      distribution->shared_rows.find_rows(walls, state.particles, 0, setup.first_wall_id);
  TAILWATER_ASSERT(are_found, "the state is of this case");
  // Same state as after a repartition, so that a resumed run requests the same rows as an uninterrupted one.
  distribution->shared_rows.drop_halo_rows(walls, state.particles);
  distribution->near_walls.restore(walls, state.particles);
  assign_roles(*this);
  place_walls(*this, state.time);
  return true;
}

template <int Dim>
const Pairs<Dim>& Flow<Dim>::pairs() const {
  return neighbourhood->pairs();
}

template <int Dim>
const Halo<Dim>& Flow<Dim>::halo() const {
  return neighbourhood->halo();
}

template <int Dim>
std::vector<Vec<Dim>> Flow<Dim>::filter_velocity() const {
  const Particles<Dim>& particles = state.particles;
  std::vector<Vec<Dim>> velocity = particles.velocity;
  for_each(pores == nullptr ? 0 : velocity.size(), [&](std::size_t i) {
    if (particles.is_fluid(i)) velocity[i] *= pores->at(particles.position[i]).fraction;
  });
  return velocity;
}

template <int Dim>
double Flow<Dim>::filled_fraction_at(std::size_t i) const {
  return pores->at(state.particles.position[i]).fraction;
}

template <int Dim>
double Flow<Dim>::inertia_fraction_at(std::size_t i) const {
  const PoreSpace space = pores->at(state.particles.position[i]);
  return space.fraction * space.inertia;
}

template <int Dim>
LatticeSums Flow<Dim>::lattice_of(std::size_t i) const {
  if (setup.graded != nullptr) {
    return setup.graded->lattice(pairs().relative_spacing_of(i), state.particles.volume[i]);
  }
  return pores == nullptr ? setup.scale.lattice : pores->lattice_of(state.particles.volume[i]);
}

template <int Dim>
Box<Dim> Flow<Dim>::box() const {
  Box<Dim> box = box_around(walls.boundary.faces);
  for (const auto& part : parts) part->extend_box(box);
  return box;
}

template struct Flow<2>;
template struct Flow<3>;

}  // namespace tailwater
