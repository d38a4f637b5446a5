#include "checks/preview.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "checks/svg.h"
#include "checks/zone_outline.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "geometry/opening.h"

namespace tailwater {
namespace {

constexpr std::size_t max_drawn = 40000;
constexpr std::size_t max_drawn_faces = 20000;
constexpr double plot_width = 900.0;  // px; a tall case is limited by plot_height instead
constexpr double plot_height = 620.0;
constexpr double page_margin = 24.0;
constexpr double axis_margin = 64.0;  // for the labels of the vertical axis
constexpr double title_height = 64.0;
constexpr double line_height = 18.0;
constexpr double letter_width = 0.62;  // of the font size: wider than a sans-serif's mean letter

constexpr const char* fluid_colour = "#3b7dd8";
constexpr const char* wall_colour = "#222222";
constexpr const char* dummy_colour = "#b9b2a7";
constexpr const char* probe_colour = "#c0392b";
constexpr const char* opening_colour = "#1e8449";
constexpr const char* refinement_colour = "#8e44ad";
constexpr const char* region_colour = "#7d6608";

double text_width(std::string_view text) { return letter_width * font_size * static_cast<double>(text.size()); }

struct Extent {
  Vec<2> low = Vec<2>::Constant(std::numeric_limits<double>::max());
  Vec<2> high = Vec<2>::Constant(std::numeric_limits<double>::lowest());
  void include(const Vec<2>& x) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
};

/// The smallest step of at least `least` metres that is 1, 2 or 5 times a power of ten.
double tick_step(double least) {
  const double decade = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= least) {
      return factor * decade;
    }
  }
  return 10.0 * decade;
}

struct Marker {
  std::string name;
  std::vector<Vec<2>> points;  ///< m; one point, or the two ends of a stretch
  bool is_vertical = false;    ///< whether it is a depth probe, which measures its whole column
  const char* colour = probe_colour;
};

std::vector<Marker> markers_of(const CaseSpec& spec) {
  std::vector<Marker> markers;
  for (const ProbeTable& probe : spec.probes) {
    Marker marker{probe.name, {}, probe.type == ProbeType::depth};
    for (const Coordinates& x : {probe.at, probe.from, probe.to}) {
      // A depth probe may leave its height out.
      if (x.size() >= 2) {
        marker.points.push_back(project(x));
      } else if (x.size() == 1 && marker.is_vertical) {
        marker.points.push_back({x[0], 0.0});
      }
    }
    if (!marker.points.empty()) {
      markers.push_back(marker);
    }
  }
  for (const VentTable& vent : spec.vents) markers.push_back({vent.name, {project(vent.at)}, false, opening_colour});
  for (const PocketTable& pocket : spec.pockets) {
    markers.push_back({pocket.name, {project(pocket.at)}, false, opening_colour});
  }
  for (const MooringTable& line : spec.moorings) {
    markers.push_back({line.name, {project(line.at), project(line.anchor)}, false, wall_colour});
  }
  return markers;
}

void draw_axes(Svg& svg, const View& view) {
  const double min_apart[] = {80.0, 26.0};  // px, along x and along the vertical axis
  for (int axis = 0; axis < 2; ++axis) {
    const double step = tick_step(min_apart[axis] / view.scale);
    for (double k = std::ceil(view.low[axis] / step - 1e-9); k * step <= view.high[axis] + 1e-9 * step; ++k) {
      // + 0.0 turns -0 into 0.
      const std::string label = fmt::format("{:.6g}", k * step + 0.0);
      if (axis == 0) {
        const double x = view.left + view.scale * (k * step - view.low[0]);
        svg.line({x, view.bottom()}, {x, view.bottom() + 6.0}, wall_colour, 1.0);
        svg.text(x, view.bottom() + 20.0, "middle", label);
      } else {
        const double y = view.top + view.scale * (view.high[1] - k * step);
        svg.line({view.left - 6.0, y}, {view.left, y}, wall_colour, 1.0);
        svg.text(view.left - 10.0, y + 0.35 * font_size, "end", label);
      }
    }
  }
  svg.add(R"(<rect x="{:.2f}" y="{:.2f}" width="{:.2f}" height="{:.2f}" fill="none" stroke="{}" stroke-width="0.6"/>)",
          view.left, view.top, view.right() - view.left, view.bottom() - view.top, wall_colour);
}

/// Rows of probe names above the plot. From right to left each name takes the lowest row with space, starting at its
/// marker. The line down to the marker then passes only names that begin further right.
std::vector<int> label_rows(const std::vector<double>& x, const std::vector<std::string>& names) {
  std::vector<std::size_t> order(x.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] > x[b]; });
  std::vector<int> rows(x.size());
  std::vector<double> room_until;  // left end of the leftmost name of each row
  for (const std::size_t i : order) {
    std::size_t row = 0;
    while (row < room_until.size() && x[i] + text_width(names[i]) + 8.0 > room_until[row]) ++row;
    room_until.resize(std::max(room_until.size(), row + 1));
    room_until[row] = x[i];
    rows[i] = static_cast<int>(row);
  }
  return rows;
}

/// Draws the ducts that the program adds beyond openings, in which the conditions of an opening hold.
template <int Dim>
void draw_ducts(Svg& svg, std::span<const Duct<Dim>> ducts, const View& view) {
  for (const Duct<Dim>& duct : ducts) {
    const std::vector<Vec<Dim>> rim = duct.mouth.rim();
    const std::vector<Vec<Dim>> outer = duct.mouth.moved_out(duct.length).rim();
    for (std::size_t c = 0; c < rim.size(); ++c) {
      svg.line(view(project(rim[c])), view(project(outer[c])), opening_colour, 1.0);
      svg.line(view(project(outer[c])), view(project(outer[(c + 1) % outer.size()])), opening_colour, 1.0);
    }
  }
}

/// Draws inlets and outlets, each with its name and an arrow in the direction of the flow.
template <int Dim>
void draw_open_ends(Svg& svg, const std::vector<Opening<Dim>>& ends, const View& view) {
  constexpr double arrow = 20.0;  // px
  for (const Opening<Dim>& end : ends) {
    Vec<Dim> far_corner = end.corner;
    for (const Vec<Dim>& edge : end.edges) far_corner += edge;
    const std::vector<Vec<Dim>> rim = end.rim();
    for (std::size_t c = 0; c < rim.size(); ++c) {
      svg.line(view(project(rim[c])), view(project(rim[(c + 1) % rim.size()])), opening_colour, 3.0);
    }
    const Vec<2> middle = view(project(Vec<Dim>(0.5 * (end.corner + far_corner))));
    const Vec<2> out(project(end.direction())[0], -project(end.direction())[1]);
    const Vec<2> aside(-out[1], out[0]);
    const Vec<2> tip = middle + arrow * out;
    svg.line(middle, tip, opening_colour, 2.0);
    svg.line(tip, tip - 0.4 * arrow * (out + 0.6 * aside), opening_colour, 2.0);
    svg.line(tip, tip - 0.4 * arrow * (out - 0.6 * aside), opening_colour, 2.0);
    const bool is_on_the_right = middle[0] > 0.5 * (view.left + view.right());
    svg.text(middle[0] + (is_on_the_right ? -6.0 : 6.0), middle[1] - 6.0, is_on_the_right ? "end" : "start", end.name);
  }
}

/// Whether a wall particle belongs to a wall of the case, not to a duct, which is added later, nor to the part beyond a
/// free end.
template <int Dim>
bool is_drawn(const Boundary<Dim>& boundary, const WallParticles<Dim>& walls, std::size_t i) {
  return walls.wall[i] < static_cast<int>(boundary.walls.size()) && walls.is_beyond_end[i] == 0;
}

/// The extent of everything that the picture must show.
template <int Dim>
Extent extent_of(const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid, const WallParticles<Dim>& walls,
                 const std::vector<Opening<Dim>>& ends, std::span<const Duct<Dim>> ducts,
                 const std::vector<Marker>& markers, std::span<const Vec<Dim>> bad_places) {
  Extent extent;
  const auto include_faces = [&](const std::vector<WallFace<Dim>>& faces) {
    for (const WallFace<Dim>& face : faces) {
      for (const Vec<Dim>& corner : face.corners) extent.include(project(corner));
    }
  };
  for (const Vec<Dim>& x : fluid.position) extent.include(project(x));
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (is_drawn(boundary, walls, i)) extent.include(project(walls.position[i]));
  }
  include_faces(boundary.faces);
  for (const Opening<Dim>& end : ends) include_faces(end.as_faces());
  for (const Duct<Dim>& duct : ducts) include_faces(duct.mouth.moved_out(duct.length).as_faces());
  for (const Marker& marker : markers) {
    for (const Vec<2>& x : marker.points) {
      if (!marker.is_vertical) extent.include(x);
    }
  }
  for (const Vec<Dim>& x : bad_places) extent.include(project(x));
  if (extent.low[0] > extent.high[0]) extent.include(Vec<2>::Zero());
  return extent;
}

/// The scale at which the plot fits, and its left edge. Its top is not set, because it depends on the labels above the
/// plot.
View fitted_view(const Extent& extent, double dx) {
  View view;
  view.low = extent.low - Vec<2>::Constant(1.5 * dx);
  view.high = extent.high + Vec<2>::Constant(1.5 * dx);
  const Vec<2> size = view.high - view.low;
  view.scale = std::min(plot_width / size[0], plot_height / size[1]);
  view.left = page_margin + axis_margin;
  view.top = 0.0;
  return view;
}

template <int Dim>
void draw_wall_particles(Svg& svg, const Boundary<Dim>& boundary, const WallParticles<Dim>& walls, const View& view,
                         double diameter) {
  // Seen along y, the walls before and behind the scene would hide it.
  std::vector<Vec<Dim>> shown;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const bool is_seen = Dim == 2 || walls.blocked[i](1, 1) < 0.5;
    if (is_seen && is_drawn(boundary, walls, i)) shown.push_back(walls.position[i]);
  }
  if (shown.size() <= max_drawn) svg.dots(shown, view, dummy_colour, diameter);
}

template <int Dim>
void draw_fluid(Svg& svg, const CaseSpec& spec, const FluidParticles<Dim>& fluid, const View& view, double diameter) {
  if (fluid.position.size() <= max_drawn) {
    std::map<int, std::vector<Vec<Dim>>> of_size;  // in half halvings of the spacing
    for (std::size_t i = 0; i < fluid.position.size(); ++i) {
      const double relative = spec.refinement.empty() ? 1.0 : edge_of<Dim>(fluid.volume[i]) / spec.particles.spacing;
      of_size[static_cast<int>(std::lround(2.0 * std::log2(relative)))].push_back(fluid.position[i]);
    }
    for (const auto& [size, places] : of_size) svg.dots(places, view, fluid_colour, std::exp2(0.5 * size) * diameter);
    return;
  }
  for (std::size_t b = 0; b < spec.fluid.size(); ++b) {
    const FluidTable& block = spec.fluid[b];
    std::vector<Vec<2>> corners;
    if (block.shape == BlockShape::polygon) {
      for (const Coordinates& x : block.points) corners.push_back(view(project(x)));
    } else {
      Extent extent;
      for (std::size_t i = 0; i < fluid.position.size(); ++i) {
        if (fluid.block[i] == static_cast<int>(b)) extent.include(project(fluid.position[i]));
      }
      const Vec<2> low = view(extent.low);
      const Vec<2> high = view(extent.high);
      corners = {low, {high[0], low[1]}, high, {low[0], high[1]}};
    }
    svg.outline(corners, fluid_colour, fluid_colour);
  }
}

template <int Dim>
void draw_walls(Svg& svg, const Boundary<Dim>& boundary, const View& view) {
  if (boundary.faces.size() > max_drawn_faces) return;
  for (const WallFace<Dim>& face : boundary.faces) {
    for (int c = 0; c < (Dim == 2 ? 1 : 3); ++c) {
      const Vec<Dim> edge = face.corners[(c + 1) % Dim] - face.corners[c];
      const bool is_diagonal_of_rectangle = Dim == 3 && edge.cwiseAbs().maxCoeff() < (1.0 - 1e-9) * edge.norm();
      if (is_diagonal_of_rectangle) continue;
      svg.line(view(project(face.corners[c])), view(project(face.corners[(c + 1) % Dim])), wall_colour, 1.5);
    }
  }
}

/// Zones of refinement, as far as they are in the picture, with their names.
template <int Dim>
void draw_refinement(Svg& svg, const CaseSpec& spec, const Boundary<Dim>& boundary, const View& view) {
  const SpacingField<Dim> field(spec, boundary);
  for (std::size_t n = 0; n < spec.refinement.size(); ++n) {
    const auto& zone = field.zones()[n];
    std::vector<std::array<Vec<2>, 2>> lines;
    if (zone.depth == nullptr) {
      const Vec<2> low = project(zone.box.min()).cwiseMax(view.low).cwiseMin(view.high);
      const Vec<2> high = project(zone.box.max()).cwiseMax(view.low).cwiseMin(view.high);
      const std::array<Vec<2>, 4> corners{low, Vec<2>(high[0], low[1]), high, Vec<2>(low[0], high[1])};
      for (int c = 0; c < 4; ++c) lines.push_back({corners[c], corners[(c + 1) % 4]});
    } else {
      lines = outline_of_zone<Dim>(field, zone, box_around(boundary.faces), view);
    }
    if (lines.empty()) continue;
    Vec<2> name(view.high[0], view.low[1]);  // the upper left corner
    for (const auto& [from, to] : lines) {
      svg.line(view(from), view(to), refinement_colour, 2.0);
      name = {std::min({name[0], from[0], to[0]}), std::max({name[1], from[1], to[1]})};
    }
    svg.text(view(name)[0] + 6.0, view(name)[1] + 16.0, "start", spec.refinement[n].name);
  }
}

/// Porous layers (without meshes) and damping zones, as far as they are in the picture, with their names.
void draw_regions(Svg& svg, const CaseSpec& spec, const View& view) {
  const auto draw = [&](const std::string& name, const std::vector<Vec<2>>& corners) {
    std::vector<Vec<2>> inside;
    for (const Vec<2>& x : corners) inside.push_back(view(x.cwiseMax(view.low).cwiseMin(view.high)));
    svg.outline(inside, region_colour, region_colour);
    Extent extent;
    for (const Vec<2>& x : inside) extent.include(x);
    svg.text(0.5 * (extent.low[0] + extent.high[0]), extent.low[1] + font_size, "middle", name);
  };
  const auto corners_of = [](const Coordinates& min, const Coordinates& max) -> std::vector<Vec<2>> {
    const Vec<2> low = project(min), high = project(max);
    return {low, {high[0], low[1]}, high, {low[0], high[1]}};
  };
  for (const PorousTable& layer : spec.porous) {
    std::vector<Vec<2>> corners;
    for (const Coordinates& x : layer.points) corners.push_back(project(x));
    if (layer.shape == RegionShape::box) corners = corners_of(layer.min, layer.max);
    if (!corners.empty()) draw(layer.name, corners);
  }
  for (const DampingTable& zone : spec.damping) draw(zone.name, corners_of(zone.min, zone.max));
}

/// A marker with its name in the given row above the plot, and a line down to it.
void draw_marker(Svg& svg, const Marker& marker, int row, const View& view) {
  const double baseline = view.top - 10.0 - row * line_height;
  std::vector<Vec<2>> points;
  for (const Vec<2>& x : marker.points) points.push_back(view(marker.is_vertical ? Vec<2>(x[0], view.high[1]) : x));
  const double end = marker.is_vertical ? view.bottom() : points[0][1];
  svg.add(R"(<line x1="{0:.2f}" y1="{1:.2f}" x2="{0:.2f}" y2="{2:.2f}" stroke="{3}" stroke-width="0.6" )"
          R"(stroke-dasharray="4 3"/>)",
          points[0][0], baseline - 8.0, end, marker.colour);
  if (points.size() == 2) svg.line(points[0], points[1], marker.colour, 3.0);
  if (!marker.is_vertical) {
    svg.add(R"(<circle cx="{:.2f}" cy="{:.2f}" r="3.5" fill="{}"/>)", points[0][0], points[0][1], marker.colour);
  }
  svg.text(points[0][0] + 4.0, baseline, "start", marker.name);
}

}  // namespace

template <int Dim>
std::string preview_svg(const CaseSpec& spec, const Boundary<Dim>& boundary, const FluidParticles<Dim>& fluid,
                        const WallParticles<Dim>& walls, std::span<const Duct<Dim>> ducts,
                        std::span<const Vec<Dim>> bad_places) {
  const double dx = spec.particles.spacing;
  const std::vector<Marker> markers = markers_of(spec);
  const std::vector<Opening<Dim>> ends = make_open_ends<Dim>(spec);
  View view = fitted_view(extent_of(boundary, fluid, walls, ends, ducts, markers, bad_places), dx);

  std::vector<double> label_x;
  std::vector<std::string> names;
  for (const Marker& marker : markers) {
    label_x.push_back(view(marker.points[0])[0]);
    names.push_back(marker.name);
  }
  const std::vector<int> rows = label_rows(label_x, names);
  const int row_count = rows.empty() ? 0 : 1 + *std::max_element(rows.begin(), rows.end());
  view.top = title_height + row_count * line_height + 8.0;

  const std::string summary = fmt::format("spacing {:.6g} m, {} fluid and {} wall particles", dx, fluid.position.size(),
                                          std::ranges::count(walls.is_beyond_end, 0));
  double width =
      std::max({view.right(), view.left + text_width(summary), view.left + 1.4 * text_width(spec.general.title)});
  for (std::size_t i = 0; i < names.size(); ++i) width = std::max(width, label_x[i] + 6.0 + text_width(names[i]));
  width += page_margin;
  const double height = view.bottom() + 56.0;

  Svg svg;
  svg.add(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}" )"
          R"(font-family="DejaVu Sans, Arial, sans-serif" aria-label="tailwater preview">)",
          width, height);
  svg.add(R"(<rect width="100%" height="100%" fill="white"/>)");
  svg.text(view.left, 28.0, "start", spec.general.title, 1.35 * font_size);
  svg.text(view.left, 50.0, "start", summary);

  const double diameter = 0.85 * dx * view.scale;
  draw_wall_particles(svg, boundary, walls, view, diameter);
  draw_fluid(svg, spec, fluid, view, diameter);
  draw_walls(svg, boundary, view);
  draw_refinement(svg, spec, boundary, view);
  draw_regions(svg, spec, view);
  draw_ducts(svg, ducts, view);
  draw_open_ends(svg, ends, view);
  draw_axes(svg, view);
  svg.text(0.5 * (view.left + view.right()), view.bottom() + 42.0, "middle", "x (m)");
  svg.text(page_margin, view.top - 8.0, "start", Dim == 2 ? "y (m)" : "z (m)");
  for (std::size_t i = 0; i < markers.size(); ++i) draw_marker(svg, markers[i], rows[i], view);
  for (const Vec<Dim>& x : bad_places) {
    const Vec<2> p = view(project(x));
    svg.add(R"(<circle cx="{:.2f}" cy="{:.2f}" r="10" fill="none" stroke="{}" stroke-width="2.5"/>)", p[0], p[1],
            probe_colour);
  }
  svg.add("</svg>");
  return svg.str();
}

TAILWATER_IN_2D_AND_3D(preview_svg);

}  // namespace tailwater
