#include "air/air_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "base/error.h"
#include "geometry/from_spec.h"
#include "geometry/some_walls.h"
#include "motion/channel_end.h"
#include "walls/wall_contact.h"

namespace tailwater {
namespace {

/// [dx]; distance within which a particle of water or of a wall covers cells, so that stretched and disordered water
/// has no holes.
constexpr double cover = 1.1;

/// [dx]; how far water beside pockets may go between two searches: a cell. Other water counts by a quarter
/// (count_displacement_for_air), so it may go by the size of the smallest pocket.
constexpr double distance_between_looks = 0.5;

/// Half the edge of a cell, less rounding: a cell that a wall bounds is behind it.
constexpr double half_cell = 0.5 - 1e-6;

/// [dx]; edge of the pieces of walls that move. Their fraction of a pocket falls from 1 to 0 in two pieces.
constexpr double longest_piece = 0.75;

/// [dx]; distance in front of a wall at which its air is evaluated. At this distance the pairs of water and wall have
/// the mean of a field that changes linearly away from the wall.
constexpr double sight_of_walls = 0.6;

/// [dx]; of the corners of the space that a row of a wall stands for, which is up to 1.25 dx long.
template <int Dim>
const double reach_of_row = std::sqrt(0.25 * (Dim - 1) + 0.625 * 0.625);

/// Limit of some 2 GB: one bit per cell in six kinds of marks, and the data of each row of cells.
constexpr double max_cells_of_map = 2e9;

/// Number of cells of the grid, with rows that fill words of marks.
template <int Dim>
double cells_over(const Box<Dim>& box, double spacing, const PeriodicDomain<Dim>& domain) {
  double cells = 1.0;
  for (int d = 0; d < Dim; ++d) {
    const double size = domain[d] ? domain[d]->second - domain[d]->first : box.sizes()[d];
    cells *= std::max(size / (0.5 * spacing), d == Dim - 1 ? 64.0 : 1.0);
  }
  return cells;
}

/// Whether x is behind another wall that is as near as the nearest one, of index `wall`, at `distance` (m). Where two
/// walls touch, as a lid and the side walls around it, either of them may be the nearest one.
template <int Dim>
bool is_behind_touching_wall(const Boundary<Dim>& boundary, int wall, double distance, double tolerance,
                             const Vec<Dim>& x) {
  std::vector<std::uint8_t> is_other(boundary.walls.size(), 1);
  for (std::size_t w = 0; w < is_other.size(); ++w) {
    if (static_cast<int>(w) == wall || boundary.walls[w].is_plate) is_other[w] = 0;
  }
  return nearest_among<Dim>(boundary, is_other, x, distance + tolerance).signed_distance < 0.0;
}

std::vector<std::int64_t> numbers_of(const std::vector<AirPocket>& pockets) {
  std::vector<std::int64_t> numbers;
  for (const AirPocket& pocket : pockets) numbers.push_back(pocket.number);
  return numbers;
}

}  // namespace

template <int Dim>
AirWatch<Dim>::AirWatch(const CaseSpec& spec, std::span<const Duct<Dim>> ducts, const Box<Dim>& box,
                        const PeriodicDomain<Dim>& domain)
    : law_(spec.air), spacing_(spec.particles.spacing), starts_(spec.pockets), vents_(spec.vents) {
  for (const ChannelEnd<Dim>& end : make_channel_ends<Dim>(spec, ducts)) {
    const Vec<Dim> middle = end.low + 0.5 * (end.height * end.rise + end.width * end.aside);
    ends_.push_back({end.opening, middle - spacing_ * end.opening.normal, end.flow.feeds()});
  }
  const bool repeats = std::ranges::all_of(domain, [](const auto& range) { return range.has_value(); });
  if (spec.air.pockets == AirPockets::none || (box.isEmpty() && !repeats)) return;
  if (!(cells_over<Dim>(box, spacing_, domain) <= max_cells_of_map)) {
    throw CaseError(
        "air-map-too-large",
        {"{}: air is searched for in cells of half a particle spacing, and the walls and openings, wherever "
         "they move, span more than {:g} of them",
         CaseLabel("air").with_key("pockets"), max_cells_of_map},
        {"leave out distant parts, use a larger particles.spacing, or choose \"none\""});
  }
  grid_ = std::make_shared<const VoidGrid<Dim>>(box, spacing_, domain);
}

template <int Dim>
bool AirWatch<Dim>::is_due(const AirState& state) const {
  return is_on() && (!has_looked_ || state.displacement >= distance_between_looks * spacing_);
}

template <int Dim>
void AirWatch<Dim>::forget() {
  has_looked_ = false;
  forget_responses();
}

/// Whether another wall is less than dx/2 in front of x, the centre of a cell within dx/4 of a face. This closes all
/// gaps of less than dx/4 to air.
template <int Dim>
bool AirWatch<Dim>::is_in_gap(const Boundary<Dim>& boundary, int face, const Vec<Dim>& x) const {
  const Vec<Dim> in_front = x + 0.5 * spacing_ * boundary.faces[face].normal;
  const NearestWall<Dim> other = boundary.nearest(in_front, search_distance * spacing_);
  if (other.face < 0) return false;
  // At a corner it may be behind another face of its own wall.
  return other.signed_distance < 0.0 ||
         is_behind_touching_wall(boundary, boundary.faces[other.face].wall, other.signed_distance,
                                 corner_tolerance * spacing_, in_front);
}

/// Marks the cells near a row of a wall that are behind walls, or in a gap beside one that moves.
template <int Dim>
void AirWatch<Dim>::mark_wall(const Walls<Dim>& walls, std::size_t row, CellMarks& tested, CellMarks& solid) const {
  const Boundary<Dim>& boundary = walls.boundary;
  const Vec<Dim>& x = walls.particles.position[row];
  const bool moves = boundary.walls[walls.particles.wall[row]].moves();
  grid_->visit_ball(x, cover * spacing_, [&](int r, int begin, int end) {
    for (int place = tested.next_unmarked(r, begin, end); place < end;
         place = tested.next_unmarked(r, place + 1, end)) {
      const Vec<Dim> centre = grid_->centre(grid_->cell(r, place));
      const NearestWall<Dim> nearest = boundary.nearest(centre, search_distance * spacing_);
      if (nearest.face < 0) continue;
      const WallProperties& wall = boundary.walls[boundary.faces[nearest.face].wall];
      if ((wall.moves() && !moves) || wall.is_plate) {
        // The cell is behind this row's wall only as far as the row itself is.
        if ((centre - x).cwiseAbs().maxCoeff() <= 0.5 * spacing_) solid.mark(r, place, place + 1);
        continue;
      }
      tested.mark(r, place, place + 1);
      const double half = half_cell * grid_->edge().maxCoeff();
      const bool is_behind = nearest.signed_distance <= -half;
      if (is_behind || (moves && nearest.signed_distance < half && is_in_gap(boundary, nearest.face, centre))) {
        solid.mark(r, place, place + 1);
      }
    }
  });
}

/// Marks the cells at a row that stands in front of another wall, as of a lid between side walls that continue above
/// it. For these cells the other wall is nearer, and they are behind this wall as far as the row itself is: in its
/// cube, or between cubes, because the steps between rows fit the wall.
template <int Dim>
void AirWatch<Dim>::mark_across(const Walls<Dim>& walls, std::size_t row, CellMarks& solid) const {
  const Boundary<Dim>& boundary = walls.boundary;
  const Vec<Dim>& x = walls.particles.position[row];
  const int own = walls.particles.wall[row];
  std::vector<std::uint8_t> is_own(boundary.walls.size(), 0);
  is_own[static_cast<std::size_t>(own)] = 1;
  grid_->visit_ball(x, reach_of_row<Dim> * spacing_, [&](int r, int begin, int end) {
    for (int place = solid.next_unmarked(r, begin, end); place < end; place = solid.next_unmarked(r, place + 1, end)) {
      const Vec<Dim> centre = grid_->centre(grid_->cell(r, place));
      const NearestWall<Dim> nearest = boundary.nearest(centre, search_distance * spacing_);
      if (nearest.face < 0) continue;
      const WallFace<Dim>& face = boundary.faces[nearest.face];
      const bool is_other = face.wall != own && !boundary.walls[face.wall].is_plate;
      if (!is_other || face.height(x) <= 0.0) continue;
      const bool is_in_cube = (centre - x).cwiseAbs().maxCoeff() <= 0.5 * spacing_;
      if (is_in_cube || nearest_among<Dim>(boundary, is_own, centre, spacing_).signed_distance < 0.0) {
        solid.mark(r, place, place + 1);
      }
    }
  });
}

/// Marks the cells so near to a row of a plate that no step through the sides of cells passes the plate.
template <int Dim>
void AirWatch<Dim>::mark_plate(const Walls<Dim>& walls, std::size_t row, CellMarks& plates) const {
  const Boundary<Dim>& boundary = walls.boundary;
  const double reach = 0.51 * std::sqrt(static_cast<double>(Dim)) * grid_->edge().maxCoeff();
  grid_->visit_ball(walls.particles.position[row], cover * spacing_, [&](int r, int begin, int end) {
    for (int place = plates.next_unmarked(r, begin, end); place < end;
         place = plates.next_unmarked(r, place + 1, end)) {
      const Vec<Dim> centre = grid_->centre(grid_->cell(r, place));
      for (const int s : boundary.screens_near(centre, reach)) {
        const Screen<Dim>& screen = boundary.screens[s];
        const bool is_wall = screen.is_plate && !screen.is_beyond;
        if (is_wall && screen.distance(centre) <= reach) plates.mark(r, place, place + 1);
      }
    }
  });
}

template <int Dim>
void AirWatch<Dim>::mark_rows(const Walls<Dim>& walls, std::size_t from, std::size_t to, CellMarks& solid,
                              CellMarks& plates) const {
  CellMarks tested(grid_->rows(), grid_->length());
  for (std::size_t row = from; row < to; ++row) {
    if (walls.boundary.walls[walls.particles.wall[row]].is_plate) {
      mark_plate(walls, row, plates);
    } else {
      mark_wall(walls, row, tested, solid);
    }
  }
  for (std::size_t row = from; row < to; ++row) {
    if (!walls.boundary.walls[walls.particles.wall[row]].is_plate) mark_across(walls, row, solid);
  }
}

template <int Dim>
void AirWatch<Dim>::mark_resting(const Walls<Dim>& walls, const Communicator& ranks) {
  resting_ = CellMarks(grid_->rows(), grid_->length());
  resting_plates_ = resting_;
  mark_rows(walls, walls.moving, walls.kept, resting_, resting_plates_);
  ranks.unite(resting_.words());
  ranks.unite(resting_plates_.words());
  closed_ends_ = CellMarks(grid_->rows(), grid_->length());
  for (const AirEnd<Dim>& end : ends_) mark_end(end, closed_ends_);
  find_spaces(resting_, resting_plates_);
  if (walls.moving > 0) moving_ = make_wall_patches(walls.boundary, longest_piece * spacing_);
  std::erase_if(moving_, [&](const WallPatch<Dim>& patch) {
    return !walls.boundary.walls[walls.boundary.faces[patch.face].wall].moves();
  });
  knows_walls_ = true;
}

/// Marks the cells so near to an end that no step through the sides of cells passes the end.
template <int Dim>
void AirWatch<Dim>::mark_end(const AirEnd<Dim>& end, CellMarks& closed) const {
  const double reach = 0.51 * std::sqrt(static_cast<double>(Dim)) * grid_->edge().maxCoeff();
  for (const WallFace<Dim>& face : end.opening.as_faces()) {
    const Box<Dim> box = face.box();
    grid_->visit_ball(box.center(), 0.5 * box.diagonal().norm() + reach, [&](int row, int begin, int end_of_run) {
      for (int place = begin; place < end_of_run; ++place) {
        const Vec<Dim> centre = grid_->centre(grid_->cell(row, place));
        if ((centre - closest_point(face, centre)).norm() <= reach) closed.mark(row, place, place + 1);
      }
    });
  }
}

/// Determines the spaces that walls and ends close.
template <int Dim>
void AirWatch<Dim>::find_spaces(const CellMarks& solid, const CellMarks& plates) {
  CellMarks closed = solid;
  closed |= plates;
  closed |= closed_ends_;
  spaces_ = SealedSpaces<Dim>(*grid_, closed);
}

template <int Dim>
void AirWatch<Dim>::find_references(std::span<const FoundPocket> found) {
  reference_of_pocket_ = largest_of_space(found);
  reference_of_space_.clear();
  for (std::size_t k = 0; k < found.size(); ++k) {
    const int space = found[k].space;
    if (space < 0 || !spaces_.is_rigid(space)) {
      reference_of_pocket_[k] = -1;
    } else {
      reference_of_space_[space] = reference_of_pocket_[k];
    }
  }
}

template <int Dim>
int AirWatch<Dim>::reference_at(const Vec<Dim>& x) const {
  if (reference_of_space_.empty()) return -1;
  const auto reference = reference_of_space_.find(spaces_.near(*grid_, x, spacing_));
  return reference == reference_of_space_.end() ? -1 : reference->second;
}

template <int Dim>
std::vector<PocketShare> AirWatch<Dim>::fractions_at(const Boundary<Dim>& boundary, const Vec<Dim>& x) const {
  std::vector<PocketShare> shares = space_.shares_at(boundary, x);
  const int reference = reference_at(x);
  if (reference < 0) return shares;
  double rest = 1.0;
  for (const PocketShare& share : shares) {
    if (reference_of_pocket_[share.pocket] == reference) rest -= share.share;
  }
  const auto own = std::ranges::find(shares, reference, &PocketShare::pocket);
  if (own == shares.end()) {
    shares.push_back({reference, rest});
  } else {
    own->share += rest;
  }
  return shares;
}

template <int Dim>
void AirWatch<Dim>::find_openings(std::span<const Vec<Dim>> vents, std::size_t pockets) {
  openings_.assign(pockets, 0.0);
  for (std::size_t n = 0; n < vents.size(); ++n) {
    const int pocket = space_.pocket_at(vents[n]);
    if (pocket >= 0) openings_[pocket] += vents_[n].area / std::sqrt(vents_[n].loss);
  }
}

template <int Dim>
std::vector<PocketWall<Dim>> AirWatch<Dim>::walls_beside(const Boundary<Dim>& boundary) const {
  std::vector<PocketWall<Dim>> walls;
  for (const WallPatch<Dim>& patch : moving_) {
    const WallFace<Dim>& face = boundary.faces[patch.face];
    const Vec<Dim> x = patch.centre(boundary);
    std::vector<PocketShare> shares = fractions_at(boundary, x + sight_of_walls * spacing_ * face.normal);
    if (!shares.empty()) walls.push_back({face.wall, x, -patch.measure * face.normal, std::move(shares)});
  }
  return walls;
}

template <int Dim>
void AirWatch<Dim>::set_start_pressures(AirState& state) const {
  std::map<int, CaseLabel> given;
  for (const PocketTable& start : starts_) {
    const CaseLabel owner("pocket", start.name);
    const Vec<Dim> x = to_vec<Dim>(start.at, owner, "at");
    const int k = space_.pocket_at(x);
    if (k < 0) {
      throw CaseError("pocket-without-air",
                      {"{}: at {} there is no air at the start that water and walls enclose", owner, place(x)},
                      {"give a point in such air, or close the walls around it"});
    }
    if (const auto [other, is_new] = given.emplace(k, owner); !is_new) {
      throw CaseError("pocket-named-twice", {"{} is in the same air as {}", owner, other->second},
                      {"remove one of them"});
    }
    AirPocket& pocket = state.pockets[k];
    const double gas = law_.gas(start.overpressure, pocket.volume);
    state.gas_found += gas - pocket.gas;
    pocket.gas = gas;
  }
}

template <int Dim>
void AirWatch<Dim>::look(const Walls<Dim>& walls, std::span<const Vec<Dim>> vents, const Particles<Dim>& particles,
                         const Communicator& ranks, AirState& state) {
  const bool is_first = state.begun == 0;
  if (!knows_walls_) mark_resting(walls, ranks);
  CellMarks solid = resting_;
  CellMarks plates = resting_plates_;
  if (walls.moving > 0) mark_rows(walls, 0, walls.moving, solid, plates);
  CellMarks water = plates;
  for (std::size_t i = 0; i < particles.owned; ++i) {  // in order: marks cells that others mark too
    if (!particles.is_fluid(i)) continue;
    grid_->visit_ball(particles.position[i], cover * spacing_,
                      [&](int row, int begin, int end) { water.mark(row, begin, end); });
  }
  ranks.unite(water.words());
  const Voids<Dim> voids(*grid_, water, solid);
  if (walls.moving > 0) find_spaces(solid, plates);
  spaces_.find_ways_out(voids);
  for (const AirEnd<Dim>& end : ends_) {  // one that the case does not drive lets any volume pass
    const int space = end.feeds ? -1 : spaces_.near(*grid_, end.inside, spacing_);
    if (space >= 0) spaces_.set_yielding(space);
  }
  const std::int64_t begun_before = state.begun;
  const double pace = correction_of_volume(state.displacement, spacing_);
  std::vector<FoundPocket> found = follow_pockets<Dim>(*grid_, spacing_, voids, spaces_, law_, state);
  space_ = PocketSpace<Dim>(grid_, spacing_, voids, solid, walls.boundary, found);
  const std::vector<double> volumes = space_.volumes(walls.boundary, particles, ranks);
  const std::vector<std::int64_t> before = numbers_of(state.pockets);
  exchange_gas<Dim>(*grid_, spaces_, volumes, begun_before, pace, law_, found, state);
  find_references(found);
  take_over(std::move(found), volumes, pace, law_, state);
  // A pocket that begins or ends changes the air beside others.
  if (numbers_of(state.pockets) != before) forget_responses();
  find_openings(vents, state.pockets.size());
  if (is_first) set_start_pressures(state);
  has_looked_ = true;
}

template class AirWatch<2>;
template class AirWatch<3>;

}  // namespace tailwater
