#include "bodies/fixed_hulls.h"

#include <algorithm>
#include <cstdint>

#include "air/enclosed_air.h"
#include "base/for_each.h"
#include "case/formulation.h"
#include "flow/drawing.h"
#include "flow/pressure_equation.h"
#include "geometry/facing.h"
#include "geometry/some_walls.h"

namespace tailwater {
namespace {

/// The hull of each of `count` walls, or -1.
std::vector<int> hull_of_each(std::size_t count, const std::vector<int>& hulls) {
  std::vector<int> hull_of_wall(count, -1);
  for (std::size_t k = 0; k < hulls.size(); ++k) hull_of_wall[hulls[k]] = static_cast<int>(k);
  return hull_of_wall;
}

/// dx; width below which no particle enters a gap.
constexpr double empty_gap = 0.5;

/// Counts the space of empty gaps beside hulls as wall: the particles of the hull's first layer, dx thick, take the
/// volume of the gap in front of them. Otherwise the kernel has a hole there, into which a uniform pressure pushes the
/// water beside the gap (docs/theory/probes.md).
template <int Dim>
void fill_empty_gaps(Flow<Dim>& flow, const std::vector<int>& hull_of_wall) {
  const Boundary<Dim>& boundary = flow.walls.boundary;
  const double dx = flow.setup.scale.spacing;
  WallParticles<Dim>& rows = flow.walls.particles;
  std::vector<double> growth(rows.size(), 1.0);
  for (std::size_t wall = 0; wall < hull_of_wall.size(); ++wall) {
    if (hull_of_wall[wall] < 0) continue;
    std::vector<std::uint8_t> is_own(boundary.walls.size(), 0), is_other(boundary.walls.size(), 0);
    for (std::size_t w = 0; w < is_own.size(); ++w) {
      is_own[w] = w == wall ? 1 : 0;
      is_other[w] = w == wall || boundary.walls[w].is_plate ? 0 : 1;
    }
    for_each(rows.size(), [&](std::size_t row) {
      if (rows.wall[row] != static_cast<int>(wall)) return;
      const NearestWall<Dim> own = nearest_among<Dim>(boundary, is_own, rows.position[row], dx);
      if (own.face < 0 || own.signed_distance > 0.0) return;
      const NearestWall<Dim> other = nearest_among<Dim>(boundary, is_other, own.point, empty_gap * dx);
      const double width = other.signed_distance / dx;
      if (other.face < 0 || width <= 0.0 || width > empty_gap - corner_tolerance) return;
      if (!face_each_other<Dim>(boundary.faces[own.face].normal, boundary.faces[other.face].normal)) return;
      const bool is_shared = hull_of_wall[boundary.faces[other.face].wall] >= 0;  // the other hull takes half of it
      growth[row] = 1.0 + (is_shared ? 0.5 : 1.0) * width;
      rows.share[row] *= growth[row];
    });
  }
  Particles<Dim>& particles = flow.state.particles;
  for_each(particles.owned, [&](std::size_t i) {
    if (!particles.is_fluid(i)) particles.volume[i] *= growth[particles.wall_row[i]];
  });
}

}  // namespace

template <int Dim>
FixedHulls<Dim>::FixedHulls(const Boundary<Dim>& boundary, std::vector<int> hulls, const std::vector<int>& body_of_wall,
                            double spacing, bool has_probes)
    : hulls_(std::move(hulls)),
      hull_of_wall_(hull_of_each(boundary.walls.size(), hulls_)),
      surfaces_(make_hull_surfaces(boundary, hull_of_wall_, body_of_wall, spacing)),
      has_probes_(has_probes) {
  const bool moves = std::ranges::any_of(boundary.walls, &WallProperties::moves);
  const double reach = reach_of_shares * spacing;
  for (const WallPatch<Dim>& patch : make_wall_patches(boundary, spacing)) {
    const WallFace<Dim>& face = boundary.faces[patch.face];
    const int hull = hull_of_wall_[face.wall];
    const auto is_near = [&](const ContactSurface<Dim>& surface) {
      return surface.hull != hull && surface.boundary.nearest(patch.centre(boundary), reach).face >= 0;
    };
    if (hull < 0 || face.is_image) continue;
    all_patches_.push_back(patch);
    if (moves || std::ranges::any_of(surfaces_, is_near)) near_patches_.push_back(patch);
  }
}

/// Where all walls rest, hulls that no wall faces are dropped for good.
template <int Dim>
void FixedHulls<Dim>::begin(Flow<Dim>& flow) {
  const Boundary<Dim>& boundary = flow.walls.boundary;
  if (std::ranges::any_of(boundary.walls, &WallProperties::moves)) return;
  are_at_rest_ = flow.setup.graded == nullptr || !flow.setup.graded->field().moves();
  fill_empty_gaps(flow, hull_of_wall_);
  const NarrowGaps<Dim> gaps(flow, hulls(near_patches_), flow.state.time);
  std::vector<bool> faces_wall;
  for (std::size_t k = 0; k < hulls_.size(); ++k) faces_wall.push_back(gaps.wall_facing(static_cast<int>(k)) >= 0);
  can_seal_ = gaps.can_seal();
  const auto is_alone = [&](const WallPatch<Dim>& patch) {
    return !faces_wall[static_cast<std::size_t>(hull_of_wall_[boundary.faces[patch.face].wall])];
  };
  std::erase_if(near_patches_, is_alone);
  std::erase_if(all_patches_, is_alone);
}

template <int Dim>
NarrowGaps<Dim> FixedHulls<Dim>::find_gaps(const Flow<Dim>& flow, std::span<const WallPatch<Dim>> patches,
                                           std::optional<NarrowGaps<Dim>>& at_rest) const {
  if (!are_at_rest_) return NarrowGaps<Dim>(flow, hulls(patches), flow.state.time);
  if (!at_rest) at_rest.emplace(flow, hulls(patches), flow.state.time);
  NarrowGaps<Dim> gaps = *at_rest;
  gaps.find_water();
  return gaps;
}

template <int Dim>
void FixedHulls<Dim>::claim(const Flow<Dim>& /*flow*/, std::span<Role> /*role*/) {
  sealed_ = {};  // until the gaps of this step are known
}

/// Changes the rows of a second projection, which adds to a pressure that films have changed already.
template <int Dim>
void FixedHulls<Dim>::write_rows(Flow<Dim>& flow) {
  let_correction_through_films(sealed_, flow.equation->rows);
}

template <int Dim>
int FixedHulls<Dim>::pose(Flow<Dim>& flow, std::span<const Vec<Dim>> /*predicted*/, double /*dt*/) {
  if (!has_hulls() || !can_seal_) return 0;
  NarrowGaps<Dim> gaps = find_gaps(flow, near_patches_, near_at_rest_);
  gaps.find_films({});
  sealed_ = gaps.find_sealed(flow.state.particles.pressure);
  let_through_films(sealed_, flow);
  return 0;
}

/// Moments are about the origin.
template <int Dim>
ForceSums<Dim> FixedHulls<Dim>::new_sums(const Flow<Dim>& flow) const {
  return ForceSums<Dim>(flow.setup.ranks, std::vector<Vec<Dim>>(hulls_.size(), Vec<Dim>(Vec<Dim>::Zero())));
}

template <int Dim>
void FixedHulls<Dim>::report(Flow<Dim>& flow) {
  has_report_ = false;
  if (!has_probes_ || !has_hulls() || !air_of(flow).state.pockets.empty()) return;
  NarrowGaps<Dim> gaps = find_gaps(flow, all_patches_, all_at_rest_);
  gaps.measure(gaps.find_stagnant());
  for (std::size_t k = 0; k < hulls_.size(); ++k) {
    const int beside = gaps.wall_facing(static_cast<int>(k));
    if (beside < 0) continue;
    has_report_ = true;
    flow.walls.forces.beside_walls.push_back({.walls = {hulls_[k]},
                                              .beside = beside,
                                              .centre = Vec<Dim>::Zero(),
                                              .force = Vec<Dim>::Zero(),
                                              .moment = Turn<Dim>::Zero()});
  }
  if (!has_report_) return;
  const std::vector<double>& pressure = flow.state.particles.pressure;
  ForceSums<Dim> sums = new_sums(flow);
  add_pressure_of_pairs<Dim>(flow, hull_of_wall_, pressure, sums);
  const bool is_root = flow.setup.ranks.is_root();
  gaps.visit_forces(pressure, [&](int hull, const Vec<Dim>& x, const Vec<Dim>& force, const Turn<Dim>& couple) {
    if (is_root) sums.add(hull, x, force, couple);
  });
  gaps.visit_pairs_in_films(pressure,
                            [&](int hull, const Vec<Dim>& x, const Vec<Dim>& force) { sums.add(hull, x, -force); });
  add_to_report(flow, sums);
}

template <int Dim>
void FixedHulls<Dim>::add_to_report(Flow<Dim>& flow, ForceSums<Dim>& sums) const {
  const std::vector<Twist<Dim>> forces = sums.gather();
  for (ForceBesideWall<Dim>& one : flow.walls.forces.beside_walls) {
    const int hull = hull_of_wall_[one.walls.front()];
    if (hull < 0) continue;
    one.force += forces[hull].template head<Dim>();
    one.moment += forces[hull].template tail<turns<Dim>>();
  }
}

template <int Dim>
void FixedHulls<Dim>::stay(Flow<Dim>& flow) {
  report(flow);
}

template <int Dim>
void FixedHulls<Dim>::correct(Flow<Dim>& flow, double /*dt*/) {
  report(flow);
}

template <int Dim>
void FixedHulls<Dim>::project_again(Flow<Dim>& flow, const std::vector<double>& correction, double /*dt*/) {
  if (!has_report_) return;
  ForceSums<Dim> sums = new_sums(flow);
  add_pressure_of_pairs<Dim>(flow, hull_of_wall_, correction, sums);
  add_to_report(flow, sums);
}

template <int Dim>
void FixedHulls<Dim>::finish_step(Flow<Dim>& flow, const StepStart<Dim>& /*start*/, double /*dt*/) {
  if (!has_report_) return;
  ForceSums<Dim> sums = new_sums(flow);
  add_guard<Dim>(flow, hull_of_wall_, sums);
  add_to_report(flow, sums);
}

template <int Dim>
std::unique_ptr<Part<Dim>> make_fixed_hulls(const CaseSpec& spec, const Setup<Dim>& setup,
                                            const Boundary<Dim>& boundary) {
  const bool is_covered = traits_of(spec).no_floating.empty() && spec.liquids.empty();
  if (!is_covered) return nullptr;
  const SpacingField<Dim> field(spec, boundary);
  const std::vector<int> body_of_wall = bodies_of_walls(make_bodies<Dim>(spec), boundary.walls.size());
  std::vector<int> hulls;
  for (std::size_t w = 0; w < spec.walls.size(); ++w) {
    const auto wall = static_cast<int>(w);
    const bool is_fixed_hull = is_hull(spec.walls[w]) && body_of_wall[w] < 0;
    if (is_fixed_hull && is_outside_zones(field, boundary, wall, setup.scale.spacing)) hulls.push_back(wall);
  }
  if (hulls.empty()) return nullptr;
  auto part = std::make_unique<FixedHulls<Dim>>(boundary, std::move(hulls), body_of_wall, setup.scale.spacing,
                                                has_force_probe(spec));
  if (!part->has_hulls()) return nullptr;
  return part;
}

template class FixedHulls<2>;
template class FixedHulls<3>;
TAILWATER_IN_2D_AND_3D(make_fixed_hulls);

}  // namespace tailwater
