// Points filed by place, so that points near a place are found without looking at all of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "base/vec.h"

namespace tailwater {

/// A cube of space, by its place in a regular grid.
template <int Dim>
using Cell = std::array<std::int64_t, Dim>;

template <int Dim>
Cell<Dim> cell_of(const Vec<Dim>& x, double edge) {
  constexpr double beyond = 1e15;  // the place of a runaway particle may not fit an integer
  Cell<Dim> c;
  for (int axis = 0; axis < Dim; ++axis) {
    c[axis] = static_cast<std::int64_t>(std::clamp(std::floor(x[axis] / edge), -beyond, beyond));
  }
  return c;
}

/// 21 bits per axis: cells may share a key.
template <int Dim>
std::uint64_t cell_key(const Cell<Dim>& c) {
  std::uint64_t k = 0;
  for (const std::int64_t coordinate : c) k = k << 21 ^ (static_cast<std::uint64_t>(coordinate) & 0x1fffff);
  return k;
}

/// Calls visit(cell) for the 3^Dim cells around a cell, itself among them and first.
template <int Dim, class Visit>
void for_each_around(const Cell<Dim>& cell, Visit&& visit) {
  for (int n = 0; n < static_cast<int>(power<Dim>(3)); ++n) {
    Cell<Dim> around = cell;
    for (int axis = 0, rest = n; axis < Dim; ++axis, rest /= 3) around[axis] += (rest + 1) % 3 - 1;
    visit(around);
  }
}

template <int Dim>
class PointGrid {
 public:
  /// `radius`: distance (m) within which `visit_near` finds points.
  explicit PointGrid(double radius) : radius_(radius) {}

  void add(const Vec<Dim>& x) {
    const auto [head, is_new] = first_.try_emplace(cell_key<Dim>(cell_of<Dim>(x, radius_)), -1);
    next_.push_back(head->second);
    head->second = static_cast<int>(points_.size());
    points_.push_back(x);
  }

  /// Calls `visit(index)`, in no particular order, for every point added so far that is nearer to `x` than the radius;
  /// the first point added has index 0.
  template <class Visit>
  void visit_near(const Vec<Dim>& x, Visit&& visit) const {
    for_each_around<Dim>(cell_of<Dim>(x, radius_), [&](const Cell<Dim>& c) {
      const auto found = first_.find(cell_key<Dim>(c));
      for (int i = found == first_.end() ? -1 : found->second; i >= 0; i = next_[i]) {
        if ((points_[i] - x).norm() < radius_) visit(i);
      }
    });
  }

  bool has_near(const Vec<Dim>& x) const {
    bool found = false;
    visit_near(x, [&](int) { found = true; });
    return found;
  }

 private:
  double radius_;
  std::unordered_map<std::uint64_t, int> first_;
  std::vector<int> next_;
  std::vector<Vec<Dim>> points_;
};

}  // namespace tailwater
