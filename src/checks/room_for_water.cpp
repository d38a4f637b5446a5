#include "checks/room_for_water.h"

#include <numeric>

#include "geometry/from_spec.h"

namespace tailwater {
namespace {

/// Small enough for a check each time a wall has moved by dx.
constexpr double max_cells_of_room = 2e4;

}  // namespace

template <int Dim>
RoomForWater<Dim>::RoomForWater(const CaseSpec& spec, const Boundary<Dim>& drawn, const FluidParticles<Dim>& fluid)
    : space_(spec, drawn.faces, fluid.box(), max_cells_of_room),
      water_(fluid.ranks.sum(std::reduce(fluid.volume.begin(), fluid.volume.end()))) {
  Vec<Dim> down = space_.across_periods(gravity_of<Dim>(spec));
  if (down.norm() > 0.0) down.normalize();
  Spread<Dim> rest = spread(space_, cells_of<Dim>(space_, fluid), down);
  if (!rest.way_out) wet_ = std::move(rest.cells);
}

template <int Dim>
void RoomForWater<Dim>::move(std::vector<WallFace<Dim>> faces, const std::vector<AffineMap<Dim>>& displacement) {
  std::vector<bool> is_passed(space_.count(), false);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (displacement[f].linear == Mat<Dim>::Identity() && displacement[f].constant == Vec<Dim>::Zero()) continue;
    const WallFace<Dim>& before = space_.faces()[f];
    const AffineMap<Dim> back = displacement_between(displacement[f], {});
    space_.visit_around(before, faces[f], [&](const auto& cell) {
      // In the frame of the wall the cell moves.
      const Vec<Dim> x = space_.centre(cell);
      if (space_.passes(before, x, back(x))) is_passed[space_.index(cell)] = true;
    });
  }
  std::erase_if(wet_, [&](const auto& cell) { return is_passed[space_.index(cell)]; });
  space_.set_faces(std::move(faces));
}

template <int Dim>
std::optional<typename RoomForWater<Dim>::Enclosed> RoomForWater<Dim>::enclosed() const {
  Spread<Dim> room = spread(space_, wet_, Vec<Dim>(Vec<Dim>::Zero()));
  if (room.way_out) return std::nullopt;
  // A cell at a wall counts whole or not at all, so up to half a cell may be missing per side.
  const double cells = static_cast<double>(room.cells.size()) + 0.5 * static_cast<double>(room.sides);
  return Enclosed{cells * space_.volume(), std::move(room.met)};
}

template class RoomForWater<2>;
template class RoomForWater<3>;

}  // namespace tailwater
