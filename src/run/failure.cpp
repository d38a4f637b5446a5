#include "run/failure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>

#include "base/for_each.h"
#include "flow/pressure_equation.h"
#include "geometry/from_spec.h"
#include "io/vtp_writer.h"
#include "io/write_file.h"
#include "neighbours/neighbourhood.h"
#include "parallel/together.h"
#include "results/field_output.h"

namespace tailwater {
namespace {

template <int Dim>
std::string describe_particle(const Particles<Dim>& particles, std::size_t i) {
  return fmt::format("id {:8}  {}  at {} m  velocity {} m/s  pressure {:.6g} Pa", particles.id[i],
                     particles.is_fluid(i) ? "fluid" : "wall ", place<Dim>(particles.position[i]),
                     place<Dim>(particles.velocity[i]), particles.pressure[i]);
}

/// Call where the flow has lists; a step that is refused before its neighbour search has none.
template <int Dim>
void list_neighbours(const Flow<Dim>& flow, const Particles<Dim>& last_good, std::size_t i, std::string& report) {
  auto out = std::back_inserter(report);
  fmt::format_to(out, "its neighbours before the step:\n");
  const Pairs<Dim>& pairs = flow.pairs();
  for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
    const auto j = static_cast<std::size_t>(pairs.j[k]);
    if (j < last_good.owned) {
      fmt::format_to(out, "  {}\n", describe_particle(last_good, j));
    } else {
      fmt::format_to(out, "  {}  (a ghost, after the step)\n", describe_particle(flow.state.particles, j));
    }
  }
}

}  // namespace

template <int Dim>
std::optional<std::size_t> find_non_finite(const Flow<Dim>& flow) {
  const Particles<Dim>& particles = flow.state.particles;
  const std::span<const double> source = flow.equation->rows.rhs();
  const std::vector<std::size_t> found = indices_where(particles.owned, [&](std::size_t i) {
    return particles.is_fluid(i) &&
           (!particles.position[i].allFinite() || !particles.velocity[i].allFinite() ||
            !std::isfinite(particles.pressure[i]) || (i < source.size() && !std::isfinite(source[i])));
  });
  if (found.empty()) return std::nullopt;
  return found.front();
}

template <int Dim>
void write_failure(const RunFolder& folder, const Flow<Dim>& flow, const Particles<Dim>& last_good,
                   double last_good_time, std::optional<std::size_t> culprit, const std::string& message) {
  std::filesystem::path failure;
  do_together(flow.setup.ranks, [&] { failure = folder.make_failure(); });
  // Only positions, velocities and pressures: the work fields are those of the failed step.
  const FluidFields<Dim> fields(flow, last_good, {"pressure", "velocity", "id"});
  write_vtp(failure / "last_good.vtp", last_good_time, encode_piece(fields.view(), 1), 1, flow.setup.ranks);

  std::string report;
  if (culprit) {
    const std::size_t i = *culprit;
    auto out = std::back_inserter(report);
    if (flow.state.time > last_good_time) {
      fmt::format_to(out, "particle after the step:  {}\n", describe_particle(flow.state.particles, i));
    }
    fmt::format_to(out, "particle before the step: {}\n", describe_particle(last_good, i));
    if (flow.neighbourhood->has_pairs()) list_neighbours(flow, last_good, i, report);
  }
  const std::vector<std::string> reports = flow.setup.ranks.gather(report);
  do_on_root(flow.setup.ranks,
             [&] { write_text_file(failure / "report.txt", fmt::format("{}\n{}", message, fmt::join(reports, ""))); });
}

TAILWATER_IN_2D_AND_3D(find_non_finite);
TAILWATER_IN_2D_AND_3D(write_failure);

}  // namespace tailwater
