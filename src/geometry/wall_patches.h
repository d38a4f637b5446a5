// Patches of walls, with edges of about dx, which move with their faces: points of action of forces on walls, and cells
// of wall maps.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/boundary.h"

namespace tailwater {

template <int Dim>
struct WallPatch {
  int face;                                          ///< index into Boundary::faces
  std::array<std::array<double, Dim>, Dim> corners;  ///< for each corner, its weights of the face's corners
  double measure;                                    ///< m or m^2

  Vec<Dim> corner(const Boundary<Dim>& boundary, int c) const {
    Vec<Dim> x = Vec<Dim>::Zero();
    for (int k = 0; k < Dim; ++k) x += corners[c][k] * boundary.faces[face].corners[k];
    return x;
  }
  Vec<Dim> centre(const Boundary<Dim>& boundary) const {
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (int c = 0; c < Dim; ++c) sum += corner(boundary, c);
    return sum / Dim;
  }
};

/// dx; upper limit for the edges of patches.
inline constexpr double longest_patch_edge = 1.5;

/// Upper limit for the number of patches, which then take about 10 GB.
inline constexpr double max_wall_patches = 1e8;

/// A fraction, at most 1, at each place; empty: 1 everywhere.
template <int Dim>
using FractionAt = std::function<double(const Vec<Dim>&)>;

/// Patches of all faces, halved at their longest edges until none is longer than `longest` [m] times `fraction_at` its
/// centre. Walls that have moved have as many patches as the walls as drawn. The patches of a face are consecutive.
/// Throws CaseError for more than `max_wall_patches` of them where the fraction is 1, before it allocates memory.
template <int Dim>
std::vector<WallPatch<Dim>> make_wall_patches(const Boundary<Dim>& boundary, double longest,
                                              const FractionAt<Dim>& fraction_at = {});

/// The pieces of one patch, divided in the same way.
template <int Dim>
std::vector<WallPatch<Dim>> pieces_of(const WallPatch<Dim>& patch, const Boundary<Dim>& boundary, double longest);

}  // namespace tailwater
