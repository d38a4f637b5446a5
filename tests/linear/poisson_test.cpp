// A manufactured Poisson problem on particles in the unit square and cube: rows (F23) inside, given values on the faces
// but one, and on that one, y = 0, the gradient row (F39).
//
// Theory at fixed h/dx. Interior rows are exact for quadratics: truncation p'''' dx^2 on a lattice (odd moments
// vanish), p''' dx on jittered sets. Rows next to a face see half a neighbourhood, truncation p''' dx, but one layer of
// them with a given value next door contributes only dx^2 to the solution. The gradient row is exact for linear fields,
// truncation p'' dx, and a flux error contributes in full. So the solution has order 2 on a lattice and 1 on jittered
// sets where p'' vanishes on the Neumann face, and order 1 where it does not.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/dimensions.h"
#include "support/pressure_system.h"
#include "support/record.h"
#include "support/tensors.h"

namespace tailwater {
namespace poisson_test {
namespace {

constexpr double tolerance = 1e-9;

template <int Dim>
struct Problem {
  const char* name;
  double (*pressure)(const Vec<Dim>&);
  double (*laplacian)(const Vec<Dim>&);
  double (*normal_derivative)(const Vec<Dim>&);  // dp/dy at y = 0
};

double along(const Vec<2>& x) { return x[0]; }
double along(const Vec<3>& x) { return x[0] + 0.7 * x[2]; }

/// Square of the wave number of cos(2 along + 0.3).
template <int Dim>
constexpr double tangential = Dim == 2 ? 4.0 : 4.0 * (1.0 + 0.49);

/// p = cos(2 a + 0.3) sin(2 y): every second derivative but p_ay vanishes at y = 0, and p_ay has no part in a lattice's
/// normal derivative by symmetry.
template <int Dim>
Problem<Dim> straight_at_the_wall() {
  return {"straight", [](const Vec<Dim>& x) { return std::cos(2.0 * along(x) + 0.3) * std::sin(2.0 * x[1]); },
          [](const Vec<Dim>& x) {
            return -(tangential<Dim> + 4.0) * std::cos(2.0 * along(x) + 0.3) * std::sin(2.0 * x[1]);
          },
          [](const Vec<Dim>& x) { return 2.0 * std::cos(2.0 * along(x) + 0.3); }};
}

/// p = cos(2 a + 0.3) sin(2 y + 0.8): curved at the wall.
template <int Dim>
Problem<Dim> curved_at_the_wall() {
  return {"curved", [](const Vec<Dim>& x) { return std::cos(2.0 * along(x) + 0.3) * std::sin(2.0 * x[1] + 0.8); },
          [](const Vec<Dim>& x) {
            return -(tangential<Dim> + 4.0) * std::cos(2.0 * along(x) + 0.3) * std::sin(2.0 * x[1] + 0.8);
          },
          [](const Vec<Dim>& x) { return 2.0 * std::cos(2.0 * along(x) + 0.3) * std::cos(2.0 * x[1] + 0.8); }};
}

enum class Place { inside, neumann, dirichlet };

template <int Dim>
Place place_of(const Vec<Dim>& x) {
  constexpr double close = 1e-9;
  for (int d = 0; d < Dim; ++d) {
    if (x[d] > 1.0 - close || (d != 1 && x[d] < close)) return Place::dirichlet;
  }
  return x[1] < close ? Place::neumann : Place::inside;
}

/// rms error of the solution with n intervals per edge; particles inside are moved by up to jitter dx.
template <int Dim>
double solution_error(const Problem<Dim>& problem, int n, double jitter) {
  const double dx = 1.0 / n;
  std::array<int, Dim> count;
  count.fill(n + 1);
  std::vector<Vec<Dim>> points = lattice_points<Dim>(Vec<Dim>::Zero(), count, dx);
  Noise noise(31);
  for (Vec<Dim>& point : points) {
    if (place_of<Dim>(point) == Place::inside) point += jitter * dx * noise.vector<Dim>();
  }
  const ParticleSet<Dim> set(points, make_kernel<Dim>(KernelName::farzin, 3.0 * dx), dx);
  const ConsistentOperators<Dim> operators(set);
  const Pairs<Dim>& pairs = set.pairs();

  PressureSolverTable settings;
  settings.tolerance = tolerance;
  settings.method = KrylovMethod::gmres;
  PressureSystem system(settings);
  system.set_pattern(pairs.row_begin, pairs.j);
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Vec<Dim>& x = set.position(i);
    PressureSystem::Row row = system.row(i);
    const auto set_row = [&](auto&& weight) { return row.set_weights(weight); };
    switch (place_of<Dim>(x)) {
      case Place::dirichlet:
        set_row([](std::size_t) { return 0.0; });
        row.finish(1.0, problem.pressure(x));
        break;
      case Place::neumann: {
        const double sum = set_row([&](std::size_t k) {
          return consistent_gradient_weight<Dim>(operators.tensors[i].B1, set.particles.volume[pairs.j[k]],
                                                 pairs.e(i, k), pairs.r(i, k), pairs.value(i, k))[1];
        });
        row.finish(sum, -problem.normal_derivative(x));
        break;
      }
      case Place::inside: {
        const double sum = set_row([&](std::size_t k) { return operators.laplacian_weight(i, k); });
        row.finish(sum, -problem.laplacian(x));
        break;
      }
    }
  }
  std::vector<double> solution(set.size(), 0.0);
  system.solve(solution);
  double squares = 0.0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    squares += std::pow(solution[i] - problem.pressure(set.position(i)), 2);
  }
  const double error = std::sqrt(squares / static_cast<double>(set.size()));
  const std::string set_name = jitter > 0.0 ? fmt::format("jitter{:g}", jitter) : "regular";
  record_error(fmt::format("poisson_{}_{}", problem.name, set_name), Dim, dx, error);
  return error;
}

template <int Dim>
double observed_order(const Problem<Dim>& problem, double jitter) {
  const int n = Dim == 2 ? 20 : 10;
  return std::log2(solution_error<Dim>(problem, n, jitter) / solution_error<Dim>(problem, 2 * n, jitter));
}

template <class D>
class PoissonTest : public testing::Test {};
TYPED_TEST_SUITE(PoissonTest, Dimensions);

// Margins: with R = 3 dx = 0.15 (0.3 in 3D) on the coarse set the next term of the error is up to k R = 0.3 (0.6) of
// the first, which shifts an observed order by up to log2(1.3/1.15) = 0.2 (0.3); jittered sets of two sizes also differ
// by chance. Theory's 2 is asserted as 1.5, its 1 as 0.8.
TYPED_TEST(PoissonTest, SecondOrderOnALattice) {
  constexpr int Dim = TypeParam::value;
  EXPECT_GT(observed_order<Dim>(straight_at_the_wall<Dim>(), 0.0), 1.5);
}

TYPED_TEST(PoissonTest, FirstOrderOnALatticeWherePressureCurvesAtTheNeumannFace) {
  constexpr int Dim = TypeParam::value;
  EXPECT_GT(observed_order<Dim>(curved_at_the_wall<Dim>(), 0.0), 0.8);
}

TYPED_TEST(PoissonTest, FirstOrderOnJitteredSets) {
  constexpr int Dim = TypeParam::value;
  for (const double jitter : {0.1, 0.3}) {
    EXPECT_GT(observed_order<Dim>(straight_at_the_wall<Dim>(), jitter), 0.8) << "jitter " << jitter;
    EXPECT_GT(observed_order<Dim>(curved_at_the_wall<Dim>(), jitter), 0.8) << "jitter " << jitter;
  }
}

}  // namespace
}  // namespace poisson_test
}  // namespace tailwater
