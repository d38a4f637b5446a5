#include "published/row_and_dummies.h"

#include "base/for_each.h"
#include "published/on_wall.h"
#include "sampling/space_share.h"
#include "sampling/wall_particles.h"

namespace tailwater {
namespace {

/// Gives a dummy the pressure of the wall row beside it; 0 if the dummy or that row has no water in reach.
template <int Dim>
void assemble_copy_of_row(const WallScene<Dim>& scene, std::size_t i, LinearSystem::Row row) {
  const double sum = row.set_weights([&](std::size_t k) {
    const auto j = scene.pairs.j[k];
    const bool is_row = !scene.particles.is_fluid(j) && scene.surroundings.is_wet[j] &&
                        scene.walls.particles.is_on_wall(scene.particles.wall_row[j]);
    return is_row ? scene.pairs.value(i, k) : 0.0;
  });
  if (!scene.surroundings.is_wet[i] || sum <= 0.0) {
    row.finish_as_zero();
    return;
  }
  row.finish(sum, 0.0);
}

template <int Dim>
class RowAndDummies final : public OnWall<Dim> {
 public:
  WallTraits traits() const override { return {.solves_on_wall = true}; }

  WallParticles<Dim> make_particles(const Boundary<Dim>& boundary, double spacing, int layers, const SpaceShare& share,
                                    const Lattice<Dim>& /*lattice*/) const override {
    return make_row_and_dummy_particles(boundary, spacing, layers, share);
  }

  void assemble_rows(const WallScene<Dim>& scene, const WallForce<Dim>&, LinearSystem& system) const override {
    for_each(scene.pairs.owned(), [&](std::size_t i) {
      const bool has_equation =
          scene.particles.is_fluid(i) || scene.walls.particles.is_on_wall(scene.particles.wall_row[i]);
      if (!has_equation) assemble_copy_of_row(scene, i, system.row(i));
    });
  }
};

}  // namespace

template <int Dim>
std::unique_ptr<const WallModel<Dim>> make_row_and_dummies() {
  return std::make_unique<RowAndDummies<Dim>>();
}

TAILWATER_IN_2D_AND_3D(make_row_and_dummies);

}  // namespace tailwater
