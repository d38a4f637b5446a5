#include "porous/porous_field.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/finding.h"
#include "case/named_numbers.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "porous/porous_region.h"

namespace tailwater {
namespace {

/// [dx]
constexpr double step_over_spacing = 0.5;
/// Some gigabytes: a layer of more has its lengths in a wrong unit, or is drawn far beyond the case.
constexpr double max_nodes = 1e8;

/// The fraction of a cell of this edge that is on the positive side of a surface at this signed distance.
double fraction_of_cell(double distance, double edge) { return std::clamp(0.5 + distance / edge, 0.0, 1.0); }

/// Calls visit(index) for all indices from `low` to `high`, the last included.
template <std::size_t Dim, class Visit>
void visit_box(const std::array<std::int64_t, Dim>& low, const std::array<std::int64_t, Dim>& high, Visit&& visit) {
  std::array<std::int64_t, Dim> index = low;
  for (std::size_t axis = 0; axis < Dim;) {
    visit(index);
    for (axis = 0; axis < Dim; ++axis) {
      if (++index[axis] <= high[axis]) break;
      index[axis] = low[axis];
    }
  }
}

/// The medium as drawn at a place: where layers overlap the last one counts.
template <int Dim>
PorousMedium medium_as_drawn(const std::vector<PorousRegion<Dim>>& regions, const std::vector<PorousMedium>& media,
                             const Vec<Dim>& x, double edge) {
  PorousMedium sum;
  double left = 1.0;
  for (std::size_t k = regions.size(); k-- > 0 && left > 0.0;) {
    const double share = std::min(left, fraction_of_cell(regions[k].depth_inside(x, edge), edge));
    left -= share;
    sum.solid += share * media[k].solid;
    sum.linear += share * media[k].linear;
    sum.quadratic += share * media[k].quadratic;
    sum.added_mass += share * media[k].added_mass;
  }
  return sum;
}

/// The place whose medium counts at `x`: a layer that ends at an opening without a lead, or is drawn beyond it,
/// continues through the duct as it is before the opening.
template <int Dim>
Vec<Dim> place_of_medium(const std::vector<Duct<Dim>>& ducts, const Vec<Dim>& x, double step, double reach) {
  for (const Duct<Dim>& duct : ducts) {
    const double beyond = duct.mouth.beyond(x);
    if (beyond < -0.5 * step || beyond > duct.length + reach || !duct.mouth.spans(x)) continue;
    return x - (beyond + step) * duct.mouth.normal;
  }
  return x;
}

/// The fraction of the cell around `x` in front of resting walls.
template <int Dim>
double fraction_in_front_of_walls(const Boundary<Dim>& boundary, const Vec<Dim>& x, double edge, double reach) {
  const NearestWall<Dim> wall = boundary.nearest(x, reach);
  if (wall.face < 0 || boundary.walls[boundary.faces[wall.face].wall].moves()) return 1.0;
  return fraction_of_cell(wall.signed_distance, edge);
}

}  // namespace

template <int Dim>
PorousField<Dim>::PorousField(const CaseSpec& spec, const Boundary<Dim>& boundary, const Kernel<Dim>& kernel,
                              const PeriodicDomain<Dim>& domain)
    : domain_(domain), step_(step_over_spacing * spec.particles.spacing) {
  if (spec.porous.empty()) return;
  std::vector<PorousRegion<Dim>> regions;
  std::vector<PorousMedium> media;
  Box<Dim> box;
  for (const PorousTable& table : spec.porous) {
    regions.emplace_back(spec, table);
    media.push_back(make_medium(table, spec.physics.viscosity, gravity_magnitude(spec.physics)));
    min_porosity_ = std::min(min_porosity_, table.porosity);
    box.extend(regions.back().box());
  }
  const double margin = kernel_radius(kernel) + 2.0 * step_;
  std::vector<Duct<Dim>> ducts;  // through which layers continue
  const Box<Dim> layers = box;
  for (const Duct<Dim>& duct : boundary.ducts) {
    if (has_lead(spec, duct) || !layers.intersects(box_around(duct.mouth.as_faces()))) continue;
    ducts.push_back(duct);
    box.extend(box_around(duct.mouth.moved_out(duct.length).as_faces()));
  }
  for (int axis = 0; axis < Dim; ++axis) {
    if (domain[axis]) {
      box.min()[axis] = domain[axis]->first;
      box.max()[axis] = domain[axis]->second;
    }
    // Nodes half a step off the multiples of dx: a surface there is between two of them.
    const auto first = static_cast<std::int64_t>(std::floor((box.min()[axis] - margin) / step_));
    origin_[axis] = (static_cast<double>(first) + 0.5) * step_;
    count_[axis] = static_cast<std::int64_t>(std::ceil((box.max()[axis] + margin - origin_[axis]) / step_)) + 1;
  }
  double nodes = 1.0;
  for (const std::int64_t along : count_) nodes *= static_cast<double>(along);
  if (nodes > max_nodes) {
    throw CaseError(
        "porous-layers-too-large",
        {"the porous layers from {} to {} need {:.3g} cells, each half of particles.spacing = {:.6g} m wide, "
         "but a case has at most {:.3g}",
         place<Dim>(box.min()), place<Dim>(box.max()), nodes, spec.particles.spacing, max_nodes},
        {"give their coordinates in metres, and end them at the walls"});
  }
  nodes_.resize(static_cast<std::size_t>(nodes));
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Vec<Dim> x = place_of_medium(ducts, wrapped<Dim>(domain_, place_of(index_of(k))), step_, margin);
    const PorousMedium m = medium_as_drawn(regions, media, x, step_);
    nodes_[k] = {static_cast<float>(m.solid), static_cast<float>(m.linear), static_cast<float>(m.quadratic),
                 static_cast<float>(m.added_mass)};
  }
  smooth(boundary, kernel);
}

template <int Dim>
std::size_t PorousField<Dim>::number_of(const Index& index) const {
  std::int64_t number = 0;
  for (int axis = Dim - 1; axis >= 0; --axis) number = number * count_[axis] + index[axis];
  return static_cast<std::size_t>(number);
}

template <int Dim>
auto PorousField<Dim>::index_of(std::size_t number) const -> Index {
  Index index;
  auto rest = static_cast<std::int64_t>(number);
  for (int axis = 0; axis < Dim; ++axis) {
    index[axis] = rest % count_[axis];
    rest /= count_[axis];
  }
  return index;
}

template <int Dim>
Vec<Dim> PorousField<Dim>::place_of(const Index& index) const {
  Vec<Dim> x = origin_;
  for (int axis = 0; axis < Dim; ++axis) x[axis] += step_ * static_cast<double>(index[axis]);
  return x;
}

/// Nodes with another medium within `reach` nodes along an axis. Elsewhere smoothing changes nothing.
template <int Dim>
std::vector<std::size_t> PorousField<Dim>::nodes_near_surfaces(int reach) const {
  std::vector<std::uint8_t> is_near(nodes_.size(), 0);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Index index = index_of(k);
    bool differs = false;
    for (int axis = 0; axis < Dim && !differs; ++axis) {
      Index next = index;
      differs = ++next[axis] < count_[axis] && nodes_[number_of(next)] != nodes_[k];
    }
    if (!differs) continue;
    Index low;
    Index high;
    for (int axis = 0; axis < Dim; ++axis) {
      low[axis] = std::max<std::int64_t>(0, index[axis] - reach);
      high[axis] = std::min(count_[axis] - 1, index[axis] + 1 + reach);
    }
    visit_box(low, high, [&](const Index& near) { is_near[number_of(near)] = 1; });
  }
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    if (is_near[k] != 0) near.push_back(k);
  }
  return near;
}

/// The nodes in the support around a node.
template <int Dim>
auto PorousField<Dim>::find_stencil(const Kernel<Dim>& kernel) const -> std::vector<StencilNode> {
  const auto reach = static_cast<std::int64_t>(kernel_radius(kernel) / step_);
  Index low;
  Index high;
  low.fill(-reach);
  high.fill(reach);
  std::vector<StencilNode> stencil;
  visit_box(low, high, [&](const Index& offset) {
    const double weight = kernel_value(kernel, (place_of(offset) - origin_).norm());
    if (weight > 0.0) stencil.push_back({offset, weight});
  });
  return stencil;
}

template <int Dim>
void PorousField<Dim>::smooth(const Boundary<Dim>& boundary, const Kernel<Dim>& kernel) {
  const double radius = kernel_radius(kernel);
  const std::vector<StencilNode> stencil = find_stencil(kernel);
  std::vector<float> in_front(nodes_.size(), -1.0F);  // below 0: not computed yet
  const std::vector<Node> drawn = nodes_;
  for (const std::size_t k : nodes_near_surfaces(static_cast<int>(radius / step_))) {
    const Index centre = index_of(k);
    double weights = 0.0;
    std::array<double, 4> sums{};
    for (const auto& [offset, kernel_weight] : stencil) {
      Index index = centre;
      bool is_in_grid = true;
      for (int axis = 0; axis < Dim; ++axis) {
        index[axis] += offset[axis];
        is_in_grid = is_in_grid && index[axis] >= 0 && index[axis] < count_[axis];
      }
      if (!is_in_grid) continue;
      const std::size_t other = number_of(index);
      if (in_front[other] < 0.0F) {
        const Vec<Dim> x = wrapped<Dim>(domain_, place_of(index));
        in_front[other] = static_cast<float>(fraction_in_front_of_walls(boundary, x, step_, radius + 2.0 * step_));
      }
      const double weight = kernel_weight * in_front[other];
      weights += weight;
      for (std::size_t n = 0; n < sums.size(); ++n) sums[n] += weight * drawn[other][n];
    }
    if (weights == 0.0) continue;  // behind a wall
    for (std::size_t n = 0; n < sums.size(); ++n) nodes_[k][n] = static_cast<float>(sums[n] / weights);
  }
}

template <int Dim>
PorousMedium PorousField<Dim>::at(const Vec<Dim>& position) const {
  if (nodes_.empty()) return {};
  const Vec<Dim> x = wrapped<Dim>(domain_, position);
  Index low;
  Vec<Dim> fraction;
  for (int axis = 0; axis < Dim; ++axis) {
    const double steps = (x[axis] - origin_[axis]) / step_;
    if (!(steps >= 0.0) || steps >= static_cast<double>(count_[axis] - 1)) return {};
    low[axis] = static_cast<std::int64_t>(steps);
    fraction[axis] = steps - static_cast<double>(low[axis]);
  }
  std::array<double, 4> sums{};
  for (int corner = 0; corner < (1 << Dim); ++corner) {
    double weight = 1.0;
    Index index = low;
    for (int axis = 0; axis < Dim; ++axis) {
      const bool is_high = ((corner >> axis) & 1) != 0;
      weight *= is_high ? fraction[axis] : 1.0 - fraction[axis];
      index[axis] += is_high;
    }
    const Node& node = nodes_[number_of(index)];
    for (std::size_t n = 0; n < sums.size(); ++n) sums[n] += weight * node[n];
  }
  return {.solid = sums[0], .linear = sums[1], .quadratic = sums[2], .added_mass = sums[3]};
}

template <int Dim>
Vec<Dim> PorousField<Dim>::porosity_gradient_at(const Vec<Dim>& x) const {
  Vec<Dim> gradient = Vec<Dim>::Zero();
  for (int axis = 0; axis < Dim; ++axis) {
    const Vec<Dim> half = 0.5 * step_ * Vec<Dim>::Unit(axis);
    gradient[axis] = (porosity_at(x + half) - porosity_at(x - half)) / step_;
  }
  return gradient;
}

template class PorousField<2>;
template class PorousField<3>;

}  // namespace tailwater
