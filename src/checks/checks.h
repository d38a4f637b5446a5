// The checks of a case's geometry, each in a file with its name. A new check needs a file, a declaration here and a
// line in check.cpp, or in check_moving_walls if it is about moving walls.
#pragma once

#include "base/finding.h"
#include "case/spec.h"
#include "geometry/boundary.h"
#include "geometry/from_spec.h"
#include "sampling/fluid_particles.h"

namespace tailwater {

/// Height of the water at the start along gravity [m]; 0 without gravity. Collective.
template <int Dim>
double water_height(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  const Vec<Dim> gravity = gravity_of<Dim>(spec);
  if (gravity.norm() == 0.0 || fluid.all == 0) return 0.0;
  return fluid.extent_along(gravity.normalized()) + spec.particles.spacing;
}

/// Errors: no fluid; a block too small for a single particle.
template <int Dim>
Findings check_blocks(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

/// Errors: a periodic direction narrower than four supports, in which a particle would interact with its own image; a
/// wall that is longer than the period, which would overlap itself.
template <int Dim>
Findings check_periodic_width(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Error: a wall that crosses itself.
Findings check_self_crossing(const CaseSpec& spec, const Boundary<2>& boundary);

/// Error: a bed with a crest as high as its own ends. Water that reaches the crest has already run over the ends.
Findings check_crests(const CaseSpec& spec, const Boundary<2>& boundary);

/// Errors: a mesh much longer than the water or shorter than dx, which is drawn in another unit; a mesh that crosses
/// itself; a mesh that is a plate thinner than its layers of wall particles. Warnings: a mesh at rest beside all water
/// and other walls; a body longer than twice all these.
Findings check_meshes(const CaseSpec& spec, const Boundary<3>& boundary, const FluidParticles<3>& fluid);

/// Error: a wave maker whose depth is not that of the water in front of it. Warning: waves lower than two spacings.
/// Collective.
template <int Dim>
Findings check_wave_makers(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

/// Error: a wall that is no mesh and thinner than its layers of wall particles, where water can reach both of its
/// sides. Tests straight through each face from points dx apart; at most 50 points per edge.
template <int Dim>
Findings check_wall_thickness(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Error: a plate with wall particles on the walls themselves, which act on both sides; a plate that lies along a wall
/// (warning if only one of them moves). Warning: plates that lie on each other.
template <int Dim>
Findings check_plates(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Warning: an opening between walls, or beside a plate, that is closed, or too narrow for its water. Walls on a path
/// count where they come to rest before the end of the run. Their paths must be finite.
template <int Dim>
Findings check_closed_gaps(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Errors: a wall whose roughness is larger than 15 dx, or than the water is deep; side walls of a channel rougher than
/// half of its width. Warning: a roughness larger than dx. Collective.
template <int Dim>
Findings check_roughness(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Error: blocks of fluid that overlap. On opposite sides of a plate they may be near each other.
template <int Dim>
Findings check_overlap(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Errors: fluid behind a wall, on both sides of it, or too near to it. Warning: a gap between fluid and wall.
template <int Dim>
Findings check_fluid_at_walls(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Errors: an inlet or an outlet
/// - that lies across a periodic direction, overlaps a wall, cuts through water, or faces the wrong way;
/// - that has a rim that is not on the walls, or on a wall that moves;
/// - that has walls or water in the space of its duct or its jet, or shares that space with another;
/// - that is a hole without a definition of the far side.
template <int Dim>
Findings check_open_ends(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Errors: the prescribed values of an inlet or outlet do not cover the run, are not finite, or jump; a level outside
/// the opening; more water than the opening can pass; a level with a subcritical flow; an implausible speed. Warning: a
/// flow shallower than a spacing, unless water that cannot leave dams it.
template <int Dim>
Findings check_end_flows(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Error: an inlet that brings more water than a space without a way out can hold. Spaces that a moving wall may open
/// are excluded.
template <int Dim>
Findings check_closed_space(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Errors: a place where the water would pour out of the case; water that can reach the back of a wall. Counts the
/// water at the start and the inflow through open ends, which count as closed. Warning instead: a yielding liquid that
/// may pour out before it comes to rest. Collective.
template <int Dim>
Findings check_leaks(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Warning: water below a wall that stands higher than its own surface, as in a siphon, and is not at an open end.
template <int Dim>
Findings check_hanging_water(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Warning: a space below the level of a fill that walls close off, so that it stays dry. Collective.
template <int Dim>
Findings check_sealed_space(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid);

/// Error: water that enters, or a body, at a speed too high for incompressible water.
template <int Dim>
Findings check_speeds(const CaseSpec& spec);

/// Error: a body so light that it floats with a draught of a twentieth of dx. Warning: a centre of mass outside of the
/// body; an inertia that no mass within it has; a spring, a damper or extra mass for a motion that is not free.
template <int Dim>
Findings check_bodies(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Error: a body that fills its space from side to side, except for gaps through which no water can pass.
template <int Dim>
Findings check_body_gaps(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Warning: a spring of a body or a mooring that needs time steps less than a tenth of those of the water. Collective.
template <int Dim>
Findings check_springs(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

/// Error: a mooring that is fastened far from its body. Warning: one that pulls with many times the body's weight.
template <int Dim>
Findings check_moorings(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Error: a vent, or the place of air that starts at another pressure, in a wall or outside of all walls.
template <int Dim>
Findings check_air_places(const CaseSpec& spec, const Boundary<Dim>& boundary);

/// Warning: a liquid that creeps below its yield stress by more than a spacing until the end of the run, or faster than
/// the speed at which the run ends at rest. Collective.
template <int Dim>
Findings check_creep(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

/// Warning: a density, gravity or viscosity that looks like a value in another common unit, such as kg/l.
template <int Dim>
Findings check_units(const CaseSpec& spec);

/// Warning: a gate, a wave maker or a measurement that starts after the end of the run.
Findings check_late_starts(const CaseSpec& spec);

/// Warning: a zone that reflects waves, brakes a flow, or whose own waves the particles do not resolve. Errors: a level
/// that the water does not have; a group that cannot come to its focus in time. Collective.
template <int Dim>
Findings check_wave_zones(const CaseSpec& spec, const FluidParticles<Dim>& fluid);

/// Error: a damping zone where no water can come. Warning: two zones that overlap.
template <int Dim>
Findings check_damping(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

/// Errors: a zone of refinement outside of the case, narrower than its borders, over one end of a period only, or with
/// features that do not work with zones: other schemes and pair vectors than the default ones, bodies, enclosed air,
/// porous layers, and walls that move and open ends nearby.
template <int Dim>
Findings check_refinement(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

/// Error: a probe where no water can come. Warning: few readings, or times after the end of the run; a probe of the
/// pressure on a wall that is not at one.
template <int Dim>
Findings check_probes(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

/// Warning: a force probe on a wall on which another wall lies that the probe does not name.
template <int Dim>
Findings check_shared_force(const CaseSpec& spec, const Boundary<Dim>& drawn);

/// All checks of moving walls; `drawn` are the walls as in the case file. Error: a wall that is not at its drawn place
/// at t = 0. Walls without that error are then checked by the functions below.
template <int Dim>
Findings check_moving_walls(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

/// Error: a motion from a file that jumps between two of its lines. Warning: one that exceeds the values of its lines.
/// Findings name file and lines.
template <int Dim>
Findings check_motion_files(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid);

/// Warning: a resting wall that ends on a corner of a moving one, unless a side of the moving wall closes the end at
/// all times, or covers the wall there.
Findings check_free_ends(const CaseSpec& spec, const Boundary<2>& drawn);

/// Error, when rows of particles stand on the walls: walls that move relative to each other and are nearer than dx at
/// the start. Their two rows would overlap.
template <int Dim>
Findings check_touching_rows(const CaseSpec& spec, const Boundary<Dim>& drawn);

/// Errors, each with time and place: a wall whose place is not finite; a wall that is too fast for incompressible
/// water, crosses a wall, approaches one to less than dx, or leaves enclosed water less space than it needs. Follows
/// the `moving` walls in steps of dx/4 from the start to the end of the run.
template <int Dim>
Findings check_paths(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid,
                     const std::vector<int>& moving);

}  // namespace tailwater
