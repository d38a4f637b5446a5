// Walls that face each other.
#pragma once

#include "base/vec.h"

namespace tailwater {

/// Whether walls with these normals face each other, or are back to back: the angle between them is over 160 degrees.
template <int Dim>
bool face_each_other(const Vec<Dim>& a, const Vec<Dim>& b) {
  constexpr double cosine = -0.94;
  return a.dot(b) < cosine;
}

}  // namespace tailwater
