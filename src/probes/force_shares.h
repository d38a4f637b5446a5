// How the force through a particle is divided between the patches of walls near it (docs/theory/probes.md).
#pragma once

#include <span>

#include "motion/floating_body.h"
#include "parallel/communicator.h"

namespace tailwater {

/// e: the fraction of a force that a patch takes whatever its normal. Without it, nearly parallel normals would enlarge
/// forces along both of them by one over their angle; ten times as much would mix the walls of a corner of 30 degrees.
inline constexpr double indifference = 1e-3;

template <int Dim>
using Moment = Turn<Dim>;

template <int Dim>
struct WallLoads {
  Vec<Dim> pressure = Vec<Dim>::Zero();
  Vec<Dim> friction = Vec<Dim>::Zero();
  Moment<Dim> moment = Moment<Dim>::Zero();
  double power = 0.0;  ///< of the walls on the water

  WallLoads& operator+=(const WallLoads& other) {
    pressure += other.pressure;
    friction += other.friction;
    moment += other.moment;
    power += other.power;
    return *this;
  }
  friend WallLoads operator+(WallLoads a, const WallLoads& b) { return a += b; }
  Vec<Dim> force() const { return pressure + friction; }

  /// Adds up those of all ranks. Collective.
  void gather(const Communicator& ranks) {
    Vec<2 * Dim + turns<Dim> + 1> sums;
    sums.put(0, pressure);
    sums.put(Dim, friction);
    sums.put(2 * Dim, moment);
    sums[2 * Dim + turns<Dim>] = power;
    ranks.sum_of_each(std::span(sums.data(), sums.size()));
    pressure = sums.template head<Dim>();
    friction = sums.template segment<Dim>(Dim);
    moment = sums.template segment<turns<Dim>>(2 * Dim);
    power = sums[2 * Dim + turns<Dim>];
  }
};

/// The sum of A_k over some of the patches near a particle.
template <int Dim>
struct Shares {
  double weight = 0.0;
  Mat<Dim> normals = Mat<Dim>::Zero();  ///< sum of weight n n^T

  void add(double weight_of_patch, const Vec<Dim>& n) {
    weight += weight_of_patch;
    normals += (weight_of_patch * n) * n.transpose();
  }
  Shares& operator+=(const Shares& other) {
    weight += other.weight;
    normals += other.normals;
    return *this;
  }
  Shares scaled(double factor) const { return {factor * weight, factor * normals}; }
  /// For the pressure.
  Mat<Dim> across() const { return normals + indifference * weight * Mat<Dim>::Identity(); }
  /// For friction.
  Mat<Dim> along() const { return (1.0 + indifference) * weight * Mat<Dim>::Identity() - normals; }
  Vec<Dim> across_inverse(const Vec<Dim>& force) const { return (across() / weight).inverse() * (force / weight); }
  Vec<Dim> along_inverse(const Vec<Dim>& force) const { return (along() / weight).inverse() * (force / weight); }
};

template <int Dim>
struct Sharing {
  Shares<Dim> of_pressure;
  Shares<Dim> of_friction;
};

}  // namespace tailwater
