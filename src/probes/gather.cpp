#include "probes/gather.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "base/box.h"
#include "base/for_each.h"

namespace tailwater {
namespace {

/// The data of a particle that probes read, as sent between ranks.
template <int Dim>
struct Sample {
  std::int64_t id;
  std::array<double, Dim> position;
  std::array<double, Dim> velocity;
  double pressure;
  double volume;
  ParticleKind kind;
  std::int32_t plate;
  std::array<double, Dim * Dim> blocked;
  std::array<double, Dim> acceleration;

  /// Copies of a particle on several ranks have equal keys; periodic images differ in position.
  auto key() const { return std::tie(id, position); }
};

template <int Dim>
std::array<double, Dim> to_array(const Vec<Dim>& v) {
  std::array<double, Dim> values;
  std::copy(v.begin(), v.end(), values.begin());
  return values;
}

template <int Dim>
std::array<double, Dim * Dim> to_array(const Mat<Dim>& m) {
  std::array<double, Dim * Dim> values;
  std::copy(m.data(), m.data() + values.size(), values.begin());
  return values;
}

}  // namespace

template <int Dim>
GatheredParticles<Dim> gather_near(const ProbeContext<Dim>& context, const std::vector<Region<Dim>>& regions) {
  const Particles<Dim>& particles = context.particles;
  const double reach = kernel_radius(context.kernel);
  std::vector<Box<Dim>> boxes;  // a quick test: most places are outside all of them
  for (const Region<Dim>& region : regions) boxes.push_back(region.box(reach));
  const auto is_near = [&](std::size_t i) {
    const Vec<Dim>& x = particles.position[i];
    for (std::size_t k = 0; k < regions.size(); ++k) {
      if (boxes[k].contains(x) && regions[k].contains(x, reach)) return true;
    }
    return false;
  };
  std::vector<Sample<Dim>> near;
  const WallInertia<Dim>* inertia = context.wall_inertia;
  for (const std::size_t i : indices_where(particles.size(), is_near)) {
    const bool has_inertia = inertia != nullptr && !particles.is_fluid(i);
    near.push_back({particles.id[i], to_array<Dim>(particles.position[i]), to_array<Dim>(particles.velocity[i]),
                    particles.pressure[i], particles.volume[i], particles.kind[i],
                    context.felt_through.empty() ? -1 : context.felt_through[i],
                    to_array<Dim>(has_inertia ? inertia->blocked[particles.wall_row[i]] : Mat<Dim>(Mat<Dim>::Zero())),
                    to_array<Dim>(has_inertia ? inertia->acceleration_at(particles, i) : Vec<Dim>(Vec<Dim>::Zero()))});
  }
  near = context.ranks.gather(near);
  std::sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.key() < b.key(); });
  near.erase(std::unique(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.key() == b.key(); }),
             near.end());

  GatheredParticles<Dim> result;
  result.felt_through.resize(near.size());
  if (inertia != nullptr) {
    result.blocked.resize(near.size());
    result.acceleration.resize(near.size());
  }
  Particles<Dim>& gathered = result.particles;
  gathered.resize(near.size());
  gathered.owned = near.size();
  for_each(near.size(), [&](std::size_t i) {
    gathered.position[i] = Vec<Dim>::Map(near[i].position.data());
    gathered.velocity[i] = Vec<Dim>::Map(near[i].velocity.data());
    gathered.pressure[i] = near[i].pressure;
    gathered.volume[i] = near[i].volume;
    gathered.kind[i] = near[i].kind;
    gathered.wall_row[i] = near[i].kind == ParticleKind::fluid ? -1 : static_cast<std::int32_t>(i);
    result.felt_through[i] = near[i].plate;
    gathered.id[i] = near[i].id;
    if (inertia == nullptr) return;
    result.blocked[i] = Mat<Dim>::Map(near[i].blocked.data());
    result.acceleration[i] = Vec<Dim>::Map(near[i].acceleration.data());
  });
  return result;
}

TAILWATER_IN_2D_AND_3D(gather_near);

}  // namespace tailwater
