// The pressure equation, row by row. For fluid particle i
//
//   sum_j c_ij (p_i - p_j) + a_i p_i = -(rho/dt) div u_star + gamma rho (s_i clamp(C/C_0 - 1, -0.1, 0.1) + o_i)/dt^2
//
// c_ij   weights of the Laplacian: Morris, or consistent (F23)
// a_i    weight of the air (air.h): what is missing of A_0, sum_j c_ij on a full lattice, counts as p = 0 on the
// surface
//        (the idea of Nair & Tomar 2014), so the equation needs no surface detection; 0 where the surface is marked
//        instead, whose rows are p = 0
// o_i    share of the particle behind a wall (wall_contact.h): films on a wall, where C/C_0 < 1, are held off it
// gamma  share of the density error that a step corrects; s_i is 1 for particles too close and `interior` for
//        particles too far apart: at the surface nothing pulls
//
// Wall rows. Dummies: p_w = sum_f W (p_f + rho (g - a) . r_wf)/sum_f W, weights of one sign, so that the whole is an
// M-matrix. Pressure rows: the consistent gradient along the normal, (F39). Dry walls: p = 0.
#include <algorithm>

#include "base/for_each.h"
#include "operators/gradient_consistent.h"
#include "operators/laplacian_consistent.h"
#include "operators/laplacian_morris.h"
#include "schemes/velocity_divergence.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {
namespace {

/// The density source answers errors up to this: a pile-up is dissolved over some steps, not blown up in one.
constexpr double largest_density_error = 0.1;

/// Pa/m^2
template <int Dim>
double density_source(const Flow<Dim>& flow, std::size_t i, double dt) {
  const double error = std::clamp(flow.concentration[i] - 1.0, -largest_density_error, largest_density_error);
  const double answered = (error < 0.0 ? flow.interior[i] : 1.0) * error + flow.wall_overlap[i];
  return flow.scheme.density_relaxation * flow.density * answered / (dt * dt);
}

/// Sets the weights of row i by weight(k) and returns their sum.
template <int Dim, class Weight>
double set_weights(const Pairs<Dim>& pairs, std::size_t i, PressureSystem::Row& row, Weight&& weight) {
  double sum = 0.0;
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const double c_ij = weight(k);
    row.set_weight(k - pairs.begin(i), c_ij);
    sum += c_ij;
  }
  return sum;
}

template <int Dim>
double set_laplacian_weights(const Flow<Dim>& flow, std::size_t i, PressureSystem::Row& row, bool& fell_back) {
  const Pairs<Dim>& pairs = flow.pairs();
  const std::vector<double>& volume = flow.particles.volume;
  if (flow.scheme.laplacian == LaplacianKind::morris) {
    return set_weights(pairs, i, row, [&](std::size_t k) {
      return flow.takes_part[pairs.j[k]]
                 ? morris_laplacian_weight(volume[pairs.j[k]], pairs.r[k], pairs.dW[k], flow.spacing)
                 : 0.0;
    });
  }
  const Renormalisation<Dim>& tensors = flow.tensors[i];
  if (tensors.laplacian_is_sound()) {
    const double sum = set_weights(pairs, i, row, [&](std::size_t k) {
      return flow.takes_part[pairs.j[k]]
                 ? consistent_laplacian_weight<Dim>(tensors, volume[pairs.j[k]], pairs.e[k], pairs.r[k], pairs.W[k])
                 : 0.0;
    });
    if (sum > 0.0) return sum;
  }
  fell_back = true;
  return set_weights(pairs, i, row, [&](std::size_t k) {
    return flow.takes_part[pairs.j[k]]
               ? fallback_laplacian_weight(tensors, volume[pairs.j[k]], pairs.r[k], pairs.W[k], flow.spacing)
               : 0.0;
  });
}

/// Returns whether the row had to fall back to two-point weights.
template <int Dim>
bool assemble_fluid_row(Flow<Dim>& flow, std::size_t i, double dt) {
  PressureSystem::Row row = flow.pressure_system.row(i);
  if (flow.is_leaving(i)) {
    set_weights(flow.pairs(), i, row, [](std::size_t) { return 0.0; });
    row.finish(1.0, flow.open_ends[flow.end_of[i]].pressure_at(flow.particles.position[i], flow.density));
    return false;
  }
  const bool has_air = flow.scheme.surface == SurfaceTreatment::air && !flow.is_closed;
  if (!has_air && flow.is_surface[i] && !flow.is_closed) {
    row.finish_as_zero();
    return false;
  }
  bool fell_back = false;
  const double sum = set_laplacian_weights(flow, i, row, fell_back);
  const bool is_morris = flow.scheme.laplacian == LaplacianKind::morris;
  const double full = is_morris ? flow.lattice.morris : flow.lattice.consistent;
  const double air = has_air ? flow.air_law.weight(sum, full) : 0.0;
  if (sum + air <= 0.0) {
    row.finish_as_zero();  // a lone particle: nothing around it, no pressure
    return fell_back;
  }
  row.finish(sum + air, -flow.density / dt * (divergence_at(flow, i, flow.u_star) - flow.target_divergence[i]) +
                            density_source(flow, i, dt));
  return fell_back;
}

template <int Dim>
void assemble_dummy_row(Flow<Dim>& flow, std::size_t i) {
  PressureSystem::Row row = flow.pressure_system.row(i);
  if (!flow.is_wet[i]) {
    row.finish_as_zero();
    return;
  }
  const Pairs<Dim>& pairs = flow.pairs();
  double rhs = 0.0;
  set_weights(pairs, i, row, [&](std::size_t k) {
    if (!flow.particles.is_fluid(pairs.j[k])) return 0.0;
    const double share = pairs.W[k] / flow.wall_fluid_weight[i];
    rhs += share * hydrostatic_difference(flow, i, k);
    return share;
  });
  row.finish(1.0, rhs);
}

template <int Dim>
void assemble_pressure_row(Flow<Dim>& flow, std::size_t i) {
  PressureSystem::Row row = flow.pressure_system.row(i);
  const Renormalisation<Dim>& tensors = flow.tensors[i];
  if (!flow.is_wet[i] || !tensors.gradient_is_sound()) {
    row.finish_as_zero();
    return;
  }
  const Pairs<Dim>& pairs = flow.pairs();
  const auto wall_row = flow.particles.wall_row[i];
  const Vec<Dim> normal = flow.walls.particles.normal[wall_row];
  const double sum = set_weights(pairs, i, row, [&](std::size_t k) {
    if (!flow.takes_part[pairs.j[k]]) return 0.0;
    return consistent_gradient_weight<Dim>(tensors.B1, flow.particles.volume[pairs.j[k]], pairs.e[k], pairs.r[k],
                                           pairs.W[k])
        .dot(normal);
  });
  if (sum <= 0.0) {
    row.finish_as_zero();
    return;
  }
  row.finish(sum, -flow.density * (flow.gravity - flow.wall_acceleration[wall_row]).dot(normal));  // (F39)
}

/// Each row couples its neighbours; a ghost's unknown is its owner's.
template <int Dim>
void set_pattern(Flow<Dim>& flow) {
  const Pairs<Dim>& pairs = flow.pairs();
  const Halo<Dim>& halo = flow.neighbourhood.halo();
  if (halo.source.empty()) {
    flow.pressure_system.set_pattern(pairs.row_begin, pairs.j);
    return;
  }
  std::vector<std::int32_t> columns(pairs.j.size());
  for_each(columns.size(), [&](std::size_t k) { columns[k] = halo.owner(pairs.j[k]); });
  flow.pressure_system.set_pattern(pairs.row_begin, columns);
}

}  // namespace

template <int Dim>
void assemble(Flow<Dim>& flow, double dt, Interventions& interventions) {
  set_pattern(flow);
  interventions.fallback_rows += count_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.particles.is_fluid(i)) return assemble_fluid_row(flow, i, dt);
    if (flow.walls.treatment == WallTreatment::dummies) {
      assemble_dummy_row(flow, i);
    } else {
      assemble_pressure_row(flow, i);
    }
    return false;
  });
}

template <int Dim>
double density_source_work(const Flow<Dim>& flow, double dt) {
  double work = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.is_solved_for(i)) continue;
    const double expansion = density_source(flow, i, dt) * dt * dt / flow.density;  // dt div u
    work += flow.particles.pressure[i] * flow.particles.volume[i] * expansion;
  }
  return work;
}

template void assemble<2>(Flow<2>&, double, Interventions&);
template void assemble<3>(Flow<3>&, double, Interventions&);
template double density_source_work<2>(const Flow<2>&, double);
template double density_source_work<3>(const Flow<3>&, double);

}  // namespace tailwater
