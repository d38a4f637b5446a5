// Openings: flat pieces of a plane through which water passes, a segment in 2D and a rectangle in 3D. Those at inlets
// and outlets end the case; a section of a discharge probe is drawn inside it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "geometry/boundary.h"

namespace tailwater {

enum class OpeningKind { inlet, outlet, section };

template <int Dim>
struct Opening {
  OpeningKind kind = OpeningKind::outlet;
  std::string name;
  Vec<Dim> corner = Vec<Dim>::Zero();   ///< m; the edges start here
  std::array<Vec<Dim>, Dim - 1> edges;  ///< m; of full length, at right angles
  Vec<Dim> normal = Vec<Dim>::Zero();   ///< unit vector; of an inlet and an outlet out of the case

  /// Such as "outlet 'weir'".
  CaseLabel label() const;
  /// The direction in which water is meant to pass.
  Vec<Dim> direction() const { return kind == OpeningKind::inlet ? Vec<Dim>(-normal) : normal; }
  /// Distance beyond the plane, along its normal, m.
  double beyond(const Vec<Dim>& x) const { return normal.dot(x - corner); }
  /// Whether `x` is straight in front of the opening or behind it.
  bool spans(const Vec<Dim>& x) const;
  /// Whether water at `x` has left through it.
  bool is_passed_by(const Vec<Dim>& x) const { return beyond(x) > 0.0 && spans(x); }
  /// The faces of a wall that would close it, facing the water; they belong to no wall (-1).
  std::vector<WallFace<Dim>> as_faces() const;
};

/// The inlets of a case, then its outlets. Throws CaseError for one without
/// extent, one that is not a flat axis-parallel rectangle (3D), or a direction that runs along it.
template <int Dim>
std::vector<Opening<Dim>> make_open_ends(const CaseSpec& spec);

/// The section of a discharge probe; its normal is the direction that counts as positive. Throws CaseError likewise.
template <int Dim>
Opening<Dim> make_section(const ProbeTable& probe, double spacing);

}  // namespace tailwater
