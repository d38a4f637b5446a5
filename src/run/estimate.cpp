#include "run/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <numbers>
#include <string>

#include "base/box.h"
#include "base/error.h"
#include "base/for_each.h"
#include "case/formulation.h"
#include "flow/stages.h"
#include "geometry/mesh_surface.h"
#include "geometry/wall_label.h"
#include "published/make_flow.h"
#include "run/inflow_estimate.h"
#include "schemes/advance.h"

namespace tailwater {
namespace {

/// The first step does not count: it builds lists and patterns and has no pressure to start from.
constexpr int trial_steps = 3;

/// Maximum number of particles in the tank that replaces a case that is too large to try. A small case costs more per
/// particle, so its tank is as small.
constexpr double max_in_tank = 1e4;
constexpr double min_in_tank = 100.0;

/// Minimum fraction of the mean amount of water at the start. With less the trial steps do not represent the run.
constexpr double share_to_try = 0.5;

/// At a millisecond per step, which is fast, this many take twelve days.
constexpr double max_steps = 1e9;

/// bytes; memory of a run without any particle, libraries included
constexpr double program_memory = 1.1e8;

/// s of CPU time, which, unlike elapsed time, does not depend on other programs; for one step of the flow after the
/// first.
template <int Dim>
double time_of_a_step(Flow<Dim>& flow, double end) {
  sort_particles(flow);
  advance(flow, std::min(next_time_step(flow), end));
  const std::clock_t start = std::clock();
  for (int k = 0; k < trial_steps; ++k) advance(flow, std::min(next_time_step(flow), end));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / trial_steps;
}

/// A full tank, as deep as wide, by the scheme of `spec` and with particles of the same size, and about as many as the
/// `fluid` of the case.
template <int Dim>
CaseSpec tank_instead_of(const CaseSpec& spec, double fluid) {
  const double count = std::clamp(fluid, min_in_tank, max_in_tank);
  const double side = spec.particles.spacing * std::round(std::pow(count, 1.0 / Dim));
  CaseSpec tank;
  tank.general.dimension = Dim;
  tank.particles = spec.particles;
  tank.physics = spec.physics;
  tank.scheme = spec.scheme;
  tank.pressure_solver = spec.pressure_solver;
  tank.time = spec.time;
  tank.liquids = spec.liquids;
  FluidTable water;
  water.min.assign(Dim, 0.0);
  water.max.assign(Dim, side);
  water.velocity.assign(Dim, 0.0);
  if (!spec.fluid.empty()) water.liquid = spec.fluid[0].liquid;
  tank.fluid.push_back(water);
  WallTable wall;
  wall.shape = WallShape::box;
  wall.min = water.min;
  wall.max = water.max;
  wall.max.back() *= 1.5;
  wall.open = {Dim == 2 ? "+y" : "+z"};
  wall.displacement.assign(Dim, 0.0);
  wall.fluid_side = FluidSide::inside;
  tank.walls.push_back(wall);
  return tank;
}

}  // namespace

template <int Dim>
double neighbours_in_support(double support) {
  return std::numbers::pi * (Dim == 2 ? 1.0 : 4.0 / 3.0) * power<Dim>(support);
}

template <int Dim>
double memory_estimate(const ParticleCount& count, double neighbours) {
  constexpr double number = sizeof(double);
  constexpr double index = 4.0;
  constexpr double single = sizeof(float);
  // Position, velocity, their predicted and old values, force and shift; pressure, volume, viscosity and the like. They
  // count three times, for the state before the step and the solver's vectors, and for the checkpoint in memory and its
  // file.
  constexpr double fields = 3.0 * (6 * Dim + 10) * number;
  // Per pair: the neighbour's index, which is also the matrix's column, and the matrix's weight.
  constexpr double pair = index + single;
  // Rows of dummies contain only the fluid half of their neighbourhood.
  const double pairs = (count.fluid + 0.5 * count.wall) * neighbours;
  // The solver has vectors of its own, and memory is fragmented. The peak in summary.json after some steps, less that
  // of a run of 200 particles (51 MB), was compared with the size of the arrays. It is 1.20 times the arrays for
  // cases/zhou1999 at dx = 0.003 m with the implicit integrator (130 MB; explicit 127). Walls that stay dry take less:
  // it is 0.95 times the arrays for benchmarks/dam_break_3d.toml at 0.00969 m, where a third of the particles are of
  // walls (1.59 GB).
  constexpr double slack = 1.2;
  return program_memory + slack * ((count.fluid + count.wall) * fields + pairs * pair);
}

namespace {

/// The most particles that zones of refinement add to a number of particles of the case's spacing: until they are full,
/// or have all of the water.
template <int Dim>
double particles_of_zones(const CaseSpec& spec, const Boundary<Dim>& boundary, double fluid) {
  const SpacingField<Dim> field(spec, boundary);
  double most = 0.0;
  for (std::size_t zone = 0; zone < field.zones().size(); ++zone) {
    most += particles_of_full_zone(field, zone, spec, box_around(boundary.faces), boundary);
  }
  return std::min(most, fluid / power<Dim>(field.finest()));
}

/// m; cases that are longer and do not fit into memory are probably drawn in millimetres.
constexpr double longest_of_flumes = 100.0;

/// m; the longest extent of the water at the start and of the walls.
template <int Dim>
double length_of_case(const CaseSpec& spec, const Boundary<Dim>& boundary) {
  Box<Dim> box = box_around(boundary.faces);
  for (const FluidTable& block : spec.fluid) {
    for (const Coordinates& corner : {block.min, block.max}) {
      if (corner.size() == Dim) box.extend(Vec<Dim>(Vec<Dim>::Map(corner.data())));
    }
  }
  return box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
}

/// A hint for a case that may be drawn in another unit.
template <int Dim>
Clause hint_of_unit(const Boundary<Dim>& boundary, double length_of_all) {
  Clause hint;
  if (length_of_all > longest_of_flumes) hint = {", or divide all lengths by 1000 if they are in millimetres"};
  if constexpr (Dim == 3) {
    double longest = 0.0;
    for (const WallMesh& mesh : boundary.meshes) {
      const double length = (mesh.surface->high() - mesh.surface->low()).maxCoeff();
      if (length <= longest) continue;
      longest = length;
      hint = {", or scale = 0.001 if the file of {}, which is {:.6g} m long, is in millimetres",
              wall_label(boundary, mesh.wall), length};
    }
  }
  return hint;
}

}  // namespace

double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (double kibibytes = 0.0; file >> key >> kibibytes;) {
    std::getline(file, unit);
    if (key == "MemAvailable:") return 1024.0 * kibibytes;
  }
  throw IoError("/proc/meminfo has no line MemAvailable: it is unknown whether the case fits into memory");
}

template <int Dim>
Findings check_memory(const CaseSpec& spec, const Boundary<Dim>& boundary, double available) {
  ParticleCount count = expected_particle_count(spec, boundary);
  count.fluid += particles_of_zones(spec, boundary, count.fluid);
  const double needed = memory_estimate<Dim>(count, neighbours_in_support<Dim>(traits_of(spec).support));
  if (needed <= available) return {};
  // The particles' memory is proportional to dx^-Dim.
  const double too_much = (needed - program_memory) / std::max(available - program_memory, 1.0);
  const double fitting = spec.particles.spacing * std::pow(too_much, 1.0 / Dim);
  const double length = length_of_case(spec, boundary);
  return {Finding::error(
      "too-little-memory",
      {"{} = {:.6g} makes {:.3g} fluid and {:.3g} wall particles in a case that is {:.4g} m long, which need {:.3g} GB "
       "of memory, and only {:.3g} GB are free",
       CaseLabel("particles").with_key("spacing"), Amount{spec.particles.spacing, "m"}, count.fluid, count.wall, length,
       needed / 1e9, available / 1e9},
      {"use a spacing of at least {:.3g} m, or smaller shapes{}", fitting, hint_of_unit(boundary, length)})};
}

void require_reachable_end(const CaseSpec& spec, const TimeStepRule& rule) {
  const double largest_step = rule.largest(0.0, 0.0);
  // No quotient is used, since it may overflow for a mistyped end time.
  if (spec.time.end > max_steps * largest_step) {
    throw CaseError(
        "end-out-of-reach",
        {"{} = {:g} is out of reach: with time steps of at most {:.3g} s the run takes more than {:g} steps",
         CaseLabel("time").with_key("end"), Amount{spec.time.end, "s"}, largest_step, max_steps},
        {"give the end in seconds, at most {:.3g}, or a larger particles.spacing", max_steps * largest_step});
  }
}

template <int Dim>
RunEstimate estimate_run(const CaseSpec& spec, Flow<Dim>& flow, double max_pairs) {
  RunEstimate estimate;
  estimate.particles.wall = static_cast<double>(flow.walls.all);
  estimate.has_implicit_viscosity = flow.setup.has_implicit_viscosity;
  const Particles<Dim>& particles = flow.state.particles;
  estimate.particles.fluid =
      static_cast<double>(count_each(particles.owned, [&](std::size_t i) { return particles.is_fluid(i); }));
  const double space =
      sum_over(particles.owned, 0.0, [&](std::size_t i) { return particles.is_fluid(i) ? particles.volume[i] : 0.0; });
  estimate.water = sum_over(particles.owned, 0.0,
                            [&](std::size_t i) { return particles.is_fluid(i) ? flow.water_volume_of(i) : 0.0; });
  // Beside walls that no lattice fits, cells are smaller or larger than dx.
  const double of_a_particle =
      estimate.particles.fluid > 0.0 ? space / estimate.particles.fluid : power<Dim>(spec.particles.spacing);
  const WaterEstimate water = estimate_water(spec, flow.walls.boundary, space);
  estimate.largest_fluid = water.largest / of_a_particle;
  const double neighbours = neighbours_in_support<Dim>(traits_of(spec).support);
  estimate.memory = memory_estimate<Dim>({estimate.largest_fluid, estimate.particles.wall}, neighbours);
  const double at_start = estimate.particles.fluid + estimate.particles.wall;
  const double in_the_mean = water.mean / of_a_particle + estimate.particles.wall;
  estimate.grows_much = estimate.particles.fluid < share_to_try * water.mean / of_a_particle;
  estimate.is_from_tank = at_start * neighbours > max_pairs || estimate.grows_much;
  double per_particle = 0.0;
  if (estimate.is_from_tank) {
    Flow<Dim> tank = make_flow<Dim>(tank_instead_of<Dim>(spec, water.mean / of_a_particle));
    per_particle = time_of_a_step(tank, spec.time.end) / static_cast<double>(tank.state.particles.owned);
  } else {
    per_particle = time_of_a_step(flow, spec.time.end) / std::max(at_start, 1.0);
  }
  const double step =
      std::min({next_time_step(flow), flow.setup.time_step_rule.largest(water.largest_speed, 0.0), spec.time.end});
  estimate.steps = spec.time.end / step;
  estimate.seconds = estimate.steps * per_particle * in_the_mean;
  return estimate;
}

TAILWATER_IN_2D_AND_3D(neighbours_in_support);
TAILWATER_IN_2D_AND_3D(memory_estimate);
TAILWATER_IN_2D_AND_3D(check_memory);
TAILWATER_IN_2D_AND_3D(estimate_run);

}  // namespace tailwater
