#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/checks/checks.h"
#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// How far from a whole number of spacings (in spacings) a box may be without a warning.
constexpr double tolerated_misfit = 1e-3;

/// The spacing nearest to dx that divides every extent of a box. If there is none, one that divides `extent`.
double fitting_spacing(const FluidTable& block, double extent, double dx) {
  double best = extent / std::max(1.0, std::round(extent / dx));
  double best_change = std::numeric_limits<double>::infinity();
  for (double cells = std::max(1.0, std::floor(0.8 * extent / dx)); cells <= 1.25 * extent / dx + 1.0; ++cells) {
    const double candidate = extent / cells;
    bool fits = true;
    for (std::size_t axis = 0; axis < block.min.size(); ++axis) {
      const double n = (block.max[axis] - block.min[axis]) / candidate;
      fits = fits && std::abs(n - std::round(n)) < 1e-6 * n;
    }
    if (fits && std::abs(candidate - dx) < best_change) {
      best = candidate;
      best_change = std::abs(candidate - dx);
    }
  }
  return best;
}

template <int Dim>
void check_polygon(const FluidTable& block, const std::string& label, std::size_t particles, double dx,
                   Findings& findings) {
  if (particles > 0) return;
  findings.push_back(Finding::error(
      "{} at {} holds no particle: its area is {:.3g} m^2 and the spacing is {:.6g} m; use a smaller spacing, or "
      "correct the block's points",
      label, place(to_vec<Dim>(block.points[0], label, "points[0]")), std::abs(signed_area(block.points)), dx));
}

template <int Dim>
void check_box(const FluidTable& block, const std::string& label, std::size_t particles, double dx,
               Findings& findings) {
  const Vec<Dim> low = to_vec<Dim>(block.min, label, "min");
  const Vec<Dim> extent = to_vec<Dim>(block.max, label, "max") - low;
  int smallest = 0;
  extent.minCoeff(&smallest);
  if (particles == 0 || extent[smallest] < (1.0 - corner_tolerance) * dx) {
    findings.push_back(Finding::error(
        "{} at {} is {:.6g} m long in {}, so it holds no particle of spacing {:.6g} m: use a spacing of at most "
        "{:.6g} m, or a larger block",
        label, place(low), extent[smallest], "xyz"[smallest], dx, extent[smallest]));
    return;
  }
  for (int axis = 0; axis < Dim; ++axis) {
    const double cells = extent[axis] / dx;
    if (std::abs(cells - std::round(cells)) <= tolerated_misfit) continue;
    findings.push_back(Finding::warning(
        "{} at {} is {:.6g} m long in {}, which is {:.2f} spacings: its particles fill {:.6g} m; a spacing of {:.6g} m "
        "fits",
        label, place(low), extent[axis], "xyz"[axis], cells, std::round(cells) * dx,
        fitting_spacing(block, extent[axis], dx)));
  }
}

}  // namespace

template <int Dim>
Findings check_blocks(const CaseSpec& spec, const FluidParticles<Dim>& fluid) {
  if (spec.fluid.empty()) return {Finding::error("there is no fluid: add a [[fluid]] table")};
  std::vector<std::size_t> particles(spec.fluid.size(), 0);
  for (const int block : fluid.block) ++particles[block];
  Findings findings;
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const auto check = spec.fluid[b].shape == BlockShape::polygon ? check_polygon<Dim> : check_box<Dim>;
    check(spec.fluid[b], fluid_label(spec, b), particles[b], spec.particles.spacing, findings);
  }
  return findings;
}

template Findings check_blocks(const CaseSpec&, const FluidParticles<2>&);
template Findings check_blocks(const CaseSpec&, const FluidParticles<3>&);

}  // namespace tailwater
