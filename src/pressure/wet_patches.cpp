#include "pressure/wet_patches.h"

#include <utility>

#include "geometry/images.h"
#include "walls/patches.h"

namespace tailwater {
namespace {

/// dx; water in front of a patch is not farther from its centre than this.
constexpr double reach_in_front = 1.5;

/// dx; from the centre of a patch that has no particle near it to that of another one which shows that it is wet: in a
/// film of water between two walls, or in a sharp corner of one.
constexpr double reach_of_wet = 2.0;

/// dx; from the centre of a patch into the space in front, so that its own wall hides nothing.
constexpr double margin_of_eye = 0.1;

}  // namespace

template <int Dim>
WetPatches<Dim>::WetPatches(const Flow<Dim>& flow, std::vector<PatchInReach<Dim>> patches)
    : flow_(flow), patches_(std::move(patches)), is_wet_(patches_.size(), 1) {
  std::vector<Vec<Dim>> centres;
  for (const PatchInReach<Dim>& patch : patches_) {
    centres.push_back(patch.centre);
    spacing_.push_back(flow.setup.scale.spacing * flow.setup.relative_spacing(patch.centre));
  }
  grid_ = CellGrid<Dim>(centres, reach_of_wet * flow.setup.scale.spacing);
  const std::vector<double> water_in_front = find_water_in_front();
  std::vector<std::uint8_t> is_film(patches_.size(), 0);
  std::vector<std::size_t> reached;  // patches that water reaches; it goes on from them through films
  for (std::size_t n = 0; n < is_wet_.size(); ++n) {
    const Neighbourhood around =
        water_in_front[n] != 0.0 ? Neighbourhood{.has_water = true} : look_around(water_in_front, n);
    is_film[n] = around.is_film ? 1 : 0;
    is_wet_[n] = around.has_water || patches_[n].is_left_over ? 1 : 0;
    if (around.has_water) reached.push_back(n);
  }
  while (!reached.empty()) {
    const std::size_t m = reached.back();
    reached.pop_back();
    grid_.for_each_near(patches_[m].centre, [&](std::int32_t n) {
      if (is_film[n] == 0 || !is_next_to(n, m)) return;
      is_film[n] = 0;
      is_wet_[n] = 1;
      reached.push_back(n);
    });
  }
}

template <int Dim>
Vec<Dim> WetPatches<Dim>::eye(std::size_t n) const {
  return patches_[n].centre + margin_of_eye * spacing_[n] * face(n).normal;
}

/// Whether no wall that may hide a place from patch n does.
template <int Dim>
bool WetPatches<Dim>::sees(std::size_t n, const Vec<Dim>& to) const {
  if (!patches_[n].may_be_hidden) return true;
  return flow_.walls.patches->wetted().sees(flow_.walls.boundary, face(n).wall, eye(n), to);
}

/// 0 for patches without water in front of them. Collective.
template <int Dim>
std::vector<double> WetPatches<Dim>::find_water_in_front() const {
  const Boundary<Dim>& boundary = flow_.walls.boundary;
  Box<Dim> around;
  for (const PatchInReach<Dim>& patch : patches_) around.extend(patch.centre);
  around.widen(reach_in_front * flow_.setup.scale.spacing);
  std::vector<double> water_in_front(patches_.size(), 0.0);
  const auto wet_near = [&](const Vec<Dim>& x) {
    if (!around.contains(x)) return;
    grid_.for_each_near(x, [&](std::int32_t n) {
      const Vec<Dim> offset = x - patches_[n].centre;
      const double reach = reach_in_front * spacing_[n];
      if (offset.dot(face(n).normal) <= 0.0 || offset.squaredNorm() >= reach * reach || water_in_front[n] != 0.0) {
        return;
      }
      if (is_hidden<Dim>(boundary.screens, boundary.screens_near(eye(n), reach), eye(n), x) || !sees(n, x)) return;
      water_in_front[n] = 1.0;
    });
  };
  const Particles<Dim>& particles = flow_.state.particles;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: several mark one patch
    if (!particles.is_fluid(i) || flow_.pairs().sees_wall[i] == 0) continue;
    const Vec<Dim>& x = particles.position[i];
    wet_near(x);
    visit_images<Dim>(flow_.setup.domain, Box<Dim>(x), around, [&](const Vec<Dim>& by) { wet_near(x + by); });
  }
  flow_.setup.ranks.sum_of_each(water_in_front);
  return water_in_front;
}

/// Whether water at patch m is at patch n, too: both are sides of one film, or m is beside n.
template <int Dim>
bool WetPatches<Dim>::is_next_to(std::size_t n, std::size_t m) const {
  const Vec<Dim> offset = patches_[m].centre - patches_[n].centre;
  const double reach = reach_of_wet * spacing_[n];
  if (offset.squaredNorm() >= reach * reach || !sees(n, eye(m))) return false;
  const double alike = face(m).normal.dot(face(n).normal);
  return face(m).wall == face(n).wall ? alike > 0.0 : alike < 0.0 && offset.dot(face(n).normal) > 0.0;
}

/// A patch without water in front is wet if a patch near it, on the same side of the same wall, has water in front. It
/// is a side of a film if another wall faces it.
template <int Dim>
typename WetPatches<Dim>::Neighbourhood WetPatches<Dim>::look_around(const std::vector<double>& water_in_front,
                                                                     std::size_t n) const {
  Neighbourhood around;
  grid_.for_each_near(patches_[n].centre, [&](std::int32_t m) {
    if (around.has_water || !is_next_to(n, m)) return;
    if (face(m).wall != face(n).wall) {
      around.is_film = true;
    } else if (water_in_front[m] != 0.0) {
      around.has_water = true;
    }
  });
  return around;
}

template class WetPatches<2>;
template class WetPatches<3>;

}  // namespace tailwater
