// Smoothing kernels W(r) with a support of radius R: W = 0 for r >= R, the integral over space is 1.
#pragma once

#include <numbers>
#include <variant>

#include "base/lanes.h"
#include "base/vec.h"

namespace tailwater {

/// Wendland's C2 kernel: W = s (1 - q)^4 (1 + 4 q), q = r/R. Its positive Fourier transform keeps particles from
/// pairing. Wendland (1995); Dehnen & Aly (2012), table 1.
template <int Dim, class Real = double>
class WendlandC2 {  // products in pairs, because loops wait for the longest chain of them
 public:
  explicit WendlandC2(double support_radius)
      : radius_(support_radius),
        inverse_radius_(1.0 / support_radius),
        scale_((Dim == 2 ? 7.0 : 10.5) / (std::numbers::pi * power<Dim>(support_radius))),
        slope_of_last_factor_(4.0 * scale_ * inverse_radius_),
        steepness_scale_(20.0 * scale_ * inverse_radius_ * inverse_radius_) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number a = distance_to_rim(r);
    const Number squared = a * a;
    return squared * squared * (scale_ + slope_of_last_factor_ * r);
  }

  template <class Number>
  Number steepness(Number r) const {
    const Number a = distance_to_rim(r);
    return (a * a) * (steepness_scale_ * a);
  }

 private:
  /// 1 - q, and 0 exactly at the rim
  template <class Number>
  Number distance_to_rim(Number r) const {
    return max_of(Number{}, radius_ - r) * inverse_radius_;
  }

  Real radius_;
  Real inverse_radius_;
  Real scale_;
  Real slope_of_last_factor_;
  Real steepness_scale_;
};

/// Cubic spline on a support R = 2h (Monaghan & Lattanzio 1985; B5): with s = r/h,
/// W = c (1 - 3/2 s^2 + 3/4 s^3) for s < 1, c/4 (2 - s)^3 for s < 2; in one piece, c/4 [(2 - s)+^3 - 4 (1 - s)+^3], x+
/// the larger of x and 0.
template <int Dim, class Real = double>
class CubicSpline {
 public:
  explicit CubicSpline(double support_radius)
      : radius_(support_radius),
        scale_((Dim == 2 ? 10.0 / 7.0 : 1.0) / (std::numbers::pi * power<Dim>(0.5 * support_radius))) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number s = (Real(2.0) / radius_) * r;
    const Number a = max_of(Number{}, Real(2.0) - s);
    const Number b = max_of(Number{}, Real(1.0) - s);
    return (Real(0.25) * scale_) * (a * a * a - Real(4.0) * b * b * b);
  }

  template <class Number>
  Number steepness(Number r) const {
    const Number s = (Real(2.0) / radius_) * r;
    const Number a = max_of(Number{}, Real(2.0) - s);
    return (Real(1.5) * scale_ / radius_) * (s < Real(1.0) ? s * (Real(4.0) - Real(3.0) * s) : a * a) / r;
  }

 private:
  Real radius_;
  Real scale_;
};

/// The quadratic kernel of Farzin et al. (2014), (F8): W = s (1 - q)^2, q = r/R, with s = 6/(pi R^2) in 2D. The paper
/// is 2D; in 3D the integral 4 pi R^3 (1/3 - 1/2 + 1/5) = 2 pi R^3/15 gives s = 15/(2 pi R^3).
template <int Dim, class Real = double>
class FarzinKernel {
 public:
  explicit FarzinKernel(double support_radius)
      : radius_(support_radius), scale_((Dim == 2 ? 6.0 : 7.5) / (std::numbers::pi * power<Dim>(support_radius))) {}

  Real radius() const { return radius_; }

  template <class Number>
  Number value(Number r) const {
    const Number a = max_of(Number{}, Real(1.0) - r / radius_);
    return scale_ * a * a;
  }

  template <class Number>
  Number steepness(Number r) const {
    return (Real(2.0) * scale_ / radius_) * max_of(Number{}, Real(1.0) - r / radius_) / r;
  }

 private:
  Real radius_;
  Real scale_;
};

enum class KernelName { wendland_c2, cubic_spline, farzin };

/// One of the kernels, chosen by name. Every alternative has `radius()` [m], `value(r)` [1/m^Dim] and `steepness(r)`, F
/// = -(dW/dr)/r [1/m^(Dim+2)]. `Real` is the type of its constants: double for distances in double precision, float for
/// distances in lanes.
template <int Dim, class Real = double>
using Kernel = std::variant<WendlandC2<Dim, Real>, CubicSpline<Dim, Real>, FarzinKernel<Dim, Real>>;

template <int Dim, class Real = double>
Kernel<Dim, Real> make_kernel(KernelName name, double radius) {
  switch (name) {
    case KernelName::cubic_spline:
      return CubicSpline<Dim, Real>(radius);
    case KernelName::farzin:
      return FarzinKernel<Dim, Real>(radius);
    case KernelName::wendland_c2:
      break;
  }
  return WendlandC2<Dim, Real>(radius);
}

template <int Dim>
double kernel_radius(const Kernel<Dim>& kernel) {
  return std::visit([](const auto& chosen) { return chosen.radius(); }, kernel);
}

/// The kernel `kernel` for distances in lanes.
template <int Dim>
Kernel<Dim, float> in_single_precision(const Kernel<Dim>& kernel) {
  return std::visit(
      []<template <int, class> class Chosen>(const Chosen<Dim, double>& chosen) -> Kernel<Dim, float> {
        return Chosen<Dim, float>(chosen.radius());
      },
      kernel);
}

/// Calls body with the chosen kernel. The default kernel is tested first, inside the caller's loop, for speed.
template <int Dim, class Real, class Body>
inline auto with_kernel(const Kernel<Dim, Real>& kernel, Body&& body) {
  if (const auto* wendland = std::get_if<WendlandC2<Dim, Real>>(&kernel)) [[likely]]
    return body(*wendland);
  return std::visit(body, kernel);
}

template <int Dim, class Real, class Number>
inline Number kernel_value(const Kernel<Dim, Real>& kernel, Number r) {
  return with_kernel<Dim, Real>(kernel, [r](const auto& chosen) { return chosen.value(r); });
}

/// -(dW/dr)/r, never negative; r is not 0.
template <int Dim, class Real, class Number>
inline Number kernel_steepness(const Kernel<Dim, Real>& kernel, Number r) {
  return with_kernel<Dim, Real>(kernel, [r](const auto& chosen) { return chosen.steepness(r); });
}

}  // namespace tailwater
