#include "sampling/wall_bodies.h"

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "sampling/lone_body.h"

namespace tailwater {
namespace {

/// Fraction of half a cell. A plate that cuts off less than this does not divide the cell.
constexpr double min_part = 0.05;

/// Appends `part` to `all`. Earlier parts have taken `on_wall` of the numbers for particles on the wall, and `behind`
/// of those for particles behind it.
template <int Dim>
void append(WallParticles<Dim>& all, WallParticles<Dim> part, std::int64_t on_wall, std::int64_t behind) {
  for (std::int64_t& number : part.number) {
    number += number < part.numbers_on_wall ? on_wall : all.numbers_on_wall + behind - part.numbers_on_wall;
  }
  if (all.size() == 0) {
    part.numbers = all.numbers;
    part.numbers_on_wall = all.numbers_on_wall;
    all = std::move(part);
    return;
  }
  const auto put = [](auto& into, const auto& entries) { into.insert(into.end(), entries.begin(), entries.end()); };
  all.apply_to_fields(
      [&](auto&... into) { part.apply_to_fields([&](const auto&... entries) { (put(into, entries), ...); }); });
}

/// The screen of a plate that is nearer to `x` than `distance` and extends behind the wall of `x`; null without one.
template <int Dim>
const Screen<Dim>* plate_through(const Boundary<Dim>& boundary, const Vec<Dim>& x, double distance) {
  for (const int s : boundary.screens_near(x, distance)) {
    const Screen<Dim>& screen = boundary.screens[s];
    if (screen.is_plate && !screen.is_beyond && screen.distance(x) < distance) return &screen;
  }
  return nullptr;
}

// The functions that sample a body in each dimension.
WallParticles<2> sample(const LoneBody<2>& body, const WallLayers& layers, const Lattice<2>& /*lattice*/) {
  return sample_chains(body.boundary, layers);
}
WallParticles<3> sample(const LoneBody<3>& body, const WallLayers& layers, const Lattice<3>& lattice) {
  WallParticleCollector<3> collector(body.boundary, layers);
  sample_boxes(body.boundary, layers, collector);
  sample_meshes(body.boundary, body.meshes, layers, lattice, collector);
  return std::move(collector).particles();
}

}  // namespace

template <int Dim>
WallParticles<Dim> joined(std::vector<WallParticles<Dim>> parts) {
  WallParticles<Dim> all;
  for (const WallParticles<Dim>& part : parts) {
    all.numbers += part.numbers;
    all.numbers_on_wall += part.numbers_on_wall;
  }
  std::int64_t on_wall = 0;
  std::int64_t behind = 0;
  for (WallParticles<Dim>& part : parts) {
    const std::int64_t more_on_wall = part.numbers_on_wall;
    const std::int64_t more_behind = part.numbers - part.numbers_on_wall;
    append(all, std::move(part), on_wall, behind);
    on_wall += more_on_wall;
    behind += more_behind;
  }
  all.apply_to_fields([](auto&... field) { (field.shrink_to_fit(), ...); });
  return all;
}

template <int Dim>
WallParticles<Dim> sample_bodies(const Boundary<Dim>& boundary, const WallLayers& layers, const Lattice<Dim>& lattice) {
  std::set<int> bodies;
  for (const WallProperties& wall : boundary.walls) bodies.insert(wall.body);
  std::vector<WallParticles<Dim>> parts;
  for (const int body : bodies)
    parts.push_back(sample(body_alone(boundary, body, reach_to_wall * layers.spacing),
                           layers.of_wall(body != resting_body), lattice));
  for (WallParticles<Dim>& side : sample_plates<Dim>(boundary, layers, lattice)) parts.push_back(std::move(side));
  if constexpr (Dim == 2) {
    // Plates and free ends have no particles on the wall itself.
    if (!layers.starts_on_wall) {
      for (WallParticles<2>& beyond : sample_beyond_ends(boundary, layers)) parts.push_back(std::move(beyond));
    }
  }
  return joined(std::move(parts));
}

template <int Dim>
void append_part(WallParticles<Dim>& parts, const WallParticles<Dim>& whole, std::size_t row, const Vec<Dim>& position,
                 double share, std::int64_t number) {
  parts.apply_to_fields(
      [&](auto&... into) { whole.apply_to_fields([&](const auto&... from) { (into.push_back(from[row]), ...); }); });
  parts.position.back() = position;
  parts.share.back() = share;
  parts.number.back() = number;
}

template <int Dim>
void cut_by_plates(const Boundary<Dim>& boundary, double spacing, WallParticles<Dim>& particles) {
  if (boundary.plates.empty()) return;
  WallParticles<Dim> cut;
  cut.numbers = 2 * particles.numbers;
  cut.numbers_on_wall = 2 * particles.numbers_on_wall;
  for (std::size_t row = 0; row < particles.size(); ++row) {
    const Vec<Dim>& x = particles.position[row];
    const double half = 0.5 * spacing * std::pow(particles.share[row], 1.0 / (Dim - 1));
    const bool is_of_plate = boundary.walls[particles.wall[row]].is_plate;
    const Screen<Dim>* plate = is_of_plate ? nullptr : plate_through(boundary, x, (1.0 - min_part) * half);
    if (plate == nullptr) {
      append_part(cut, particles, row, x, particles.share[row], 2 * particles.number[row]);
      continue;
    }
    const double height = plate->height(x);
    for (const int part : {0, 1}) {
      const double side = part == 0 ? half : -half;
      const Vec<Dim> middle = x + 0.5 * (side - height) * plate->normal;
      const double share = particles.share[row] * 0.5 * (1.0 + height / side);
      append_part(cut, particles, row, middle, share, 2 * particles.number[row] + part);
    }
  }
  particles = std::move(cut);
}

TAILWATER_IN_2D_AND_3D(joined);
TAILWATER_IN_2D_AND_3D(sample_bodies);
TAILWATER_IN_2D_AND_3D(append_part);
TAILWATER_IN_2D_AND_3D(cut_by_plates);

}  // namespace tailwater
