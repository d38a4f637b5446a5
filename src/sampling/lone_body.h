// The walls of one body, as they are sampled: bodies separate, so each is sampled as if it were alone.
#pragma once

#include "geometry/boundary.h"

namespace tailwater {

/// A body with its own faces only, without plates.
template <int Dim>
struct LoneBody {
  Boundary<Dim> boundary;
  int meshes;  ///< the first ones of the boundary; the others are their images in other periods
};

/// One body of a case. Images of its meshes reach as far as `margin` (m) beyond the domain.
template <int Dim>
LoneBody<Dim> body_alone(const Boundary<Dim>& boundary, int body, double margin);

}  // namespace tailwater
