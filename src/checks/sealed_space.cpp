#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "checks/cell_space.h"
#include "checks/checks.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"
#include "geometry/wall_label.h"

namespace tailwater {
namespace {

/// Finds spaces without water below a level that walls close on all sides.
template <int Dim>
class DrySpaces {
 public:
  DrySpaces(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid, double level)
      : space_(spec, faces_with(boundary, make_open_ends<Dim>(spec)), fluid.box(), max_cells_of_case),
        walls_(boundary.faces.size()),
        level_(level),
        is_wet_(space_.count(), false),
        is_known_(space_.count(), false) {
    for (const auto& c : cells_of<Dim>(space_, fluid)) is_wet_[space_.index(c)] = true;
  }

  /// Calls visit(place, volume) for each of them.
  template <class Visit>
  void find(Visit&& visit) {
    for (std::size_t first = 0; first < space_.count(); ++first) {
      if (is_known_[first] || !may_be_dry(first) || space_.face_at(space_.cell(first)) >= 0) continue;
      const std::size_t count = closed_around(first);
      if (count > 0) visit(space_.centre(space_.cell(first)), static_cast<double>(count) * space_.volume());
    }
  }

 private:
  bool may_be_dry(std::size_t index) const {
    const auto c = space_.cell(index);
    return !is_wet_[index] && space_.centre(c)[Dim - 1] < level_ && !space_.is_behind_walls(c);
  }

  /// The number of cells that are connected with this one; 0 if they lead to water, above the level, into a wall, to an
  /// open end or out of the case.
  std::size_t closed_around(std::size_t first) {
    using Cell = typename CellSpace<Dim>::Cell;
    bool is_closed = true;
    const auto go = [&](const Cell& c, int axis, int step) -> std::optional<Cell> {
      const std::optional<Cell> beside = space_.next(c, axis, step);
      int face = space_.face_beside(c, axis, step);
      if (face < 0 && beside) face = space_.face_at(*beside);
      if (face >= 0) {
        is_closed = is_closed && static_cast<std::size_t>(face) < walls_;
        return std::nullopt;
      }
      if (beside && may_be_dry(space_.index(*beside))) return beside;
      is_closed = false;
      return std::nullopt;
    };
    const std::size_t count = walk(space_, {space_.cell(first)}, is_known_, go).size();
    return is_closed ? count : 0;
  }

  CellSpace<Dim> space_;
  std::size_t walls_;
  double level_;
  std::vector<bool> is_wet_, is_known_;
};

}  // namespace

template <int Dim>
Findings check_sealed_space(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid) {
  const FluidTable* highest = nullptr;
  for (const FluidTable& block : spec.fluid) {
    if (block.shape == BlockShape::fill && (highest == nullptr || block.level > highest->level)) highest = &block;
  }
  if (highest == nullptr || fluid.all == 0) return {};
  const CaseLabel owner = fluid_label(spec, static_cast<std::size_t>(highest - spec.fluid.data()));
  Findings findings;
  DrySpaces<Dim>(spec, boundary, fluid, highest->level).find([&](const Vec<Dim>& x, double volume) {
    const NearestWall<Dim> wall = boundary.nearest(x, std::numeric_limits<double>::infinity());
    findings.push_back(Finding::warning(
        "fill-leaves-sealed-space",
        {"{} leaves {:.3g} at {} dry, below its level: walls close this space off, among them {}", owner,
         Amount{volume, Dim == 2 ? "m^2" : "m^3"}, place(x), wall_label(boundary, boundary.faces[wall.face].wall)},
        {"if it holds water, add a [[fluid]] with a seed there"}));
  });
  return findings;
}

TAILWATER_IN_2D_AND_3D(check_sealed_space);

}  // namespace tailwater
