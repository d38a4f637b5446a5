// The pressure equation, row by row. For fluid particle i
//
//   sum_j c_ij (p_i - p_j) + a_i p_i = -(rho/dt) div u_star + gamma rho (s_i clamp(C/C_0 - 1, -0.1, 0.1) + o_i)/dt^2
//
// with `source = "mixed"`; the first term alone is (F15), and `source = "density"` is (B17), rho (C/C_0 - 1)/dt^2.
//
// c_ij   weights of the Laplacian: Morris, consistent (F23), or (B8)
// a_i    near the surface the weight of the air (air.h): what is missing of A_0, sum_j c_ij on a full lattice, counts
//        as p = 0 on the surface (the idea of Nair & Tomar 2014), so the equation needs no surface detection. Inside
//        4 |grad C_i|^2, by `interior`: the force of a uniform pressure p on disordered particles is -2 p grad C_i, so
//        div grad p has the part -4 |grad C|^2 p, and without it in the matrix pressures of deep disordered water
//        overshoot from step to step (docs/theory/robustness.md); and a little softness. 0 where the surface is marked,
//        whose rows are p = 0
// o_i    share of the particle behind a wall (wall_contact.h): films on a wall, where C/C_0 < 1, are held off it
// gamma  share of the density error that a step corrects; s_i is what the energy leaves of it for particles too close
//        (`balance_energy`), and `pull` times `interior` for particles too far apart: at the surface nothing pulls
//
// Wall rows. A row with dummies behind: on the wall the same equation, and each dummy has the pressure of the row
// beside it, p_d = sum_w W p_w/sum_w W, so that nothing flows across the wall (Neumann). Dummies: p_w = sum_f W (p_f +
// rho (g - a) . r_wf)/sum_f W, weights of one sign, so that the whole is an M-matrix. Pressure rows: the consistent
// gradient along the normal, (F39). Dry walls: p = 0.
#include <algorithm>
#include <cmath>

#include "base/for_each.h"
#include "closures/wall_contact.h"
#include "operators/gradient_consistent.h"
#include "operators/laplacian_consistent.h"
#include "operators/laplacian_morris.h"
#include "operators/laplacian_shao_lo.h"
#include "schemes/velocity_divergence.h"
#include "schemes/verbs.h"
#include "schemes/wall_state.h"

namespace tailwater {
namespace {

/// The density source answers errors up to this: a pile-up is dissolved over some steps, not blown up in one.
constexpr double largest_density_error = 0.1;

/// Water too far apart answers by so many times what water too close does: shifts only ever expand, and pulling
/// together costs no energy. With 1 the dam break is 0.2 to 0.4 % too light, with 2 at fine spacing 0.1 % too dense.
constexpr double pull = 1.5;

/// [1/dx^2]; weight of every row inside, as if sound went 100 dx per step. Nothing else holds the mean pressure of
/// ordered water that fills its box; under a surface it compresses the bottom by 0.03 % (0.1 % at the implicit step).
constexpr double softness = 1e-4;

/// (B17), or the share of the density error that a step corrects beside the divergence [Pa/m^2].
template <int Dim>
double density_source(const Flow<Dim>& flow, std::size_t i, double dt) {
  const double unit = flow.density / (dt * dt);
  if (flow.scheme.source == SourceKind::density) return unit * (flow.concentration[i] - 1.0);
  const double error = std::clamp(flow.concentration[i] - 1.0, -largest_density_error, largest_density_error);
  const double answered = (error < 0.0 ? pull * flow.interior[i] : flow.density_share) * error + flow.wall_overlap[i];
  return flow.scheme.density_relaxation * unit * answered;
}

template <int Dim>
double source_at(const Flow<Dim>& flow, std::size_t i, double dt) {
  double source = 0.0;
  if (flow.scheme.source != SourceKind::density) {
    source -= flow.density / dt * (divergence_at(flow, i, flow.u_star) - flow.target_divergence[i]);
  }
  if (flow.scheme.source != SourceKind::velocity_divergence) source += density_source(flow, i, dt);
  return source;
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
  if (flow.scheme.laplacian == LaplacianKind::shao_lo) {
    const std::vector<double>& density = flow.concentration;
    return set_weights(pairs, i, row, [&](std::size_t k) {
      const auto j = pairs.j[k];
      return flow.takes_part[j] ? shao_lo_laplacian_weight(volume[j], density[i], density[j], pairs.r[k], pairs.dW[k],
                                                           flow.eta_squared)
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

/// Sum of the weights on a full lattice.
template <int Dim>
double full_sum(const Flow<Dim>& flow) {
  switch (flow.scheme.laplacian) {
    case LaplacianKind::consistent:
      return flow.lattice.consistent;
    case LaplacianKind::shao_lo:
      return flow.lattice.shao_lo;
    case LaplacianKind::morris:
      break;
  }
  return flow.lattice.morris;
}

/// a_i: air near the surface (and on walls), disorder inside.
template <int Dim>
double own_weight(const Flow<Dim>& flow, std::size_t i, double sum) {
  const double air = flow.air_law.weight(sum, full_sum(flow));
  const double disorder = 4.0 * flow.concentration_gradient[i].squaredNorm();
  return std::lerp(air, disorder + softness / (flow.spacing * flow.spacing), flow.interior[i]);
}

/// The pressure equation without its source. Returns whether the row had to fall back to two-point weights.
template <int Dim>
bool assemble_equation(Flow<Dim>& flow, std::size_t i) {
  PressureSystem::Row row = flow.pressure_system.row(i);
  if (flow.is_leaving(i)) {
    set_weights(flow.pairs(), i, row, [](std::size_t) { return 0.0; });
    row.finish(1.0, flow.open_ends[flow.end_of[i]].pressure_at(flow.particles.position[i], flow.density));
    return false;
  }
  const bool is_dry = !flow.takes_part[i];  // a wall
  if (is_dry || (!has_air(flow) && flow.is_surface[i] && !flow.is_closed)) {
    row.finish_as_zero();
    return false;
  }
  bool fell_back = false;
  const double sum = set_laplacian_weights(flow, i, row, fell_back);
  const double own = has_air(flow) ? own_weight(flow, i, sum) : 0.0;
  if (sum + own <= 0.0) {
    row.finish_as_zero();  // a lone particle: nothing around it, no pressure
    return fell_back;
  }
  row.finish(sum + own, 0.0);
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

/// A dummy behind a row on the wall: the row's pressure beside it; 0 where no water is in reach of either.
template <int Dim>
void assemble_copy_of_row(Flow<Dim>& flow, std::size_t i) {
  PressureSystem::Row row = flow.pressure_system.row(i);
  const Pairs<Dim>& pairs = flow.pairs();
  const double sum = set_weights(pairs, i, row, [&](std::size_t k) {
    const auto j = pairs.j[k];
    return !flow.particles.is_fluid(j) && flow.is_wet[j] && flow.is_on_wall(j) ? pairs.W[k] : 0.0;
  });
  if (!flow.is_wet[i] || sum <= 0.0) {
    row.finish_as_zero();
    return;
  }
  row.finish(sum, 0.0);
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

}  // namespace

template <int Dim>
void assemble_weights(Flow<Dim>& flow, Interventions& interventions) {
  flow.pressure_system.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.neighbourhood.halo().plan);
  interventions.fallback_rows += count_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.has_equation(i)) return assemble_equation(flow, i);
    switch (flow.walls.treatment) {
      case WallTreatment::dummies:
        assemble_dummy_row(flow, i);
        break;
      case WallTreatment::pressure_rows:
        assemble_pressure_row(flow, i);
        break;
      case WallTreatment::row_and_dummies:
        assemble_copy_of_row(flow, i);
        break;
    }
    return false;
  });
}

template <int Dim>
void assemble(Flow<Dim>& flow, double dt, Interventions& interventions) {
  assemble_weights(flow, interventions);
  if (flow.scheme.source == SourceKind::mixed) {
    flow.wall_overlap.resize(flow.particles.owned);
    find_wall_overlap<Dim>(flow.pairs(), flow.boundary, flow.spacing, flow.particles, flow.wall_overlap);
  }
  for_each(flow.particles.owned, [&](std::size_t i) {
    if (flow.has_equation(i) && !flow.is_leaving(i)) flow.pressure_system.set_rhs(i, source_at(flow, i, dt));
  });
}

template <int Dim>
double density_source_work(const Flow<Dim>& flow, double dt) {
  if (flow.scheme.source != SourceKind::mixed) return 0.0;
  double work = 0.0;
  for (std::size_t i = 0; i < flow.particles.owned; ++i) {
    if (!flow.is_solved_for(i)) continue;
    const double expansion = density_source(flow, i, dt) * dt * dt / flow.density;  // dt div u
    work += flow.particles.pressure[i] * flow.particles.volume[i] * expansion;
  }
  return work;
}

template void assemble_weights<2>(Flow<2>&, Interventions&);
template void assemble_weights<3>(Flow<3>&, Interventions&);
template void assemble<2>(Flow<2>&, double, Interventions&);
template void assemble<3>(Flow<3>&, double, Interventions&);
template double density_source_work<2>(const Flow<2>&, double);
template double density_source_work<3>(const Flow<3>&, double);

}  // namespace tailwater
