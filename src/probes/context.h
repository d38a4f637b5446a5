// The data of a flow at one instant for the probes, and the readings that probes return.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "case/probe_columns.h"
#include "geometry/boundary.h"
#include "geometry/face.h"
#include "kernel/kernel.h"
#include "motion/floating_body.h"
#include "neighbours/cell_grid.h"
#include "neighbours/halo.h"
#include "parallel/communicator.h"
#include "particles/liquids.h"
#include "particles/particles.h"
#include "particles/wall_forces.h"
#include "particles/wall_inertia.h"
#include "refinement/spacing_field.h"

namespace tailwater {

template <int Dim>
class PatchesOfWalls;

/// Totals of all pockets of enclosed air. In 2D per metre of width.
struct PocketTotals {
  double pressure = 0.0;  ///< Pa; pressure of the largest pocket, above the atmosphere's
  double volume = 0.0;    ///< m^Dim
  double gas = 0.0;       ///< m^Dim; gas at the pressure of the atmosphere
  double vented = 0.0;    ///< m^Dim; the same unit: gas that has left through vents, less gas that came in
  double energy = 0.0;    ///< J
  double pockets = 0.0;   ///< number of pockets
};

/// Measures of the whole flow on all ranks. In 2D per metre of width.
struct FlowTotals {
  double kinetic_energy = 0.0;      ///< J
  double potential_energy = 0.0;    ///< J; relative to the origin
  double density_error_mean = 0.0;  ///< mean of C/C_0 - 1 away from the surface
  double density_error_rms = 0.0;
  double volume_out = 0.0;                   ///< m^Dim; volume that has left through open ends
  double volume_in = 0.0;                    ///< m^Dim; volume that has come through them
  std::vector<double> section_volumes = {};  ///< m^Dim; one per discharge probe, volume that has passed it
  PocketTotals air = {};
};

/// Borrows the particles, whose ghosts must be up to date. `grid` contains all particles at their present places; its
/// cells reach as far as the kernel's support.
template <int Dim>
struct ProbeContext {
  const Particles<Dim>& particles;
  const CellGrid<Dim>& grid;
  const Kernel<Dim>& kernel;
  const Boundary<Dim>& boundary;
  double density;    ///< kg/m^3
  Vec<Dim> gravity;  ///< m/s^2
  double spacing;    ///< m; dx
  double time;       ///< s
  FlowTotals totals;
  Communicator ranks = {};
  /// For visible_fraction: the plates through which water interacts with each particle. Needed where there are plates.
  std::span<const int> felt_through = {};
  PeriodicDomain<Dim> domain = {};
  double dt = 0.0;                               ///< s; duration of the last step; 0 at the start
  const WallForces<Dim>* wall_forces = nullptr;  ///< in this step; null unless a probe needs them
  PatchesOfWalls<Dim>* patches = nullptr;        ///< of the forces; the probe places them
  /// In this step; null where no wall moves or is curved. The same on all ranks.
  const WallInertia<Dim>* wall_inertia = nullptr;
  std::span<const BodyState<Dim>> bodies = {};  ///< floating bodies
  /// Pa; pressure of the air at a place, above the atmosphere's. The same on all ranks; empty without pockets.
  std::function<double(const Vec<Dim>&)> air_pressure = {};
  /// Where particles are finer than `spacing`; null: nowhere.
  const SpacingField<Dim>* spacing_field = nullptr;
  const ParticleLiquids* liquids = nullptr;  ///< null: one
  int liquid = -1;                           ///< the one whose level or front a probe measures; -1: all
  double speed = 0.0;                        ///< m/s; of the case, sqrt(2 g H) with its depth H

  /// kg/m^3; of fluid particle j.
  double density_of(std::size_t j) const {
    return liquids == nullptr ? density : liquids->density[liquids->of(particles.id[j])];
  }
  /// Whether the probe measures particle j.
  bool is_measured(std::size_t j) const {
    return particles.is_fluid(j) && (liquid < 0 || liquids->of(particles.id[j]) == liquid);
  }
  double relative_spacing(const Vec<Dim>& x) const { return spacing_field == nullptr ? 1.0 : spacing_field->at(x); }
  double spacing_at(const Vec<Dim>& x) const { return spacing * relative_spacing(x); }
  double air_pressure_at(const Vec<Dim>& x) const { return air_pressure ? air_pressure(x) : 0.0; }

  /// This instant for other particles. Data that belong to particles or ranks are left out.
  ProbeContext of(const Particles<Dim>& others, const CellGrid<Dim>& their_grid) const {
    return {.particles = others,
            .grid = their_grid,
            .kernel = kernel,
            .boundary = boundary,
            .density = density,
            .gravity = gravity,
            .spacing = spacing,
            .time = time,
            .totals = totals,
            .air_pressure = air_pressure,
            .spacing_field = spacing_field,
            .liquids = liquids,
            .liquid = liquid,
            .speed = speed};
  }
};

/// The place from which a probe at `x` sees the water past the screens of walls: `x`, moved in front of the walls on
/// which it lies. Rounding can leave `x` on either side of them. Plates have water on both sides (in_front_of).
template <int Dim>
Vec<Dim> place_of_eye(const ProbeContext<Dim>& context, const Vec<Dim>& x) {
  constexpr int max_rounds = 100;  // the moves away from two walls that meet at 10 degrees take 50
  const double tolerance = corner_tolerance * context.spacing;
  const auto near = context.boundary.screens_near(x, tolerance);
  Vec<Dim> eye = x;
  bool is_in_front = false;
  for (int round = 0; round < max_rounds && !is_in_front; ++round) {
    is_in_front = true;
    for (const int s : near) {
      const Screen<Dim>& screen = context.boundary.screens[s];
      const double height = screen.height(eye);
      if (screen.is_plate || height > 0.1 * tolerance || screen.distance(x) > tolerance) continue;
      eye += (tolerance - height) * screen.normal;
      is_in_front = false;
    }
  }
  return eye;
}

/// The visible fraction of a particle from the eye of a probe.
template <int Dim>
double visible_fraction_of(const ProbeContext<Dim>& context, const Vec<Dim>& eye, std::int32_t j) {
  if (context.boundary.screens.empty()) return 1.0;
  const Vec<Dim>& there = context.particles.position[j];
  const int felt = context.felt_through.empty() ? felt_past_screens : context.felt_through[j];
  return visible_fraction<Dim>(context.boundary.screens, context.boundary.screens_near(eye, (there - eye).norm()), eye,
                               there, felt);
}

/// The place from which a probe reads at `x` on the face of a wall: `x`, or a place in front of a plate, whose back is
/// at `x` as well.
template <int Dim>
Vec<Dim> in_front_of(const Boundary<Dim>& boundary, int wall, const Vec<Dim>& normal, const Vec<Dim>& x,
                     double spacing) {
  return boundary.walls[wall].is_plate ? Vec<Dim>(x + corner_tolerance * spacing * normal) : x;
}

/// Calls body(j, v w_j W(|x - x_j|)) for every particle j within the support around `x` whose visible fraction v is not
/// 0.
template <int Dim, class Body>
void for_each_weight(const ProbeContext<Dim>& context, const Vec<Dim>& x, Body&& body) {
  const double relative = context.relative_spacing(x);
  const Vec<Dim> eye = place_of_eye(context, x);
  std::visit(
      [&](const auto& kernel) {
        const double radius = relative * kernel.radius();
        context.grid.for_each_near(x, [&](std::int32_t j) {
          const double squared = (x - context.particles.position[j]).squaredNorm();
          if (squared >= radius * radius) return;
          const double visible = visible_fraction_of(context, eye, j);
          if (visible == 0.0) return;
          const double W = kernel.value(std::sqrt(squared) / relative) / power<Dim>(relative);
          body(j, visible * context.particles.volume[j] * W);
        });
      },
      context.kernel);
}

using Row = std::vector<double>;

/// The region of a probe: all places within `margin` of a segment, and all places in the direction `along` from these.
template <int Dim>
struct Region {
  Vec<Dim> from;
  Vec<Dim> to;
  Vec<Dim> along = Vec<Dim>::Zero();  ///< of length 1, or zero
  double margin = 0.0;                ///< m

  /// The distance of `x` from the segment, across `along` [m].
  double distance(const Vec<Dim>& x) const {
    const Vec<Dim> stretch = across(to - from);
    const Vec<Dim> offset = across(x - from);
    const double squared = stretch.squaredNorm();
    const double share = squared > 0.0 ? std::clamp(offset.dot(stretch) / squared, 0.0, 1.0) : 0.0;
    return (offset - share * stretch).norm();
  }

  /// Whether `x` is in the region or at most `reach` [m] away.
  bool contains(const Vec<Dim>& x, double reach) const { return distance(x) <= margin + reach; }

  /// Contains all places that `contains` accepts, up to rounding; unbounded in the directions of `along`.
  Box<Dim> box(double reach) const {
    Vec<Dim> sideways = Vec<Dim>::Constant(margin + reach);
    for (int d = 0; d < Dim; ++d) {
      if (along[d] != 0.0) sideways[d] = std::numeric_limits<double>::infinity();
    }
    return {from.cwiseMin(to) - sideways, from.cwiseMax(to) + sideways};
  }

 private:
  Vec<Dim> across(const Vec<Dim>& v) const { return v - v.dot(along) * along; }
};

/// A measurement set up for one place: the columns of its table, and the function that takes it, as one or more rows.
template <int Dim>
struct Reading {
  std::vector<OutputColumn> columns;
  std::function<std::vector<Row>(const ProbeContext<Dim>&)> take;
  /// On several ranks the root takes the measurement, from the particles of all ranks within the kernel's support of
  /// this region at `time` [s]. If empty, every rank takes it from its own particles, and the root's rows count.
  std::function<Region<Dim>(double time)> region = {};
  /// The state of the probe between readings; null: there is none. The root's state counts: a checkpoint saves it, and
  /// a resumed run restores it.
  std::shared_ptr<std::vector<double>> memory = {};
  bool memory_grows = false;  ///< else its number of values is constant
  /// Whether it sums over time: it is then evaluated at every step, for any interval between the lines of its table.
  bool adds_up = false;
  /// The totals of its type (totals_of), from its memory; the last ones are left out as long as they are undefined.
  std::function<std::vector<double>()> totals = {};
  /// Writes its map at `time` [s] as VTP, or beside `path` as CSV, from its memory. Throws IoError.
  std::function<void(const std::filesystem::path& path, double time)> write_map = {};
};

}  // namespace tailwater
