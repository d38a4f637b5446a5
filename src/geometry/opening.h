// Openings: flat pieces of a plane through which water passes, a segment in 2D and a rectangle or a polygon in 3D. At
// those of inlets and outlets the case ends; a section of a discharge probe is drawn inside it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/vec.h"
#include "geometry/face.h"
#include "geometry/polygon.h"

namespace tailwater {

struct CaseLabel;
struct CaseSpec;
struct ProbeTable;

enum class OpeningKind { inlet, outlet, section };

template <int Dim>
struct Opening {
  OpeningKind kind = OpeningKind::outlet;
  std::string name;
  Vec<Dim> corner = Vec<Dim>::Zero();   ///< m; the edges start here
  std::array<Vec<Dim>, Dim - 1> edges;  ///< m; of full length, at right angles; of a rectangle around the outline
  Vec<Dim> normal = Vec<Dim>::Zero();   ///< unit vector; of an inlet and an outlet out of the case
  Polygon outline = {};                 ///< m; along the edges, from the corner; empty: the segment or rectangle itself
  bool meets_air = false;               ///< beyond it is air, not water

  /// Such as "outlet 'weir'".
  CaseLabel label() const;
  /// The direction in which water is meant to pass.
  Vec<Dim> direction() const { return kind == OpeningKind::inlet ? Vec<Dim>(-normal) : normal; }
  /// Distance beyond the plane, along its normal, m.
  double beyond(const Vec<Dim>& x) const { return normal.dot(x - corner); }
  /// Whether `x` is straight in front of the opening or behind it.
  bool spans(const Vec<Dim>& x) const;
  /// Distance [m] of `x` from the space straight in front of the segment or rectangle and behind it; at most 0 inside
  /// this space.
  double aside(const Vec<Dim>& x) const;
  /// Whether water at `x` has left through it.
  bool is_passed_by(const Vec<Dim>& x) const { return beyond(x) > 0.0 && spans(x); }
  /// The corners of its rim in order.
  std::vector<Vec<Dim>> rim() const;
  /// A copy of the opening, farther out by a distance [m].
  Opening moved_out(double distance) const;
  /// The faces of a wall that would close it, facing the water; they belong to no wall (-1).
  std::vector<WallFace<Dim>> as_faces() const;
};

/// The inlets of a case, then its outlets. Throws CaseError for one without extent, one that is not flat, a rectangle
/// that is not axis-parallel (3D), or a direction that runs along it.
template <int Dim>
std::vector<Opening<Dim>> make_open_ends(const CaseSpec& spec);

/// The case with the sections that its openings have `through` a point, so that make_open_ends need not find them among
/// the walls at each call. Throws CaseError as make_open_ends does.
CaseSpec with_sections_found(const CaseSpec& spec);

/// The section of a discharge probe; its normal is the direction that counts as positive. Throws CaseError likewise.
template <int Dim>
Opening<Dim> make_section(const ProbeTable& probe, double spacing);

}  // namespace tailwater
