#include "geometry/mesh_walls.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/box.h"
#include "case_files/mesh_file.h"
#include "geometry/from_spec.h"
#include "geometry/mesh_surface.h"
#include "geometry/rotation.h"

namespace tailwater {
namespace {

/// Binary STL holds coordinates with this relative precision, and other files are often exported with it.
constexpr double file_precision = std::numeric_limits<float>::epsilon();

/// Relative distance below which points count as one: round-off of a transformation by the exporter separates them.
constexpr double torn_points = 4.0 * file_precision;

constexpr double largest_round_off = 0.01;  // dx

/// Fraction of the area of an open mesh; if the net upward area is less, neither side is above the other.
constexpr double min_upward_share = 0.1;

Mat<3> rotation_of(const PlacedFile& file, const CaseLabel& owner) {
  Mat<3> turn = Mat<3>::Identity();
  if (file.rotate.empty()) return turn;
  const Vec<3> degrees = to_vec<3>(file.rotate, owner, "rotate");
  for (int axis = 0; axis < 3; ++axis) {
    const double quarters = degrees[axis] / 90.0;
    const double angle = degrees[axis] * std::numbers::pi / 180.0;
    Mat<3> one = rotation_about(Vec<3>::Unit(axis), angle);
    if (quarters == std::round(quarters))
      one = one.each([](double entry) { return std::round(entry); });  // exactly along the axes
    turn = one * turn;
  }
  return turn;
}

/// Transforms the mesh from the file's coordinates to those of the case.
void put_in_place(const PlacedFile& file, const CaseLabel& owner, TriangleMesh& mesh) {
  const Mat<3> turn = file.scale * rotation_of(file, owner);
  const Vec<3> shift = file.translate.empty() ? Vec<3>(Vec<3>::Zero()) : to_vec<3>(file.translate, owner, "translate");
  for (Vec<3>& x : mesh.points) x = turn * x + shift;
}

/// Throws CaseErrors about a mesh, with a common beginning of the message.
class Refusal {
 public:
  Refusal(const TriangleMesh& mesh, Clause start) : mesh_(mesh), start_(std::move(start)) {}

  [[noreturn]] void operator()(MessageId id, const Clause& problem, const Clause& remedy) const {
    throw CaseError(id, {"{}: {}", start_, problem}, remedy);
  }

  /// "triangle 7 at (0, 1, 2)": the number counts from 1, as in the file; the place is the triangle's middle in the
  /// case.
  Clause triangle(int t) const {
    const Vec<3> middle = (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3.0;
    return {"triangle {} at {}", t + 1, place(middle)};
  }
  Clause edge(const TriangleEdge& edge) const {
    return {"the edge from {} to {}", place(mesh_.points[edge.low]), place(mesh_.points[edge.high])};
  }

 private:
  const TriangleMesh& mesh_;
  Clause start_;
};

/// The mesh of a file in the file's coordinates.
TriangleMesh read_mesh_of(const PlacedFile& file, const CaseLabel& owner) {
  try {
    return TriangleMesh{read_mesh(file.file)};
  } catch (const InputError& error) {
    throw CaseError("mesh-file-not-readable", {"{}: {}", owner, error.what()}, {});
  }
}

void require_triangles_with_area(const TriangleMesh& mesh, double min_height, const Refusal& refuse) {
  int first = -1;
  std::size_t count = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    double longest = 0.0;
    for (int c = 0; c < 3; ++c) longest = std::max(longest, (mesh.corner(t, c) - mesh.corner(t, (c + 1) % 3)).norm());
    if (mesh.area_normal(t).norm() > min_height * longest) continue;
    if (count++ == 0) first = t;
  }
  if (count == 0) return;
  refuse("mesh-triangle-without-area",
         {"{} has no area{}: its corners are equal or on a line", refuse.triangle(first),
          count == 1 ? "" : fmt::format(", nor have {} others", count - 1)},
         {"remove degenerate triangles"});
}

void require_no_double_triangles(const TriangleMesh& mesh, const Refusal& refuse) {
  std::vector<std::array<int, 3>> corners = mesh.triangles;
  for (std::array<int, 3>& three : corners) std::ranges::sort(three);
  std::vector<int> order(corners.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, [&](int a, int b) { return std::pair(corners[a], a) < std::pair(corners[b], b); });
  const auto same = std::ranges::adjacent_find(order, [&](int a, int b) { return corners[a] == corners[b]; });
  if (same == order.end()) return;
  refuse("mesh-triangle-double", {"{} and triangle {} have the same corners", refuse.triangle(*same), same[1] + 1},
         {"remove double triangles"});
}

/// Returns the edges without a neighbour.
std::vector<TriangleEdge> require_neighbours_that_agree(const std::vector<TriangleEdge>& edges, const Refusal& refuse) {
  std::vector<TriangleEdge> rim;
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].is_between_same_points(edges[k])) ++end;
    const TriangleEdge& edge = edges[k];
    if (end - k > 2) {
      refuse("mesh-edge-of-many-triangles",
             {"{} belongs to {} triangles, {} among them: an edge can belong to two at most", refuse.edge(edge),
              end - k, refuse.triangle(edge.triangle)},
             {"separate bodies that touch there, or remove inner walls"});
    }
    if (end - k == 2 && edge.runs_up == edges[k + 1].runs_up) {
      refuse("mesh-normals-disagree",
             {"{} and triangle {}, which share {}, face opposite sides", refuse.triangle(edge.triangle),
              edges[k + 1].triangle + 1, refuse.edge(edge)},
             {"turn one of them over (orient the normals consistently)"});
    }
    if (end - k == 1) rim.push_back(edge);
    k = end;
  }
  return rim;
}

/// Index of the connected part for each triangle.
std::vector<int> parts_of(const TriangleMesh& mesh, const std::vector<TriangleEdge>& edges) {
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  for (std::size_t k = 1; k < edges.size(); ++k) {
    if (edges[k].is_between_same_points(edges[k - 1])) parent[root(edges[k].triangle)] = root(edges[k - 1].triangle);
  }
  std::vector<int> number(mesh.triangles.size(), -1);
  std::vector<int> part(mesh.triangles.size());
  int count = 0;
  for (int t = 0; t < static_cast<int>(part.size()); ++t) {
    int& known = number[root(t)];
    if (known < 0) known = count++;
    part[t] = known;
  }
  return part;
}

/// Turns a closed mesh so that its front faces outwards. A part that faces inwards must be a cavity.
void turn_outwards(TriangleMesh& mesh, const std::vector<TriangleEdge>& edges, const Refusal& refuse) {
  if (six_volumes(mesh, [](int) { return true; }) < 0.0) turn_over(mesh);
  const std::vector<int> part = parts_of(mesh, edges);
  const int count = 1 + *std::ranges::max_element(part);
  std::vector<double> volume(count, 0.0);
  std::vector<Box<3>> box(count);
  std::vector<int> first(count, -1);
  for (int t = 0; t < static_cast<int>(part.size()); ++t) {
    const int p = part[t];
    if (first[p] < 0) first[p] = t;
    const Vec<3>& origin = mesh.corner(first[p], 0);
    volume[p] += (mesh.corner(t, 0) - origin).dot(mesh.area_normal(t));
    for (int c = 0; c < 3; ++c) box[p].extend(mesh.corner(t, c));
  }
  for (int p = 0; p < count; ++p) {
    if (volume[p] > 0.0) continue;
    bool is_cavity = false;
    for (int q = 0; q < count; ++q) is_cavity = is_cavity || (volume[q] > 0.0 && box[q].contains(box[p]));
    if (is_cavity) continue;
    refuse("mesh-part-inside-out",
           {"the part that begins with {} is inside out, unlike the rest of the file", refuse.triangle(first[p])},
           {"reverse its triangles"});
  }
}

/// Turns an open mesh so that its front faces up.
void turn_up(TriangleMesh& mesh, const Vec<3>& up, const Refusal& refuse) {
  Vec<3> sum = Vec<3>::Zero();
  double area = 0.0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    sum += mesh.area_normal(t);
    area += mesh.area_normal(t).norm();
  }
  const double upward = up.dot(sum) / area;
  if (std::abs(upward) < min_upward_share) {
    refuse("mesh-without-upper-side",
           {"neither side of the mesh is above the other, because as much of it faces up as down"},
           {"give fluid_side = \"front\" or \"back\""});
  }
  if (upward < 0.0) turn_over(mesh);
}

/// A mesh in the coordinates of the case, welded, without degenerate and double triangles, with consistent orientation
/// of neighbours.
class SoundMesh {
 public:
  SoundMesh(const CaseSpec& spec, const PlacedFile& file, const CaseLabel& owner)
      : mesh{read_mesh_of(file, owner)}, refuse(mesh, {"{}: file {}", owner, file.file}) {
    double farthest = 0.0;
    for (const Vec<3>& x : mesh.points) farthest = std::max(farthest, x.cwiseAbs().maxCoeff());
    const double round_off = file_precision * farthest * file.scale;
    if (round_off > largest_round_off * spec.particles.spacing) {
      refuse(
          "mesh-far-from-origin",
          {"its coordinates reach {:.6g}, where the seven digits of most mesh files resolve {:.2g}, too coarse for a "
           "spacing of {:.6g} m",
           farthest, Amount{round_off, "m"}, spec.particles.spacing},
          {"move the mesh to the origin before it is exported, or correct scale = {:g}", file.scale});
    }
    put_in_place(file, owner, mesh);
    const double torn = torn_points * farthest * file.scale;
    weld(mesh, torn);
    require_triangles_with_area(mesh, torn, refuse);
    require_no_double_triangles(mesh, refuse);
    edges = edges_of(mesh);
    rim = require_neighbours_that_agree(edges, refuse);
  }
  SoundMesh(const SoundMesh&) = delete;
  SoundMesh& operator=(const SoundMesh&) = delete;

  /// "3 edges have no neighbour, the first is the edge from (0, 0, 0) to (1, 0, 0) of triangle 5 at (0.5, 0, 0)"
  Clause rim_text() const {
    return {"{} edges have no neighbour, the first is {} of {}", rim.size(), refuse.edge(rim[0]),
            refuse.triangle(rim[0].triangle)};
  }

  TriangleMesh mesh;
  Refusal refuse;
  std::vector<TriangleEdge> edges;
  std::vector<TriangleEdge> rim;  ///< edges without a neighbour
};

}  // namespace

TriangleMesh read_placed_mesh(const PlacedFile& file, const CaseLabel& owner) {
  TriangleMesh mesh = read_mesh_of(file, owner);
  put_in_place(file, owner, mesh);
  return mesh;
}

TriangleMesh make_wall_mesh(const CaseSpec& spec, const WallTable& table, const CaseLabel& owner) {
  SoundMesh sound(spec, table, owner);
  TriangleMesh& mesh = sound.mesh;
  if (table.shape == WallShape::plate) {
    if (sound.rim.empty()) {
      sound.refuse("plate-mesh-closed", {"is a closed mesh, and a plate is an open sheet with water on both sides"},
                   {"give shape = \"mesh\" with its fluid_side, or export only the sheet"});
    }
    return std::move(mesh);
  }
  const bool is_body = table.fluid_side == FluidSide::inside || table.fluid_side == FluidSide::outside;
  if (is_body && !sound.rim.empty()) {
    sound.refuse(
        "mesh-side-needs-closed",
        {"is not watertight, and fluid_side = \"{}\" needs a closed mesh: {}", name_of(table.fluid_side),
         sound.rim_text()},
        {"close the mesh, or give the side of an open one (\"above\", \"below\", \"front\" or \"back\"), or draw a "
         "sheet with water on both sides with shape = \"plate\""});
  }
  if (!is_body && sound.rim.empty()) {
    sound.refuse("mesh-side-of-closed",
                 {"is a closed mesh, so fluid_side = \"{}\" does not fit", name_of(table.fluid_side)},
                 {"give \"inside\" or \"outside\""});
  }
  const Vec<3> gravity = gravity_of<3>(spec);
  switch (table.fluid_side) {
    case FluidSide::inside:
    case FluidSide::outside:
      turn_outwards(mesh, sound.edges, sound.refuse);
      break;
    case FluidSide::above:
    case FluidSide::below:
      turn_up(mesh, gravity.isZero(0.0) ? Vec<3>(Vec<3>::UnitZ()) : Vec<3>(-gravity.normalized()), sound.refuse);
      break;
    default:
      break;
  }
  if (table.fluid_side == FluidSide::inside || table.fluid_side == FluidSide::below ||
      table.fluid_side == FluidSide::back) {
    turn_over(mesh);
  }
  return std::move(mesh);
}

TriangleMesh make_water_mesh(const CaseSpec& spec, const PlacedFile& file, const CaseLabel& owner,
                             const Box<3>& walls) {
  SoundMesh sound(spec, file, owner);
  if (!sound.rim.empty()) {
    sound.refuse("mesh-not-watertight", {"is not watertight, so that no inside holds the water: {}", sound.rim_text()},
                 {"close the mesh"});
  }
  turn_outwards(sound.mesh, sound.edges, sound.refuse);
  Box<3> box;
  for (const Vec<3>& x : sound.mesh.points) box.extend(x);
  if (walls.isEmpty()) return std::move(sound.mesh);
  const Vec<3> beyond = Vec<3>::Constant(walls.diagonal().norm());
  if (!Box<3>(Vec<3>(walls.min() - beyond), Vec<3>(walls.max() + beyond)).contains(box)) {
    sound.refuse("mesh-far-beyond-walls",
                 {"reaches from {} to {}, far beyond the walls, which stand between {} and {}", place<3>(box.min()),
                  place<3>(box.max()), place<3>(walls.min()), place<3>(walls.max())},
                 {"correct scale = {:g} (0.001 for a file in millimetres) or translate", file.scale});
  }
  return std::move(sound.mesh);
}

void append_mesh(const CaseSpec& spec, const WallTable& table, int wall, const CaseLabel& owner,
                 Boundary<3>& boundary) {
  WallMesh& added = boundary.meshes.emplace_back();
  added.first_face = static_cast<int>(boundary.faces.size());
  added.wall = wall;
  added.surface = std::make_shared<const MeshSurface>(make_wall_mesh(spec, table, owner));
  const TriangleMesh& mesh = added.surface->mesh();
  boundary.faces.reserve(boundary.faces.size() + mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) boundary.faces.push_back(face_of(mesh, t, wall));
}

void append_mesh_plate(const CaseSpec& spec, const WallTable& table, int wall, const CaseLabel& owner,
                       Boundary<3>& boundary) {
  WallPlate& added = boundary.plates.emplace_back();
  added.wall = wall;
  added.first_face = static_cast<int>(boundary.faces.size());
  added.sheet = std::make_shared<const MeshSurface>(make_wall_mesh(spec, table, owner));
  TriangleMesh side = added.sheet->mesh();
  added.pieces = static_cast<int>(side.triangles.size());
  for (int t = 0; t < added.pieces; ++t) boundary.faces.push_back(face_of(side, t, wall));
  turn_over(side);
  for (int t = 0; t < added.pieces; ++t) boundary.faces.push_back(face_of(side, t, wall));
}

}  // namespace tailwater
