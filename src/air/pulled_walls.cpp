#include "air/pulled_walls.h"

#include <algorithm>

#include "case/largest_tension.h"
#include "geometry/from_spec.h"
#include "io/messages.h"
#include "pressure/tension.h"

namespace tailwater {
namespace {

/// Mean tension over the mean pressure on all wet walls, from which a wall counts. In a full conduit that empties it is
/// 1 and more; crests, lips and weirs have it on a few spacings only.
constexpr double least_share_of_pressure = 0.5;

/// Fraction of the time in which a wall would pull, from which it counts. Water that starts away from a wall pulls in
/// the first steps only.
constexpr double least_share_of_time = 0.2;

/// [dx]; edge of the area from which a run warns. In the cases of the tree, up to 5 spacings pull without harm.
constexpr double edge_of_area = 15.0;

}  // namespace

template <int Dim>
PulledWalls<Dim>::PulledWalls(const CaseSpec& spec)
    : spacing_(spec.particles.spacing), tension_(spec.physics.tension), layers_(dummy_layers(spec)) {}

template <int Dim>
void PulledWalls<Dim>::see_tension(const Flow<Dim>& flow, std::span<const double> pressure,
                                   const std::vector<double>& allowed) {
  readings_.clear();
  const Particles<Dim>& particles = flow.state.particles;
  const WallParticles<Dim>& rows = flow.walls.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: the readings are a list
    if (particles.is_fluid(i) || !flow.surroundings.is_wet[i]) continue;
    const auto row = static_cast<std::size_t>(particles.wall_row[i]);
    // Water leaves sharp edges whether walls hold it or not.
    if (rows.is_beyond_end[row] != 0 || !rows.beyond_edges[row].isZero(0.0)) continue;
    readings_.push_back({particles.wall_row[i], static_cast<float>(pressure[i] - min_pressure(flow, allowed, i))});
  }
}

template <int Dim>
void PulledWalls<Dim>::finish_step(Flow<Dim>& flow, const StepStart<Dim>& /*start*/, double dt) {
  const auto time = static_cast<float>(dt);
  for (const Reading& reading : readings_) {  // in order: sums over rows
    Record& record = records_[flow.walls.particles.number[reading.row]];
    record.wet += time;
    record.pull -= time * std::min(0.0F, reading.pressure);
    record.pulls += reading.pressure < 0.0F ? time : 0.0F;
    const double area = area_of(flow, reading.row);
    pressed_ += dt * area * std::max(0.0F, reading.pressure);
    wet_ += dt * area;
  }
  time_ += dt;
}

/// m^(Dim-1); of a wall, for which a row stands with those of the other layers.
template <int Dim>
double PulledWalls<Dim>::area_of(const Flow<Dim>& flow, std::size_t row) const {
  return flow.walls.particles.share[row] * power<Dim>(spacing_) / (layers_ * spacing_);
}

template <int Dim>
Pull<Dim> PulledWalls<Dim>::find(const Flow<Dim>& flow) const {
  const Communicator& ranks = flow.setup.ranks;
  double pressed = pressed_;
  double wet = wet_;
  ranks.sum_each(pressed, wet);
  Pull<Dim> pull;
  if (wet == 0.0) return pull;
  const WallParticles<Dim>& rows = flow.walls.particles;
  for (std::size_t row = 0; row < flow.walls.kept; ++row) {  // in order: sums over rows
    const auto known = records_.find(rows.number[row]);
    if (known == records_.end()) continue;
    const Record& record = known->second;
    const double mean = record.pull / record.wet;
    if (record.pulls < least_share_of_time * time_ || mean * wet < least_share_of_pressure * pressed) continue;
    pull.area += area_of(flow, row);
    if (mean > pull.tension) {
      pull.tension = mean;
      pull.where = rows.position[row];
    }
  }
  const std::vector<Pull<Dim>> of_ranks = ranks.all_gather(pull);
  pull = *std::ranges::max_element(of_ranks, {}, &Pull<Dim>::tension);
  pull.area = 0.0;
  for (const Pull<Dim>& own : of_ranks) pull.area += own.area;
  return pull;
}

template <int Dim>
void PulledWalls<Dim>::warn_at_end(const Flow<Dim>& flow) const {
  const Pull<Dim> pull = find(flow);
  const double edge = edge_of_area * spacing_;
  if (pull.area * edge < power<Dim>(edge)) return;
  tailwater::warn("walls-cannot-hold-water",
                  "{:.3g} {} of the walls would have to hold the water with tension, of {:.0f} Pa around {}, but walls "
                  "hold {:g} Pa; the water separates there as if air came in. Remedy: if no air can come in, as in a "
                  "full conduit, give physics.tension = {:.0f}",
                  pull.area, Dim == 2 ? "m" : "m^2", pull.tension, place(pull.where).text(), tension_,
                  std::min(largest_tension, 2.0 * pull.tension + tension_));
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_pulled_walls(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& /*boundary*/) {
  if (!setup.has_air()) return nullptr;
  return std::make_unique<PulledWalls<Dim>>(spec);
}

template class PulledWalls<2>;
template class PulledWalls<3>;
TAILWATER_IN_2D_AND_3D(make_pulled_walls);

}  // namespace tailwater
