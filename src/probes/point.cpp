#include "probes/point.h"

#include <Eigen/Cholesky>

#include <optional>

#include "base/eigen.h"
#include "case/rheology.h"
#include "probes/places.h"
#include "probes/water_share.h"

namespace tailwater {
namespace {

/// On a lattice with support 3 dx the reciprocal condition number of M is 0.07 to 0.10 inside the fluid, above 0.01 on
/// a flat surface and above 0.007 in a corner of one. Far below that the weights of single particles, and with them
/// their noise, grow without bound.
constexpr double min_reciprocal_condition = 1e-3;

template <int Dim>
using Moments = Mat<Dim + 1>;
template <int Dim>
using Basis = Vec<Dim + 1>;

template <int Dim>
Basis<Dim> basis(const ProbeContext<Dim>& context, const Vec<Dim>& x, std::int32_t j) {
  Basis<Dim> q;
  q[0] = 1.0;
  q.put(1, (context.particles.position[j] - x) / kernel_radius(context.kernel));
  return q;
}

/// The coefficients a of the fit at `x`, where there is fluid.
template <int Dim>
Basis<Dim> fit(const ProbeContext<Dim>& context, const Vec<Dim>& x) {
  Moments<Dim> moments = Moments<Dim>::Zero();
  for_each_weight(context, x, [&](std::int32_t j, double weight) {
    if (!context.particles.is_fluid(j)) return;
    const Basis<Dim> q = basis(context, x, j);
    moments += weight * q * q.transpose();
  });
  const Basis<Dim> first = Basis<Dim>::UnitX();
  const Eigen::LDLT<Eigen::Matrix<double, Dim + 1, Dim + 1>> factors(to_eigen(moments));
  return factors.rcond() > min_reciprocal_condition ? from_eigen<Dim + 1, 1>(factors.solve(to_eigen(first)))
                                                    : first / moments(0, 0);
}

/// f at `x`, where there is fluid; `zero` is the initial value of the sum.
template <int Dim, class Value>
Value interpolate(const ProbeContext<Dim>& context, const Vec<Dim>& x, const std::vector<Value>& f, const Value& zero) {
  const Basis<Dim> a = fit(context, x);
  Value sum = zero;
  for_each_weight(context, x, [&](std::int32_t j, double weight) {
    if (context.particles.is_fluid(j)) sum += weight * a.dot(basis(context, x, j)) * f[j];
  });
  return sum;
}

/// (G)_ab = du_a/dx_b [1/s] of the measured liquid at `x`, where there is some; 0 where the neighbours do not span
/// space.
template <int Dim>
Mat<Dim> velocity_gradient_at(const ProbeContext<Dim>& context, const Vec<Dim>& x) {
  Moments<Dim> moments = Moments<Dim>::Zero();
  Eigen::Matrix<double, Dim + 1, Dim> sums = Eigen::Matrix<double, Dim + 1, Dim>::Zero();
  for_each_weight(context, x, [&](std::int32_t j, double weight) {
    if (!context.is_measured(j)) return;
    const Basis<Dim> q = basis(context, x, j);
    moments += weight * q * q.transpose();
    for (int a = 0; a < Dim; ++a) sums.col(a) += weight * context.particles.velocity[j][a] * to_eigen(q);
  });
  const Eigen::LDLT<Eigen::Matrix<double, Dim + 1, Dim + 1>> factors(to_eigen(moments));
  Mat<Dim> gradient = Mat<Dim>::Zero();
  if (factors.rcond() <= min_reciprocal_condition) return gradient;
  const Eigen::Matrix<double, Dim + 1, Dim> linear = factors.solve(sums);
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) gradient(a, b) = linear(b + 1, a) / kernel_radius(context.kernel);
  }
  return gradient;
}

}  // namespace

template <int Dim>
Vec<Dim> velocity_at(const ProbeContext<Dim>& context, const Vec<Dim>& x) {
  bool has_fluid = false;
  for_each_weight(context, x, [&](std::int32_t j, double) { has_fluid |= context.particles.is_fluid(j); });
  const Vec<Dim> zero = Vec<Dim>::Zero();
  return has_fluid ? interpolate(context, x, context.particles.velocity, zero) : zero;
}

template <int Dim>
Reading<Dim> pressure_reading(const ProbeTable& probe) {
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  return {columns_of(probe, Dim),
          [at](const ProbeContext<Dim>& context) -> std::vector<Row> {
            if (water_share(context, at) <= surface_share) return {{context.air_pressure_at(at), 0.0}};
            return {{interpolate(context, at, context.particles.pressure, 0.0), 1.0}};
          },
          [at](double) {
            return Region<Dim>{at, at};
          }};
}

template <int Dim>
Reading<Dim> velocity_reading(const ProbeTable& probe, const CaseSpec& spec) {
  const Vec<Dim> at = to_vec<Dim>(probe.at, label(probe), "at");
  std::optional<LiquidTable> liquid;
  if (!probe.liquid.empty()) liquid = spec.liquids[static_cast<std::size_t>(index_of_liquid(spec, probe.liquid))];
  const std::vector<OutputColumn> columns = columns_of(probe, Dim);
  return {columns,
          [at, liquid, count = columns.size()](const ProbeContext<Dim>& context) -> std::vector<Row> {
            Row row(count, 0.0);
            if (water_share(context, at) <= surface_share) return {row};
            const Vec<Dim> u = velocity_at(context, at);
            std::copy(u.begin(), u.end(), row.begin());
            row[Dim] = 1.0;
            if (!liquid) return {row};
            const Mat<Dim> G = velocity_gradient_at(context, at);
            const double shear_rate = std::sqrt(0.5 * (G + G.transpose()).squaredNorm());
            const double viscosity = viscosity_at(*liquid, shear_rate);
            row[Dim + 1] = shear_rate;
            row[Dim + 2] = viscosity;
            row[Dim + 3] = viscosity * shear_rate;
            return {row};
          },
          [at](double) {
            return Region<Dim>{at, at};
          }};
}

TAILWATER_IN_2D_AND_3D(velocity_at);
TAILWATER_IN_2D_AND_3D(pressure_reading);
TAILWATER_IN_2D_AND_3D(velocity_reading);

}  // namespace tailwater
