// Wall faces filed by place, so that faces near a point are found without looking at all of them.
#pragma once

#include <span>
#include <unordered_map>
#include <vector>

#include "geometry/point_grid.h"

namespace tailwater {

template <int Dim>
class FaceGrid {
 public:
  FaceGrid() = default;

  /// `reach`: distance (m) within which `near` finds faces.
  explicit FaceGrid(double reach) : reach_(reach) {}

  double reach() const { return reach_; }

  /// Files a face under `index`; `distance(x)` is its distance from x, `low` and `high` the corners of the box around
  /// it.
  template <class Distance>
  void add(int index, const Vec<Dim>& low, const Vec<Dim>& high, Distance&& distance) {
    const Cell<Dim> first = cell_of<Dim>(low - Vec<Dim>::Constant(reach_), reach_);
    const Cell<Dim> last = cell_of<Dim>(high + Vec<Dim>::Constant(reach_), reach_);
    const double half_diagonal = 0.5 * std::sqrt(Dim) * reach_;
    Cell<Dim> c = first;
    for (int axis = 0; axis < Dim;) {
      Vec<Dim> centre;
      for (int d = 0; d < Dim; ++d) centre[d] = (static_cast<double>(c[d]) + 0.5) * reach_;
      if (distance(centre) <= (1.0 + 1e-9) * (reach_ + half_diagonal)) faces_[cell_key<Dim>(c)].push_back(index);
      for (axis = 0; axis < Dim && ++c[axis] > last[axis]; ++axis) c[axis] = first[axis];
    }
  }

  /// All faces within reach of `x`, and some farther away, in the order in which they were added.
  std::span<const int> near(const Vec<Dim>& x) const {
    const auto found = faces_.find(cell_key<Dim>(cell_of<Dim>(x, reach_)));
    return found == faces_.end() ? std::span<const int>() : std::span<const int>(found->second);
  }

 private:
  double reach_ = 0.0;
  std::unordered_map<std::uint64_t, std::vector<int>> faces_;  ///< by cell
};

}  // namespace tailwater
