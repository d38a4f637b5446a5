// The terms of supports that vary (operators/support_terms.h), over the water of a flow.
#pragma once

#include <span>
#include <vector>

#include "flow/flow.h"

namespace tailwater {

/// Pressures [Pa] over c, which the gradient of a graded set reads in their place.
template <int Dim>
std::vector<double> over_references(const Flow<Dim>& flow, const std::vector<double>& pressure);

/// Adds the terms to the gradient of a pressure, at the water of this rank. Collective.
template <int Dim>
void add_support_gradient(const Flow<Dim>& flow, const std::vector<double>& over_reference,
                          std::span<Vec<Dim>> gradient);

/// Turns the divergence in the standard form at the water of this rank into the one with these terms. Collective.
template <int Dim>
void add_support_divergence(const Flow<Dim>& flow, std::span<const Vec<Dim>> velocity,
                            std::span<const Float4> in_single, std::span<double> divergence);

}  // namespace tailwater
