// An open end as the cross-section of a channel, and the levels and discharges that the case prescribes there.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "case/time_function.h"
#include "geometry/boundary.h"
#include "geometry/opening.h"
#include "refinement/spacing_field.h"

namespace tailwater {

/// The prescribed flow at an open end. Without any of these the channel continues beyond it.
struct EndFlow {
  std::optional<TimeFunction> discharge;  ///< m^3/s, in 2D per metre of width; into the case
  std::optional<TimeFunction> velocity;   ///< m/s; mean over the section, into the case
  std::optional<TimeFunction> level;      ///< m; of the surface, along `up`
  double absorbing = 0.0;                 ///< 0: the level is held; 1: waves leave
  /// Fraction of the discharge below heights that divide the depth into equal parts, from the bed to the surface;
  /// empty: the velocity is uniform.
  std::vector<double> profile;

  bool feeds() const { return discharge || velocity; }
  /// The velocity of a row of particles over that of all rows: the mean of the profile over the row, so that rows which
  /// fill the depth bring the discharge for any profile. Height of the row and of its middle are fractions of the
  /// depth.
  double profile_of_row(double share, double row) const;
  /// The largest of them for rows that divide the depth into equal parts.
  double largest_in_profile(int rows) const;
};

/// A part of the section of an open end that is open between two heights.
struct SectionColumn {
  double aside;   ///< m; of its middle, along ChannelEnd::aside
  double width;   ///< m
  double bottom;  ///< m; along ChannelEnd::rise, from ChannelEnd::low
  double top;     ///< m
};

template <int Dim>
struct ChannelEnd {
  /// The columns are about as wide as the `spacing` [m]. `duct_length` [m] is that of the duct outside of the mouth; 0:
  /// there is none.
  ChannelEnd(const Opening<Dim>& place, EndFlow what_flows, const Vec<Dim>& full_gravity, double spacing,
             double duct_length);

  Opening<Dim> mouth;    ///< where the case ends
  double duct;           ///< m; length of the duct outside of it
  Opening<Dim> opening;  ///< at the end of the duct: water beyond it has left
  EndFlow flow;
  double gravity;                      ///< m/s^2; the part of gravity along the opening's plane
  Vec<Dim> up;                         ///< opposite to that part; 0 if there is none
  double floor;                        ///< m; height of the opening's lowest point along `up`
  double width;                        ///< m; of the opening across `up`; 1 in 2D
  Vec<Dim> low;                        ///< m; the corner from which heights and places across are measured
  Vec<Dim> rise;                       ///< unit vector of the edge from the floor upwards
  double height;                       ///< m; of the opening, along `rise`
  Vec<Dim> aside = Vec<Dim>::Zero();   ///< unit vector of the other edge (3D)
  std::vector<SectionColumn> columns;  ///< that make up the section, `aside` ascending; one in 2D
  int circuit = -1;      ///< where water circulates: the index of the outlet whose sump it draws from and fills
  double far_out = 0.0;  ///< m; into air: from the mouth, along its normal or aside, to where free jets are removed
  double reserve = 0.0;  ///< m^Dim; initial water of this end in the sump

  /// Whether beyond is air, into which water falls.
  bool air() const { return mouth.meets_air; }
  /// Whether water at `x` has left.
  bool is_passed_by(const Vec<Dim>& x) const;
  /// A place on the opening as the place on the mouth before it.
  Vec<Dim> on_mouth(const Vec<Dim>& x) const { return x - duct * mouth.normal; }
  /// Whether the case prescribes a condition, instead of a channel that continues.
  bool is_driven() const { return flow.feeds() || flow.level; }
  /// Whether a level is prescribed, and the velocity follows.
  bool holds_level() const { return flow.level && !flow.feeds(); }
  /// Area [m^(Dim-1)] of the section below a height [m] above the floor, and the breadth of the water's surface there.
  double area_below(double depth) const;
  double breadth_at(double depth) const;
  /// The height [m] above the floor below which the section has this area; at most that of the opening.
  double depth_of_area(double area) const;
  /// Discharge [m^3/s] that the case prescribes, where the water is `depth` (m) deep.
  double discharge(double time, double depth) const;
  /// Height above the floor at which a level [m] stands, at most that of the opening; the whole opening without gravity
  /// along it, where there is no level.
  double depth_at_level(double level) const;
  /// Discharge over the width [m^2/s].
  double discharge_per_width(double time, double depth) const { return discharge(time, depth) / width; }
  /// Depth [m] at which the prescribed flow is critical: no deeper flow is supercritical. 0 without gravity.
  double critical_depth(double time) const;
  /// The largest speed [m/s] with which particles of a spacing [m] enter where nothing resists.
  double largest_speed(double time, double spacing) const;
  /// The largest depth [m], up to a time, that follows from the prescribed flow alone.
  double largest_depth(double end_time) const;
};

/// The inlets of a case, then its outlets, at the ends of the `ducts` of its boundary, or of the longest that there can
/// be, with columns as wide as the spacing of the `field` there. Throws InputError as make_open_ends does.
template <int Dim>
std::vector<ChannelEnd<Dim>> make_channel_ends(const CaseSpec& spec, std::span<const Duct<Dim>> ducts = {},
                                               const SpacingField<Dim>& field = {});

}  // namespace tailwater
