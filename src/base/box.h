// A box along the axes, and the intervals in which space repeats.
#pragma once

#include "base/vec.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

namespace tailwater {

// NOLINTBEGIN(readability-identifier-naming): the names of Eigen's AlignedBox
/// All points between `min` and `max`, both included; none at first.
template <int Dim>
class Box {
 public:
  Box() = default;
  Box(const Vec<Dim>& min, const Vec<Dim>& max) : min_(min), max_(max) {}
  explicit Box(const Vec<Dim>& point) : min_(point), max_(point) {}

  const Vec<Dim>& min() const { return min_; }
  Vec<Dim>& min() { return min_; }
  const Vec<Dim>& max() const { return max_; }
  Vec<Dim>& max() { return max_; }
  Vec<Dim> sizes() const { return max_ - min_; }
  Vec<Dim> diagonal() const { return sizes(); }
  Vec<Dim> center() const { return (min_ + max_) / 2.0; }
  double volume() const { return isEmpty() ? 0.0 : sizes().prod(); }
  /// A corner: bit d is set for the upper end of direction d.
  Vec<Dim> corner(unsigned bits) const {
    return Vec<Dim>::NullaryExpr([&](int d) { return (bits >> d & 1U) != 0 ? max_[d] : min_[d]; });
  }

  bool isEmpty() const {
    return any([this](int d) { return min_[d] > max_[d]; });
  }
  bool contains(const Vec<Dim>& x) const {
    return !any([&](int d) { return x[d] < min_[d] || x[d] > max_[d]; });
  }
  bool contains(const Box& other) const { return contains(other.min_) && contains(other.max_); }
  bool intersects(const Box& other) const {
    return !any([&](int d) { return min_[d] > other.max_[d] || other.min_[d] > max_[d]; });
  }

  Box& extend(const Vec<Dim>& x) {
    min_ = min_.cwiseMin(x);
    max_ = max_.cwiseMax(x);
    return *this;
  }
  Box& extend(const Box& other) {
    min_ = min_.cwiseMin(other.min_);
    max_ = max_.cwiseMax(other.max_);
    return *this;
  }
  /// Moves every side outwards by this length.
  Box& widen(double length) {
    min_ -= Vec<Dim>::Constant(length);
    max_ += Vec<Dim>::Constant(length);
    return *this;
  }
  Box merged(const Box& other) const { return Box(*this).extend(other); }
  Box intersection(const Box& other) const { return {min_.cwiseMax(other.min_), max_.cwiseMin(other.max_)}; }

  double squaredExteriorDistance(const Vec<Dim>& x) const {
    return (x - x.cwiseMax(min_).cwiseMin(max_)).squaredNorm();
  }
  double exteriorDistance(const Vec<Dim>& x) const { return std::sqrt(squaredExteriorDistance(x)); }
  double exteriorDistance(const Box& other) const {
    const Vec<Dim> gap = (other.min_ - max_).cwiseMax(min_ - other.max_).cwiseMax(0.0);
    return gap.norm();
  }

 private:
  template <typename Condition>
  static bool any(Condition&& holds_along) {
    for (int d = 0; d < Dim; ++d) {
      if (holds_along(d)) return true;
    }
    return false;
  }

  Vec<Dim> min_ = Vec<Dim>::Constant(std::numeric_limits<double>::max());
  Vec<Dim> max_ = Vec<Dim>::Constant(std::numeric_limits<double>::lowest());
};

// NOLINTEND(readability-identifier-naming)

/// For each direction the interval [m] that repeats, if any.
template <int Dim>
using PeriodicDomain = std::array<std::optional<std::pair<double, double>>, Dim>;

}  // namespace tailwater
