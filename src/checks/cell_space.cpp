#include "checks/cell_space.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/box.h"
#include "geometry/from_spec.h"
#include "geometry/images.h"

namespace tailwater {
template <int Dim>
std::vector<WallFace<Dim>> faces_with(const Boundary<Dim>& boundary, const std::vector<Opening<Dim>>& ends) {
  std::vector<WallFace<Dim>> faces = boundary.faces;
  for (const Opening<Dim>& end : ends) {
    const std::vector<WallFace<Dim>> closing = end.as_faces();
    faces.insert(faces.end(), closing.begin(), closing.end());
  }
  return faces;
}

template <int Dim>
CellSpace<Dim>::CellSpace(const CaseSpec& spec, std::vector<WallFace<Dim>> faces, const Box<Dim>& water, double most)
    : domain_(periodic_domain<Dim>(spec.domain)), tolerance_(mesh_tolerance * spec.particles.spacing) {
  const Box<Dim> box = water.merged(box_around(faces));
  low_ = box.min();
  const Vec<Dim> high = box.max();
  const Vec<Dim> extent = (high - low_).cwiseMax(spec.particles.spacing);
  double cell = std::max(spec.particles.spacing, std::pow(extent.prod() / most, 1.0 / Dim));
  // Larger cells than the thickness of the case would be more along its other extents.
  const auto cells_in_all = [&] { return (extent / cell).cwiseMax(1.0).prod(); };
  while (cells_in_all() > 1.001 * most) cell *= 2.0;
  std::size_t cells = 1;
  for (int axis = 0; axis < Dim; ++axis) {
    const std::vector<double>& range = periodic_range(spec.domain, axis);
    is_periodic_[axis] = range.size() == 2;
    if (is_periodic_[axis]) {
      low_[axis] = range[0];
      count_[axis] = std::max(1, static_cast<int>(std::round((range[1] - range[0]) / cell)));
      size_[axis] = (range[1] - range[0]) / count_[axis];
    } else {
      count_[axis] = std::max(1, static_cast<int>(std::ceil((high[axis] - low_[axis]) / cell - corner_tolerance)));
      size_[axis] = cell;
    }
    cells *= count_[axis];
  }
  near_faces_.resize(cells + 1);
  set_faces(std::move(faces));
}

template <int Dim>
std::size_t CellSpace<Dim>::index(const Cell& c) const {
  std::size_t i = 0;
  for (int axis = Dim - 1; axis >= 0; --axis) i = i * count_[axis] + c[axis];
  return i;
}

template <int Dim>
typename CellSpace<Dim>::Cell CellSpace<Dim>::cell(std::size_t index) const {
  Cell c;
  for (int axis = 0; axis < Dim; index /= count_[axis++]) c[axis] = static_cast<int>(index % count_[axis]);
  return c;
}

template <int Dim>
Vec<Dim> CellSpace<Dim>::centre(const Cell& c) const {
  Vec<Dim> x;
  for (int axis = 0; axis < Dim; ++axis) x[axis] = low_[axis] + (c[axis] + 0.5) * size_[axis];
  return x;
}

template <int Dim>
typename CellSpace<Dim>::Cell CellSpace<Dim>::cell_of(const Vec<Dim>& x) const {
  Cell c;
  for (int axis = 0; axis < Dim; ++axis) {
    c[axis] = static_cast<int>(std::clamp(std::floor((x[axis] - low_[axis]) / size_[axis]), 0.0, count_[axis] - 1.0));
  }
  return c;
}

template <int Dim>
Vec<Dim> CellSpace<Dim>::across_periods(Vec<Dim> v) const {
  for (int axis = 0; axis < Dim; ++axis) v[axis] = is_periodic_[axis] ? 0.0 : v[axis];
  return v;
}

template <int Dim>
std::optional<typename CellSpace<Dim>::Cell> CellSpace<Dim>::next(Cell c, int axis, int step) const {
  c[axis] += step;
  if (is_periodic_[axis]) c[axis] = (c[axis] + count_[axis]) % count_[axis];
  if (c[axis] < 0 || c[axis] >= count_[axis]) return std::nullopt;
  return c;
}

template <int Dim>
void CellSpace<Dim>::set_faces(std::vector<WallFace<Dim>> faces) {
  faces_ = std::move(faces);
  image_of_.clear();
  const Box<Dim> space = space_around<Dim>(domain_, size_.maxCoeff());
  for (int f = 0, count = static_cast<int>(faces_.size()); f < count; ++f) {
    visit_images<Dim>(domain_, faces_[f].box(), space, [&](const Vec<Dim>& by) {
      faces_.push_back(faces_[f].moved(by));
      image_of_.push_back(f);
    });
  }
  const auto for_each_near = [&](auto&& visit) {
    for (std::size_t f = faces_.size(); f-- > 0;) {
      visit_around(faces_[f], faces_[f], [&](const Cell& c) { visit(index(c), static_cast<int>(f)); });
    }
  };
  // First the number of faces of each cell, then the end of its list; filling it from the end leaves its begin.
  std::fill(near_faces_.begin(), near_faces_.end(), 0);
  for_each_near([&](std::size_t c, int) { ++near_faces_[c]; });
  std::partial_sum(near_faces_.begin(), near_faces_.end(), near_faces_.begin());
  near_list_.resize(near_faces_.back());
  for_each_near([&](std::size_t c, int f) { near_list_[--near_faces_[c]] = f; });
}

template <int Dim>
bool CellSpace<Dim>::passes(const WallFace<Dim>& face, const Vec<Dim>& from, const Vec<Dim>& to) const {
  const double before = face.height(from);
  const double after = face.height(to);
  const bool leads_behind = before >= -tolerance_ && after < -tolerance_;
  if ((before >= 0.0) == (after >= 0.0) && !leads_behind) return false;
  const Vec<Dim> hit = before < 0.0 && leads_behind ? from : meet(face, from, to);
  return (closest_point(face, hit) - hit).norm() <= tolerance_;
}

template <int Dim>
bool CellSpace<Dim>::is_behind_walls(const Cell& c) const {
  const Vec<Dim> x = centre(c);
  double least = std::numeric_limits<double>::infinity();
  bool is_behind = false;  // behind all of the nearest faces, as the two that meet at a convex edge
  for (std::size_t k = near_faces_[index(c)]; k < near_faces_[index(c) + 1]; ++k) {
    const WallFace<Dim>& face = faces_[near_list_[k]];
    const double distance = (closest_point(face, x) - x).norm();
    if (distance > least + tolerance_) continue;
    const bool is_behind_face = face.height(x) < 0.0;
    is_behind = is_behind_face && (is_behind || distance < least - tolerance_);
    least = std::min(least, distance);
  }
  return is_behind && least > tolerance_;
}

template <int Dim>
int CellSpace<Dim>::face_at(const Cell& c) const {
  const Vec<Dim> x = centre(c);
  for (std::size_t k = near_faces_[index(c)]; k < near_faces_[index(c) + 1]; ++k) {
    if ((closest_point(faces_[near_list_[k]], x) - x).norm() <= tolerance_) return drawn(near_list_[k]);
  }
  return -1;
}

template <int Dim>
int CellSpace<Dim>::first_passed(const Cell& c, const Vec<Dim>& from, const Vec<Dim>& to) const {
  int first = -1;
  double least = std::numeric_limits<double>::infinity();  // fraction of the line before the first face
  for (std::size_t k = near_faces_[index(c)]; k < near_faces_[index(c) + 1]; ++k) {
    const WallFace<Dim>& face = faces_[near_list_[k]];
    if (!passes(face, from, to)) continue;
    const double share = face.height(from) / (face.height(from) - face.height(to));
    if (share < least) {
      least = share;
      first = near_list_[k];
    }
  }
  return first;
}

template <int Dim>
int CellSpace<Dim>::face_between(const Cell& c, const Vec<Dim>& from, const Vec<Dim>& to) const {
  const int first = first_passed(c, from, to);
  return first < 0 ? first : drawn(first);
}

template <int Dim>
int CellSpace<Dim>::face_beside(const Cell& c, int axis, int step) const {
  Cell beside = c;
  beside[axis] += step;  // also beyond a periodic end
  return face_between(c, centre(c), centre(beside));
}

template <int Dim>
template <class Visit>
void CellSpace<Dim>::visit_fronts_beside(const Cell& c, int axis, int step, Visit&& visit) const {
  Cell beside = c;
  beside[axis] += step;
  const Vec<Dim> from = centre(c);
  const Vec<Dim> to = centre(beside);
  const int first = first_passed(c, from, to);
  if (first < 0) return;
  const auto share_to = [&](const WallFace<Dim>& face) {
    return face.height(from) / (face.height(from) - face.height(to));
  };
  const double nearest = share_to(faces_[first]) + corner_tolerance;
  for (std::size_t k = near_faces_[index(c)]; k < near_faces_[index(c) + 1]; ++k) {
    const WallFace<Dim>& face = faces_[near_list_[k]];
    if (face.height(from) >= 0.0 && passes(face, from, to) && share_to(face) <= nearest) visit(drawn(near_list_[k]));
  }
}

namespace {

/// Height [m] by which a path from cell to cell must be free to vary so that it can follow any level plane. The cells
/// in a layer of the thickness sum_a |n_a| dx along the normal n of a plane are connected by their faces, and those in
/// a thinner one are not (Andres, Acharya & Sibata 1997); 0 if the cells themselves are level.
template <int Dim>
double height_of_level_path(const CellSpace<Dim>& space, const Vec<Dim>& down) {
  int axes = 0;
  double height = 0.0;
  for (int axis = 0; axis < Dim; ++axis) {
    height += std::abs(down[axis]) * space.size()[axis];
    axes += down[axis] != 0.0 ? 1 : 0;
  }
  return axes > 1 ? height : 0.0;
}

}  // namespace

template <int Dim>
Spread<Dim> spread(const CellSpace<Dim>& space, const std::vector<typename CellSpace<Dim>::Cell>& start,
                   const Vec<Dim>& down, Edge edge) {
  using Cell = typename CellSpace<Dim>::Cell;
  Spread<Dim> found;
  found.met.assign(space.faces().size(), false);
  found.wet.assign(space.faces().size(), false);
  found.behind.assign(space.faces().size(), std::nullopt);
  const double tolerance = corner_tolerance * space.edge();
  const double freedom =
      std::max(0.0, height_of_level_path(space, down) - 4.0 * tolerance);  // of the layer without its top
  const auto height_of = [&](const Cell& c) { return -space.centre(c).dot(down); };
  // By cell: the height up to which the water in it can move on, that of the lowest place on the best way to it. A
  // better way may be found later.
  std::vector<double> reach(space.count(), -std::numeric_limits<double>::infinity());
  std::vector<Cell> cells;
  std::vector<bool> is_first;
  const auto visit = [&](const Cell& c, double height) {
    double& known = reach[space.index(c)];
    if (height <= known + tolerance) return;
    is_first.push_back(std::isinf(known));
    cells.push_back(c);
    known = height;
  };
  for (const Cell& c : start) visit(c, height_of(c));
  for (std::size_t k = 0; k < cells.size() && !found.way_out; ++k) {
    const Cell c = cells[k];
    if (is_first[k]) found.cells.push_back(c);
    const double highest = reach[space.index(c)];
    for (int move = 0; move < 2 * Dim && !found.way_out; ++move) {
      const int axis = move / 2;
      const int step = move % 2 == 0 ? -1 : 1;
      const double height = height_of(c) - step * space.size()[axis] * down[axis];
      if (height > highest + tolerance) continue;
      if (const int face = space.face_beside(c, axis, step); face >= 0) {
        found.met[face] = true;
        if (space.is_behind_walls(c)) found.behind[face] = space.centre(c);
        space.visit_fronts_beside(c, axis, step, [&](int front) { found.wet[front] = true; });
        if (is_first[k]) ++found.sides;
        continue;
      }
      const std::optional<Cell> beside = space.next(c, axis, step);
      if (beside) visit(*beside, std::min(highest, height_of(*beside) + freedom));
      if (!beside && edge == Edge::leads_out) found.way_out = space.centre(c);
    }
  }
  return found;
}

template <int Dim>
std::optional<typename CellSpace<Dim>::Cell> cell_inside(const CellSpace<Dim>& space, const Opening<Dim>& end,
                                                         const Vec<Dim>& place_on_end) {
  const Vec<Dim> inside = place_on_end - space.edge() * end.normal;
  const auto c = space.cell_of(inside);
  if (space.face_between(c, inside, space.centre(c)) >= 0) return std::nullopt;
  return c;
}

template <int Dim>
std::vector<typename CellSpace<Dim>::Cell> cells_of(const CellSpace<Dim>& space, const FluidParticles<Dim>& fluid) {
  std::vector<int> is_wet(space.count(), 0);
  for (const Vec<Dim>& x : fluid.position) {
    const auto c = space.cell_of(x);
    if (space.face_between(c, x, space.centre(c)) < 0) is_wet[space.index(c)] = 1;
  }
  fluid.ranks.largest_of_each(is_wet);
  std::vector<typename CellSpace<Dim>::Cell> cells;
  for (std::size_t c = 0; c < is_wet.size(); ++c) {
    if (is_wet[c] != 0) cells.push_back(space.cell(c));
  }
  return cells;
}

template class CellSpace<2>;
template class CellSpace<3>;
TAILWATER_IN_2D_AND_3D(faces_with);
TAILWATER_IN_2D_AND_3D(spread);
TAILWATER_IN_2D_AND_3D(cell_inside);
TAILWATER_IN_2D_AND_3D(cells_of);

}  // namespace tailwater
