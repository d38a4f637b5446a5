#include "flow/setup.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/for_each.h"
#include "case/formulation.h"
#include "case/rheology.h"
#include "flow/drawing.h"
#include "flow/ids_of_inflow.h"
#include "geometry/ducts.h"
#include "geometry/ending_boxes.h"
#include "geometry/from_spec.h"
#include "motion/channel_end.h"
#include "operators/graded_sums.h"
#include "sampling/duct_water.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"
#include "walls/facing_walls.h"
#include "walls/turning_walls.h"
#include "walls/wall_contact.h"
#include "walls/wall_model.h"

namespace tailwater {
namespace {

/// [dx]; edge of the cubes of space in which each rank makes the walls. Rows around a cube are made as well, and then
/// removed, to decide which rows at its border are free of others.
constexpr double cube_over_spacing = 32.0;

/// The drawn walls, those of ducts, and the rows in this rank's part of space.
template <int Dim>
Walls<Dim> make_walls(const CaseSpec& spec, const WallModel<Dim>& model, const Communicator& ranks,
                      const SpacingField<Dim>& field, Boundary<Dim> drawn) {
  Walls<Dim> walls;
  walls.boundary = std::move(drawn);
  if constexpr (Dim == 3) make_meshes_of_ending_boxes(spec, walls.boundary);
  const Lattice<Dim> lattice = lattice_behind_meshes<Dim>(spec, walls.boundary);
  append_ducts(spec, walls.boundary);
  walls.boundary.file_faces(search_distance * spec.particles.spacing);
  const SpaceShare share{
      .edge = cube_over_spacing * spec.particles.spacing, .share = ranks.rank(), .shares = ranks.size()};
  walls.particles = model.make_particles(walls.boundary, spec.particles.spacing, dummy_layers(spec), share, lattice);
  if (!field.is_uniform()) {
    divide_wall_particles<Dim>(field, walls.boundary, spec.particles.spacing, dummy_layers(spec), share, lattice,
                               walls.particles);
  }
  const double reach = 2.0 * dummy_layers(spec) * spec.particles.spacing;
  for (std::vector<double>* of_rows : {&walls.friction, &walls.roughness, &walls.depth}) {
    of_rows->reserve(walls.particles.size());
  }
  for (std::size_t row = 0; row < walls.particles.size(); ++row) {
    const WallProperties& wall = walls.boundary.walls[walls.particles.wall[row]];
    walls.friction.push_back(wall.friction);
    walls.roughness.push_back(wall.roughness);
    const bool needs_depth = wall.friction > 0.0 || !spec.liquids.empty();  // rheology/viscous_operator.h
    walls.depth.push_back(
        needs_depth ? std::abs(walls.boundary.nearest(walls.particles.position[row], reach).signed_distance) : 0.0);
  }
  walls.normal_in_gap.assign(walls.particles.size(), Vec<Dim>::Zero());
  if (has_force_probe(spec)) {
    const double radius = traits_of(spec).support * spec.particles.spacing;
    for_each(walls.particles.size(), [&](std::size_t row) {
      walls.normal_in_gap[row] = normal_in_gap(walls, row, radius * field.at(walls.particles.position[row]));
    });
  }
  walls.curvature = find_curvature(walls, spec.particles.spacing, reach);
  walls.is_curved = ranks.any(std::ranges::any_of(walls.curvature, [](const Mat<Dim>& S) { return !S.isZero(0.0); }));
  if (!walls.is_curved) std::vector<Mat<Dim>>().swap(walls.curvature);
  return walls;
}

/// The water at the start: that of the case file, and that in ducts. `drawn` are the walls without ducts; it is used
/// only if there are ducts. Collective.
template <int Dim>
FluidParticles<Dim> make_fluid(const CaseSpec& spec, const Walls<Dim>& walls, Boundary<Dim>& drawn,
                               const Communicator& ranks) {
  const auto moving = static_cast<std::int64_t>(walls.moving);
  if (walls.boundary.ducts.empty()) return make_fluid_particles(spec, walls.boundary, ranks, moving);
  drawn.file_faces(walls.boundary.filed_reach());
  FluidParticles<Dim> fluid = make_fluid_particles(spec, drawn, ranks, moving);
  std::vector<WaterParticle<Dim>> in_ducts = water_in_ducts(walls.boundary.ducts, spec.particles.spacing, fluid);
  if (in_ducts.empty()) return fluid;
  if (has_several_liquids(spec)) std::ranges::stable_sort(in_ducts, {}, &WaterParticle<Dim>::block);
  const std::int64_t others = moving + static_cast<std::int64_t>(in_ducts.size());
  if (!ranks.is_alone()) fluid = make_fluid_particles(spec, drawn, ranks, others);
  append_water(in_ducts, others, fluid);
  return fluid;
}

/// Whether water fills a domain that is periodic in every direction, according to the number of its particles. A domain
/// with walls in it is full if no particle lacks neighbours, as in any closed space (pressure/full_water.h).
template <int Dim>
bool fills_domain(const PeriodicDomain<Dim>& domain, const FluidParticles<Dim>& fluid, double spacing) {
  double cells = 1.0;
  for (const auto& range : domain) {
    if (!range) return false;
    cells *= std::round((range->second - range->first) / spacing);
  }
  return static_cast<double>(fluid.all) >= cells;
}

/// Height of the fluid along gravity [m]; its largest extent where there is no gravity. Collective.
template <int Dim>
double fluid_height(const FluidParticles<Dim>& fluid, const Vec<Dim>& gravity, double spacing) {
  if (fluid.all == 0) return 0.0;
  if (gravity.norm() == 0.0) return fluid.box().sizes().maxCoeff() + spacing;
  return fluid.extent_along(gravity.normalized()) + spacing;
}

/// Number of particles in ducts by their blocks, which are in order there. Collective.
template <int Dim>
std::vector<double> count_in_ducts(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  const std::int64_t drawn = std::accumulate(fluid.of_blocks.begin(), fluid.of_blocks.end(), std::int64_t{0});
  std::vector<double> count(spec.fluid.size(), 0.0);
  for (std::size_t i = 0; i < fluid.position.size(); ++i) {
    if (fluid.id_of(i) >= drawn) count[static_cast<std::size_t>(fluid.block[i])] += 1.0;
  }
  fluid.ranks.sum_of_each(count);
  return count;
}

/// The liquids of the particles, if there are several: those of blocks, of ducts, and of inflow, whose ids begin at
/// `first_inflow`. Collective.
template <int Dim>
ParticleLiquids particle_liquids(const CaseSpec& spec, const FluidParticles<Dim>& fluid, const TimeStepRule& rule,
                                 std::int64_t first_inflow) {
  ParticleLiquids liquids;
  if (!has_several_liquids(spec)) return liquids;
  std::int64_t end = 0;
  const auto add = [&](std::int64_t count, int liquid) {
    end += count;
    liquids.end.push_back(end);
    liquids.of_block.push_back(liquid);
  };
  const auto liquid_of_block = [&](std::size_t block) { return index_of_liquid(spec, spec.fluid[block].liquid); };
  for (std::size_t block = 0; block < spec.fluid.size(); ++block) add(fluid.of_blocks[block], liquid_of_block(block));
  const std::size_t ends = spec.inlets.size() + spec.outlets.size();
  if (ends > 0) {
    const std::vector<double> in_ducts = count_in_ducts(spec, fluid);
    for (std::size_t block = 0; block < in_ducts.size(); ++block) {
      add(std::llround(in_ducts[block]), liquid_of_block(block));
    }
    add(first_inflow - end, 0);  // walls
    for (std::size_t range = 0; range < ends * spec.liquids.size(); ++range) {
      add(ids_in_range, static_cast<int>(range % spec.liquids.size()));
    }
  }
  for (const LiquidTable& liquid : spec.liquids) {
    liquids.density.push_back(liquid.density);
    liquids.is_thin.push_back(!varies_with_shear(liquid) && !rule.is_viscous(kinematic_viscosity(liquid)));
  }
  return liquids;
}

/// Height [m] from which water of the inlets falls to the lowest wall, with the velocity head of the inflow. At least a
/// spacing.
template <int Dim>
double height_of_fall(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  constexpr int samples = 100;
  const double spacing = spec.particles.spacing;
  const double g = gravity_of<Dim>(spec).norm();
  double height = spacing;
  if (g == 0.0) return height;
  const Vec<Dim> up = -gravity_of<Dim>(spec) / g;
  for (const ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec)) {
    if (!end.flow.feeds()) continue;
    double fall = 0.0;
    for (const WallFace<Dim>& face : boundary.faces) {
      for (const Vec<Dim>& x : face.corners) fall = std::max(fall, up.dot(end.mouth.corner - x));
    }
    for (int k = 0; k <= samples; ++k) {
      const double speed = end.largest_speed(spec.time.end * k / samples, spacing);
      height = std::max(height, fall + speed * speed / (2.0 * g));
    }
  }
  return height;
}

/// L of the reference speed [m]: the largest depth. A case may have no depth, as a dry one whose inlet points
/// downwards; there L is the height of fall. Collective.
template <int Dim>
double reference_length(const CaseSpec& spec, const Drawing<Dim>& drawing) {
  const double depth = largest_depth(spec, drawing.fluid);
  return depth > 0.0 ? depth : height_of_fall(spec, drawing.walls.boundary);
}

}  // namespace

template <int Dim>
double largest_depth(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  double depth = fluid_height(fluid, gravity, spec.particles.spacing);
  for (const ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec)) {
    depth = std::max(depth, end.largest_depth(spec.time.end));
  }
  return depth;
}

bool has_force_probe(const CaseSpec& spec) {
  return std::ranges::any_of(spec.probes, [](const ProbeTable& probe) { return probe.type == ProbeType::force; });
}

template <int Dim>
Drawing<Dim>::Drawing(const CaseSpec& spec, const WallModel<Dim>& model, const Communicator& ranks)
    : Drawing(spec, model, ranks, make_boundary<Dim>(spec)) {}

/// Keeps a copy of the drawn walls for the water only where open ends may add ducts to them.
template <int Dim>
Drawing<Dim>::Drawing(const CaseSpec& spec, const WallModel<Dim>& model, const Communicator& ranks, Boundary<Dim> drawn)
    : spacing_field(spec, drawn),
      walls(make_walls(spec, model, ranks, spacing_field,
                       spec.inlets.empty() && spec.outlets.empty() ? std::move(drawn) : Boundary<Dim>(drawn))),
      shared_rows(ranks, walls),
      wall_motion(spec, walls.boundary, walls.particles),
      fluid(make_fluid(spec, walls, drawn, ranks)) {}

template <int Dim>
Setup<Dim>::Setup(const CaseSpec& spec, const FlowFormulation<Dim>& chosen, const Communicator& all_ranks,
                  Drawing<Dim>& drawing)
    : ranks(all_ranks),
      formulation(chosen),
      liquid{.density = spec.physics.density,
             .viscosity = {.molecular = spec.physics.viscosity,
                           .artificial = formulation.artificial_viscosity * spec.particles.spacing},
             .tension = spec.physics.tension},
      scale(spec.particles.spacing, formulation.kernel),
      graded(drawing.spacing_field.is_uniform()
                 ? nullptr
                 : std::make_shared<GradedSums<Dim>>(scale.kernel, scale.spacing, drawing.spacing_field)),
      first_wall_id(drawing.fluid.all),
      gravity(gravity_of<Dim>(spec)),
      length(formulation.length > 0.0 ? formulation.length : reference_length(spec, drawing)),
      domain(periodic_domain<Dim>(spec.domain)),
      is_closed(fills_domain<Dim>(domain, drawing.fluid, spec.particles.spacing)),
      wall_motion(std::make_unique<WallMotion<Dim>>(std::move(drawing.wall_motion))),
      friction_law{.viscosity = spec.physics.viscosity,
                   .spacing = scale.spacing,
                   .exchange_length = 1.0 / scale.lattice.across_plane,
                   .knows_layers = formulation.has_eddy_viscosity} {
  const double g = gravity.norm();
  const double reference_speed = std::sqrt(2.0 * g * length);
  time_step_rule = {.courant = formulation.courant,
                    .spacing = scale.spacing * finest_spacing(),
                    .reference_speed = reference_speed,
                    .viscous_share = formulation.viscous_share};
  if (reference_speed > 0.0) time_step_rule.fastest = formulation.fastest_over_reference * reference_speed;
  const LiquidTable* const thick = liquid_of(spec);
  liquids = particle_liquids(spec, drawing.fluid, time_step_rule, first_wall_id + drawing.walls.particles.numbers);
  has_implicit_viscosity = thick != nullptr && (liquids.are_several() || varies_with_shear(*thick) ||
                                                time_step_rule.is_viscous(kinematic_viscosity(*thick)));
  if (thick == nullptr) return;
  liquid.density = thick->density;
  liquid.viscosity.molecular = friction_law.viscosity = has_implicit_viscosity ? 0.0 : kinematic_viscosity(*thick);
}

template <int Dim>
Setup<Dim>::~Setup() = default;

template <int Dim>
double Setup<Dim>::relative_spacing(const Vec<Dim>& x) const {
  return graded == nullptr ? 1.0 : graded->field().at(x);
}

template <int Dim>
double Setup<Dim>::finest_spacing() const {
  return graded == nullptr ? 1.0 : graded->field().finest();
}

TAILWATER_IN_2D_AND_3D(largest_depth);
template struct Drawing<2>;
template struct Drawing<3>;
template struct Setup<2>;
template struct Setup<3>;

}  // namespace tailwater
