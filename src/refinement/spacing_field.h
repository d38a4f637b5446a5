// The spacing of particles as a smooth field of the place. It is that of the case outside of all zones of refinement
// and falls by the level of a zone from its faces inwards:
//
//   h(x) = min over zones of 2^(-level S),    S = product over the faces of the zone of s(depth behind the face/border)
//
// s is the smooth step 3 q^2 - 2 q^3 from 0 to 1. A zone that is a polygon, or around walls, has one depth
// (zone_depth.h). The supports of particles follow h, not their volumes: particles of
// several volumes that stand side by side have nearly the same support, and pairs are symmetric
// (docs/theory/refinement.md).
//
// A zone around walls that move is carried by them, and others may have a displacement of their own: h(x, t) is the h
// of the place from which the motion has taken x.
#pragma once

#include <memory>
#include <vector>

#include "base/box.h"
#include "base/vec.h"
#include "case/time_function.h"

namespace tailwater {

struct CaseSpec;
template <int Dim>
struct Boundary;

/// Width of a border over dx of the case, per level.
inline constexpr double border_per_level = 4.0;

template <int Dim>
class ZoneDepth;

template <int Dim>
class SpacingField {
 public:
  /// 1 everywhere.
  SpacingField() = default;
  /// Faces of zones that reach to the outermost walls or beyond bound nothing, unless the zones leave these walls.
  /// Throws CaseError for a zone below the initial surface if there is no water at the start, and for a displacement of
  /// another dimension.
  SpacingField(const CaseSpec& spec, const Boundary<Dim>& boundary);

  /// A zone, of which a face that bounds nothing is infinitely far away.
  struct Zone {
    Box<Dim> box;  ///< m; around the zone if it has a depth
    int level;
    double border;                                ///< m
    std::shared_ptr<const ZoneDepth<Dim>> depth;  ///< null for boxes
  };

  const std::vector<Zone>& zones() const { return zones_; }
  bool is_uniform() const { return zones_.empty(); }
  bool moves() const { return motion_ != nullptr; }
  /// Index into Boundary::walls of a wall that carries the zones; -1: there is none.
  int carrier() const { return carrier_; }
  /// Moves the zones of this field, and of all copies of it, from where they are drawn by x -> turn x + shift.
  void carry(const Mat<Dim>& turn, const Vec<Dim>& shift) const;
  /// m; the displacement of the zones of their own at a time [s]. It may be infinite or not a number.
  Vec<Dim> displacement(double time) const;
  /// The place from which the motion of the zones has taken x.
  Vec<Dim> drawn(const Vec<Dim>& x) const {
    return motion_ == nullptr ? x : Vec<Dim>(motion_->turn.transpose() * (x - motion_->shift));
  }
  /// How the zones have turned since they were drawn.
  Mat<Dim> turn() const { return motion_ == nullptr ? Mat<Dim>(Mat<Dim>::Identity()) : motion_->turn; }
  /// h; 1 is the spacing of the case.
  double at(const Vec<Dim>& x) const { return at_drawn(drawn(x)); }
  /// h at a place in the case as drawn.
  double at_drawn(const Vec<Dim>& x) const;
  /// 1/m; grad h.
  Vec<Dim> slope(const Vec<Dim>& x) const;
  /// The least h there is.
  double finest() const;
  /// Whether h varies within `reach` [m] of `x`, as drawn. Moves `x` along directions in which it does not, so that
  /// places with the same h around them become one.
  bool varies_around(Vec<Dim>& x, double reach) const;
  /// The border of a zone that is nearest to a place.
  struct NearestBorder {
    int zone;         ///< -1: there is none
    double distance;  ///< m; 0 inside the border, where h varies
  };
  NearestBorder nearest_border(const Vec<Dim>& x) const { return nearest_border_drawn(drawn(x)); }
  /// Depth [m] of a place, as drawn, in a zone, behind its nearest face; negative outside.
  double depth_in(const Zone& zone, const Vec<Dim>& x) const;

 private:
  /// Where the zones are, from where they are drawn.
  struct Motion {
    Mat<Dim> turn = Mat<Dim>::Identity();
    Vec<Dim> shift = Vec<Dim>::Zero();  ///< m
  };

  NearestBorder nearest_border_drawn(const Vec<Dim>& x) const;
  Vec<Dim> slope_drawn(const Vec<Dim>& x) const;
  Vec<Dim> wrapped(Vec<Dim> x) const;
  /// h with one zone alone, at a place within the period.
  static double in_zone(const Zone& zone, const Vec<Dim>& inside);

  std::vector<Zone> zones_;
  int carrier_ = -1;
  std::vector<TimeFunction> displacement_;  ///< m; a component per axis; empty without a displacement of their own
  std::shared_ptr<Motion> motion_;          ///< of this field and its copies; null if the zones rest
  bool has_depths_ = false;                 ///< whether a zone is not a box
  bool are_prisms_ = false;                 ///< 3D; whether all zones have the same depth above each other
  Box<Dim> periodic_;                       ///< m; along directions that are not periodic it has no extent
};

/// The most particles, during the run, in the part of a zone that is in `box` and not behind walls, without other
/// zones, when it is full of water. A zone that walls carry is taken where it is drawn.
template <int Dim>
double particles_of_full_zone(const SpacingField<Dim>& field, std::size_t number, const CaseSpec& spec,
                              const Box<Dim>& box, const Boundary<Dim>& boundary);

/// A particle is split in two where its volume exceeds that of the field, (h dx)^Dim, by this factor.
inline constexpr double volume_to_split = 1.34;

/// Calls put(centre, edges) for the parts of a cell: halves, along the longest edge [m], of halves, until none of them
/// is to be split.
template <int Dim, class Put>
void divide_cell(const SpacingField<Dim>& field, double spacing, const Vec<Dim>& centre, const Vec<Dim>& edges,
                 const Put& put) {
  if (edges.prod() <= volume_to_split * power<Dim>(spacing * field.at(centre))) {
    put(centre, edges);
    return;
  }
  int longest = 0;
  edges.maxCoeff(&longest);
  Vec<Dim> half = edges;
  half[longest] *= 0.5;
  const Vec<Dim> step = 0.5 * half[longest] * Vec<Dim>::Unit(longest);
  divide_cell<Dim>(field, spacing, centre - step, half, put);
  divide_cell<Dim>(field, spacing, centre + step, half, put);
}

}  // namespace tailwater
