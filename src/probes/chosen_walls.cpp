#include "probes/chosen_walls.h"

#include <algorithm>
#include <functional>
#include <string_view>

#include "base/box.h"
#include "base/for_each.h"
#include "case/nearest_name.h"
#include "probes/places.h"

namespace tailwater {
namespace {

/// dx; the part of a patch in a region is computed from pieces of this size.
constexpr double longest_piece_edge = 0.4;

/// By wall, whether the probe names it.
template <int Dim>
std::vector<std::uint8_t> named_walls(const ProbeTable& probe, const Boundary<Dim>& boundary) {
  std::vector<std::uint8_t> named;
  std::vector<std::string_view> known;
  for (const WallProperties& wall : boundary.walls) {
    named.push_back(!wall.is_duct && probe.walls.empty());
    if (!wall.is_duct) known.emplace_back(wall.name);  // ducts are the last
  }
  for (const std::string& name : probe.walls) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      throw CaseError("probe-wall-unknown",
                      {"{} has \"{}\", and no wall of the case has this name", label(probe).with_key("walls"), name},
                      {"{}", unknown_name_hint(name, known)});
    }
    named[static_cast<std::size_t>(found - known.begin())] = 1;
  }
  return named;
}

/// Whether a point is in the region; empty if the probe has none.
template <int Dim>
std::function<bool(const Vec<Dim>&)> region_of(const ProbeTable& probe, double tolerance) {
  if (!probe.region_min.empty()) {
    const Vec<Dim> low = to_vec<Dim>(probe.region_min, label(probe), "region_min");
    const Vec<Dim> high = to_vec<Dim>(probe.region_max, label(probe), "region_max");
    return [low, high, tolerance](const Vec<Dim>& x) {
      return (x - low).minCoeff() >= -tolerance && (high - x).minCoeff() >= -tolerance;
    };
  }
  return {};
}

}  // namespace

template <int Dim>
ChosenWalls<Dim>::ChosenWalls(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary)
    : named_(named_walls(probe, boundary)),
      is_inside_(region_of<Dim>(probe, corner_tolerance * spec.particles.spacing)) {}

template <int Dim>
std::vector<double> chosen_shares(const ProbeTable& probe, const CaseSpec& spec, const Boundary<Dim>& boundary,
                                  std::span<const WallPatch<Dim>> patches) {
  if (patches.empty())
    throw CaseError("probe-without-wall", {"{}: needs a wall, and the case has no wall", label(probe)},
                    {"draw a wall, or remove the probe"});
  const ChosenWalls<Dim> chosen(probe, spec, boundary);
  const double spacing = spec.particles.spacing;
  std::vector<double> shares(patches.size(), 0.0);
  for_each(patches.size(), [&](std::size_t k) {
    const WallPatch<Dim>& patch = patches[k];
    const int wall = boundary.faces[patch.face].wall;
    if (!chosen.is_named(wall)) return;
    if (!chosen.has_region()) {
      shares[k] = 1.0;
      return;
    }
    const std::vector<WallPatch<Dim>> pieces = pieces_of(patch, boundary, longest_piece_edge * spacing);
    const std::size_t inside =
        count_each(pieces.size(), [&](std::size_t p) { return chosen.contains(wall, pieces[p].centre(boundary)); });
    shares[k] = static_cast<double>(inside) / static_cast<double>(pieces.size());
  });
  if (std::ranges::all_of(shares, [](double share) { return share == 0.0; })) {
    if (!chosen.has_region()) {
      throw CaseError("probe-on-wall-drawn-twice",
                      {"{}: all of its walls lie on other walls of the case, which have the force of the water there",
                       label(probe)},
                      {"name those walls as well, or draw each wall once"});
    }
    Box<Dim> box;
    for (const WallFace<Dim>& face : boundary.faces) {
      if (chosen.is_named(face.wall)) box.extend(face.box());
    }
    throw CaseError("probe-region-without-wall",
                    {"{}: its region contains no part of its walls, which are drawn from {} to {}", label(probe),
                     place<Dim>(box.min()), place<Dim>(box.max())},
                    {"choose region_min and region_max around the part you mean"});
  }
  return shares;
}

template class ChosenWalls<2>;
template class ChosenWalls<3>;
TAILWATER_IN_2D_AND_3D(chosen_shares);

}  // namespace tailwater
