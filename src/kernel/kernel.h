// Smoothing kernels W(r) with a support of radius R: W = 0 for r >= R, the integral over space is 1.
#pragma once

#include <variant>

#include "kernel/cubic_spline.h"
#include "kernel/farzin.h"
#include "kernel/wendland_c2.h"

namespace tailwater {

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
