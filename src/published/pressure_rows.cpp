#include "published/pressure_rows.h"

#include "base/for_each.h"
#include "published/gradient_consistent.h"
#include "published/on_wall.h"
#include "sampling/space_share.h"
#include "sampling/wall_particles.h"

namespace tailwater {
namespace {

template <int Dim>
void assemble_wall_row(const WallScene<Dim>& scene, const Renormalisation<Dim>& tensors, const WallForce<Dim>& force,
                       std::size_t i, LinearSystem::Row row) {
  if (!scene.surroundings.is_wet[i] || !tensors.gradient_is_sound()) {
    row.finish_as_zero();
    return;
  }
  const Pairs<Dim>& pairs = scene.pairs;
  const auto wall_row = scene.particles.wall_row[i];
  const Vec<Dim> normal = scene.walls.particles.normal[wall_row];
  const double sum = row.set_weights([&](std::size_t k) {
    if (!scene.surroundings.takes_part[pairs.j[k]]) return 0.0;
    return consistent_gradient_weight<Dim>(tensors.B1, scene.particles.volume[pairs.j[k]], pairs.e(i, k), pairs.r(i, k),
                                           pairs.value(i, k))
        .dot(normal);
  });
  if (sum <= 0.0) {
    row.finish_as_zero();
    return;
  }
  row.finish(sum, -force.density * force.felt(wall_row).dot(normal));  // (F39)
}

template <int Dim>
class PressureRows final : public OnWall<Dim> {
 public:
  explicit PressureRows(std::shared_ptr<const Tensors<Dim>> tensors) : tensors_(std::move(tensors)) {}

  WallTraits traits() const override { return {}; }

  WallParticles<Dim> make_particles(const Boundary<Dim>& boundary, double spacing, int /*layers*/,
                                    const SpaceShare& share, const Lattice<Dim>& /*lattice*/) const override {
    return make_surface_particles(boundary, spacing, share);
  }

  void assemble_rows(const WallScene<Dim>& scene, const WallForce<Dim>& force, LinearSystem& system) const override {
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      if (!scene.particles.is_fluid(i)) assemble_wall_row(scene, (*tensors_)[i], force, i, system.row(i));
    });
  }

 private:
  std::shared_ptr<const Tensors<Dim>> tensors_;
};

}  // namespace

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_pressure_rows(std::shared_ptr<const Tensors<Dim>> tensors) {
  return std::make_unique<PressureRows<Dim>>(std::move(tensors));
}

TAILWATER_IN_2D_AND_3D(make_pressure_rows);

}  // namespace tailwater
