// The last guard against passing through a wall: a fluid particle nearer than 0.05 dx to a wall, or behind it, is put
// back to that distance and loses the velocity into the wall. Counted: a sound run hardly needs it.
#pragma once

#include "geometry/boundary.h"
#include "neighbours/pairs.h"
#include "particles/particles.h"

namespace tailwater {

/// Acts on owned fluid particles that have a wall particle among their neighbours; returns how many were put back.
template <int Dim>
std::size_t keep_off_walls(const Pairs<Dim>& pairs, const Boundary<Dim>& boundary, double spacing,
                           Particles<Dim>& particles);

}  // namespace tailwater
