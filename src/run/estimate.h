// Estimates of the cost of a run before it starts: particles, memory, time steps, hours.
#pragma once

#include "base/finding.h"
#include "case/spec.h"
#include "flow/flow.h"
#include "sampling/particle_count.h"

namespace tailwater {

/// Particles within the kernel's support (in dx) of a particle on a regular lattice.
template <int Dim>
double neighbours_in_support(double support);

/// Memory of a run [bytes] with `count` particles that have `neighbours` each on average. An upper estimate of the data
/// that exist at the same time: fields, pairs with kernel values, matrix.
template <int Dim>
double memory_estimate(const ParticleCount& count, double neighbours);

/// Memory that is still free for programs on this machine [bytes] (MemAvailable of /proc/meminfo). Throws IoError.
double available_memory();

/// Call before any particle is made. Error: the case needs more than `available` bytes.
template <int Dim>
Findings check_memory(const CaseSpec& spec, const Boundary<Dim>& boundary, double available);

struct RunEstimate {
  bool has_implicit_viscosity = false;  ///< viscous forces do not limit the step
  ParticleCount particles;              ///< at the start
  double water = 0.0;                   ///< m^Dim; at the start
  double largest_fluid = 0.0;           ///< maximum number of fluid particles, including inflow
  double memory = 0.0;                  ///< bytes
  double steps = 0.0;         ///< steps to the end, if speeds stay near those of free fall through the fluid's height
  double seconds = 0.0;       ///< of CPU time on this machine, from trial steps
  bool is_from_tank = false;  ///< the trial steps were those of a tank, and `seconds` is only a first guess
  bool grows_much = false;    ///< because far more water enters than there is at the start
};

/// Pairs of neighbours with which a step takes about a second. Measured: a step of 190 000 particles in 2D, which is
/// 5.4e6 pairs, takes 1.2 s.
inline constexpr double pairs_in_a_second = 4e6;

/// Throws InputError if no run can reach the end time, however quiet its flow.
void require_reachable_end(const CaseSpec& spec, const TimeStepRule& rule);

/// Runs a few trial steps of `flow`, which was made from `spec`. They are replaced by steps of a tank by the same
/// scheme if the flow has more than `max_pairs` pairs, or few compared with its later number (inflow_estimate.h). The
/// time of these steps is scaled by the number of particles. The mean number of particles over the run counts.
template <int Dim>
RunEstimate estimate_run(const CaseSpec& spec, Flow<Dim>& flow, double max_pairs = pairs_in_a_second);

}  // namespace tailwater
