// Wall particles. In 2D the faces form chains; a chain is cut at its sharp corners into runs, and each row of particles
// follows the runs at its own distance behind the wall, its corners where the shifted faces meet (mitres). In 3D, where
// walls are boxes, wall particles are the nodes of the box's own lattice outside (or inside) it.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "base/assert.h"
#include "geometry/point_grid.h"
#include "geometry/sampling.h"

namespace tailwater {
namespace {

constexpr double least_distance = 0.5;       // dx, between wall particles
constexpr double farthest_share = 1.5;       // of the layers' depth: what is left of a sharp mitre
constexpr double least_way_to_tip = 0.3;     // dx, of the particles in the tip of a crest
constexpr double sharp_turn_cosine = 0.866;  // a corner that turns by more than 30 degrees gets a particle of its own
constexpr double folded_back_cosine = -0.9;  // faces that turn by more than 154 degrees have no useful mitre

/// Eigenvalues of the sum of n n^T clipped at 1: what walls with these normals block together.
template <int Dim>
Mat<Dim> blocked_by(const std::vector<Vec<Dim>>& normals) {
  Mat<Dim> sum = Mat<Dim>::Zero();
  for (const Vec<Dim>& n : normals) {
    sum += n * n.transpose();
  }
  if (normals.size() == 1) {
    return sum;
  }
  const Eigen::SelfAdjointEigenSolver<Mat<Dim>> eigen(sum);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMin(1.0).asDiagonal() * eigen.eigenvectors().transpose();
}

template <int Dim>
void append(WallParticles<Dim>& particles, const Vec<Dim>& x, const std::vector<Vec<Dim>>& normals, int wall) {
  Vec<Dim> mean = Vec<Dim>::Zero();
  for (const Vec<Dim>& n : normals) {
    mean += n;
  }
  particles.position.push_back(x);
  particles.normal.push_back(mean.normalized());
  particles.blocked.push_back(blocked_by<Dim>(normals));
  particles.wall.push_back(wall);
}

/// The faces of a 2D boundary joined at shared corners: -1 where a face's end is free.
struct Joints {
  std::vector<int> next, previous;
  std::vector<int> chain;  ///< number of the connected chain each face belongs to
};

/// Joins each face to the one that bounds the same sector of fluid at its corner 1. Where several meet there, that is
/// the one across the smallest angle of fluid.
Joints join_faces(const Boundary<2>& boundary, double tolerance) {
  const std::vector<WallFace<2>>& faces = boundary.faces;
  const int count = static_cast<int>(faces.size());
  struct Candidate {
    double fluid_angle;
    int from, to;
  };
  std::vector<Candidate> candidates;
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const double turn_cosine = faces[i].normal.dot(faces[j].normal);
      if (i != j && turn_cosine > folded_back_cosine &&
          (faces[i].corners[1] - faces[j].corners[0]).norm() <= tolerance) {
        const Vec<2>& n = faces[i].normal;
        const Vec<2>& m = faces[j].normal;
        const double left_turn = std::atan2(n[0] * m[1] - n[1] * m[0], turn_cosine);
        candidates.push_back({std::numbers::pi - left_turn, i, j});
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.fluid_angle < b.fluid_angle; });
  Joints joints{std::vector<int>(count, -1), std::vector<int>(count, -1), std::vector<int>(count, -1)};
  for (const Candidate& c : candidates) {
    if (joints.next[c.from] < 0 && joints.previous[c.to] < 0) {
      joints.next[c.from] = c.to;
      joints.previous[c.to] = c.from;
    }
  }
  int chains = 0;
  for (int f = 0; f < count; ++f) {
    if (joints.chain[f] < 0) {
      for (int g = f; g >= 0 && joints.chain[g] < 0; g = joints.next[g]) joints.chain[g] = chains;
      for (int g = joints.previous[f]; g >= 0 && joints.chain[g] < 0; g = joints.previous[g]) joints.chain[g] = chains;
      ++chains;
    }
  }
  return joints;
}

bool is_sharp(const Boundary<2>& boundary, int from, int to) {
  return boundary.faces[from].normal.dot(boundary.faces[to].normal) < sharp_turn_cosine;
}

/// A run: faces joined without a sharp corner. Its ends are sharp corners, free ends, or nothing (a smooth closed
/// curve).
struct Run {
  std::vector<int> faces;
  int before = -1;  ///< face across the sharp corner at its start; -1: a free end
  int after = -1;
  bool is_closed = false;
};

std::vector<Run> make_runs(const Boundary<2>& boundary, const Joints& joints) {
  const int count = static_cast<int>(boundary.faces.size());
  std::vector<bool> is_taken(count, false);
  std::vector<Run> runs;
  const auto follow = [&](int first) {
    Run run;
    run.before = joints.previous[first];
    for (int f = first;;) {
      run.faces.push_back(f);
      is_taken[f] = true;
      run.after = joints.next[f];
      if (run.after < 0 || is_taken[run.after] || is_sharp(boundary, f, run.after)) {
        break;
      }
      f = run.after;
    }
    return run;
  };
  for (int f = 0; f < count; ++f) {
    if (joints.previous[f] < 0 || is_sharp(boundary, joints.previous[f], f)) {
      runs.push_back(follow(f));
    }
  }
  for (int f = 0; f < count; ++f) {
    if (!is_taken[f]) {
      runs.push_back(follow(f));
      runs.back().is_closed = true;
    }
  }
  return runs;
}

/// Where two joined faces meet when both are moved back by `depth`.
Vec<2> mitre(const WallFace<2>& from, const WallFace<2>& to, double depth) {
  return from.corners[1] - depth / (1.0 + from.normal.dot(to.normal)) * (from.normal + to.normal);
}

/// The places of one row along a run, `depth` behind it, the last `free_end` steps from a free end. A sharp corner
/// belongs to the run that starts there.
std::vector<Vec<2>> place_row(const Boundary<2>& boundary, const Run& run, double depth, double spacing,
                              double free_end) {
  const auto face = [&](int f) -> const WallFace<2>& { return boundary.faces[f]; };
  const WallFace<2>& first = face(run.faces.front());
  const WallFace<2>& last = face(run.faces.back());
  std::vector<Vec<2>> corners;
  corners.push_back(run.before < 0 ? Vec<2>(first.corners[0] - depth * first.normal)
                                   : mitre(face(run.before), first, depth));
  for (std::size_t k = 1; k < run.faces.size(); ++k) {
    corners.push_back(mitre(face(run.faces[k - 1]), face(run.faces[k]), depth));
  }
  corners.push_back(run.after < 0 ? Vec<2>(last.corners[1] - depth * last.normal)
                                  : mitre(last, face(run.after), depth));
  std::vector<double> along{0.0};
  for (std::size_t k = 1; k < corners.size(); ++k) {
    along.push_back(along.back() + (corners[k] - corners[k - 1]).norm());
  }

  // In steps: distance of the first and last place from the run's ends.
  const double head = run.is_closed ? 0.5 : run.before < 0 ? free_end : 0.0;
  const double tail = run.is_closed ? 0.5 : run.after < 0 ? free_end : 0.0;
  const int steps =
      std::max(head + tail > 0.0 ? 0 : 1, static_cast<int>(std::lround(along.back() / spacing - head - tail)));
  const double step = along.back() / (steps + head + tail);
  const bool leaves_out_last = run.after >= 0 && !run.is_closed;

  std::vector<Vec<2>> places;
  std::size_t piece = 1;
  for (int k = 0; k < steps + (leaves_out_last ? 0 : 1); ++k) {
    const double s = (head + k) * step;
    while (piece + 1 < along.size() && along[piece] < s) {
      ++piece;
    }
    const double length = along[piece] - along[piece - 1];
    const double share = length > 0.0 ? std::min((s - along[piece - 1]) / length, 1.0) : 0.0;
    places.push_back(corners[piece - 1] + share * (corners[piece] - corners[piece - 1]));
  }
  return places;
}

/// Is some other wall between `x` and its own wall's point `foot`? Faces for which `is_own` holds are not.
template <int Dim, class IsOwn>
bool is_behind_another(const Boundary<Dim>& boundary, const Vec<Dim>& x, const Vec<Dim>& foot, double tolerance,
                       IsOwn&& is_own) {
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    if (!is_own(f) && crosses(boundary.faces[f], x, foot, tolerance)) {
      return true;
    }
  }
  return false;
}

/// The tip of a crest sharper than a right angle, before which the first row stops: particles every dx/2 from the row's
/// corner towards the tip. Without them a particle that comes to stand on the tip, a whole dx from the next one, finds
/// nothing there that holds it off.
void fill_tips(const Boundary<2>& boundary, const Joints& joints, double depth, double spacing, PointGrid<2>& taken,
               WallParticles<2>& particles) {
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    const WallFace<2>& from = boundary.faces[f];
    if (joints.next[f] < 0) {
      continue;
    }
    const WallFace<2>& to = boundary.faces[joints.next[f]];
    const bool is_convex = from.normal[0] * to.normal[1] - from.normal[1] * to.normal[0] < 0.0;
    const Vec<2> back = mitre(from, to, depth) - from.corners[1];
    if (!is_convex || from.normal.dot(to.normal) > -corner_tolerance) {
      continue;
    }
    for (double way = back.norm() - 0.5 * spacing; way >= least_way_to_tip * spacing; way -= 0.5 * spacing) {
      const Vec<2> x = from.corners[1] + way * back.normalized();
      if (!taken.has_near(x)) {
        taken.add(x);
        append(particles, x, std::vector<Vec<2>>{from.normal, to.normal}, from.wall);
      }
    }
  }
}

/// Rows of wall particles, the first `first_depth` (m) behind the walls, first come, first kept. Rows on the wall and
/// in line with it include free ends. Nothing stands more than `farthest` (m) from its wall.
WallParticles<2> sample_rows(const Boundary<2>& boundary, double spacing, double first_depth, int layers,
                             double farthest) {
  const double tolerance = corner_tolerance * spacing;
  const Joints joints = join_faces(boundary, tolerance);
  std::vector<std::vector<int>> chains;
  for (std::size_t f = 0; f < boundary.faces.size(); ++f) {
    chains.resize(std::max<std::size_t>(chains.size(), joints.chain[f] + 1));
    chains[joints.chain[f]].push_back(static_cast<int>(f));
  }
  const std::vector<Run> runs = make_runs(boundary, joints);

  WallParticles<2> particles;
  PointGrid<2> taken((least_distance - corner_tolerance) * spacing);
  if (first_depth > 0.0) {
    fill_tips(boundary, joints, first_depth, spacing, taken, particles);
  }
  const double free_end = first_depth > 0.0 ? 0.5 : 0.0;
  for (int layer = 0; layer < layers; ++layer) {
    const double depth = first_depth + layer * spacing;
    for (const Run& run : runs) {
      const int chain = joints.chain[run.faces.front()];
      for (const Vec<2>& x : place_row(boundary, run, depth, spacing, free_end)) {
        double nearest = std::numeric_limits<double>::max();
        Vec<2> foot = x;
        std::vector<Vec<2>> normals;
        int wall = -1;
        for (const int f : chains[chain]) {
          const Vec<2> point = closest_point(boundary.faces[f], x);
          const double distance = (x - point).norm();
          if (distance < nearest - tolerance) {
            nearest = distance;
            foot = point;
            normals.clear();
            wall = boundary.faces[f].wall;
          }
          if (distance <= nearest + tolerance) {
            normals.push_back(boundary.faces[f].normal);
          }
        }
        // Nearer to the chain than its row: the row has folded over itself inside a convex corner.
        const bool is_in_place = nearest >= depth - 2.0 * tolerance && nearest <= farthest;
        const auto is_own = [&](std::size_t f) { return joints.chain[f] == chain; };
        if (is_in_place && !taken.has_near(x) && !is_behind_another(boundary, x, foot, tolerance, is_own)) {
          taken.add(x);
          append(particles, x, normals, wall);
        }
      }
    }
    if (depth == 0.0) particles.on_wall = particles.size();
  }
  return particles;
}

/// A 3D box wall put together again from its triangles.
struct Box {
  Vec<3> low = Vec<3>::Constant(std::numeric_limits<double>::max());
  Vec<3> high = Vec<3>::Constant(std::numeric_limits<double>::lowest());
  bool closed[3][2] = {};  ///< by axis and side (0 low, 1 high)
  bool fluid_is_inside = true;
};

/// The walls that have faces.
std::set<int> walls_of(const Boundary<3>& boundary) {
  std::set<int> walls;
  for (const WallFace<3>& face : boundary.faces) walls.insert(face.wall);
  return walls;
}

Box box_of(const Boundary<3>& boundary, int wall) {
  Box box;
  for (const WallFace<3>& face : boundary.faces) {
    if (face.wall == wall) {
      for (const Vec<3>& corner : face.corners) {
        box.low = box.low.cwiseMin(corner);
        box.high = box.high.cwiseMax(corner);
      }
    }
  }
  for (const WallFace<3>& face : boundary.faces) {
    if (face.wall == wall) {
      int axis = 0;
      [[maybe_unused]] const double length = face.normal.cwiseAbs().maxCoeff(&axis);
      TAILWATER_ASSERT(length > 1.0 - 1e-9, "3D walls are boxes");
      const bool points_up = face.normal[axis] > 0.0;
      // A lone face has no opposite one to be told from: it is then the floor of what it faces.
      const bool is_flat = box.high[axis] <= box.low[axis];
      const bool is_low = is_flat ? points_up : face.corners[0][axis] < 0.5 * (box.low[axis] + box.high[axis]);
      box.closed[axis][is_low ? 0 : 1] = true;
      box.fluid_is_inside = points_up == is_low;
    }
  }
  return box;
}

/// A node of a box's lattice: cell `index` of `count` between low and high, negative or beyond count outside them.
double cell_centre(double low, double high, int index, int count, double spacing) {
  if (index < 0) {
    return low + (index + 0.5) * spacing;
  }
  if (index >= count) {
    return high + (index - count + 0.5) * spacing;
  }
  return low + (index + 0.5) * (high - low) / count;
}

Vec<3> inward_normal(int axis, int side) { return (side == 0 ? 1.0 : -1.0) * Vec<3>::Unit(axis); }

/// Calls visit(index) for all index triples in [low, high) per axis.
template <class Visit>
void for_each_node(const Eigen::Vector3i& low, const Eigen::Vector3i& high, Visit&& visit) {
  Eigen::Vector3i index;
  for (index[2] = low[2]; index[2] < high[2]; ++index[2])
    for (index[1] = low[1]; index[1] < high[1]; ++index[1])
      for (index[0] = low[0]; index[0] < high[0]; ++index[0]) visit(index);
}

/// Normals that act on the node `index`; empty when it is none of the wall's particles.
std::vector<Vec<3>> normals_at(const Box& box, const Eigen::Vector3i& index, const Eigen::Vector3i& count, int layers) {
  std::vector<Vec<3>> normals;
  if (box.fluid_is_inside) {
    for (int axis = 0; axis < 3; ++axis) {
      if (index[axis] < 0 || index[axis] >= count[axis]) {
        const int side = index[axis] < 0 ? 0 : 1;
        if (!box.closed[axis][side]) {
          return {};
        }
        normals.push_back(inward_normal(axis, side));
      }
    }
    return normals;
  }
  int nearest = layers;
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int layer = side == 0 ? index[axis] : count[axis] - 1 - index[axis];
      if (box.closed[axis][side] && layer <= nearest && layer < layers) {
        if (layer < nearest) {
          normals.clear();
          nearest = layer;
        }
        normals.push_back(-inward_normal(axis, side));
      }
    }
  }
  return normals;
}

Eigen::Vector3i cells_of(const Box& box, double spacing) {
  return ((box.high - box.low) / spacing).array().round().max(1.0).matrix().cast<int>();
}

WallParticles<3> sample_boxes(const Boundary<3>& boundary, double spacing, int layers) {
  const double tolerance = corner_tolerance * spacing;
  WallParticles<3> particles;
  PointGrid<3> taken((least_distance - corner_tolerance) * spacing);
  for (const int wall : walls_of(boundary)) {
    const Box box = box_of(boundary, wall);
    const Eigen::Vector3i count = cells_of(box, spacing);
    const auto is_own = [&](std::size_t f) { return boundary.faces[f].wall == wall; };
    const auto add = [&](const Eigen::Vector3i& index) {
      const std::vector<Vec<3>> normals = normals_at(box, index, count, layers);
      if (normals.empty()) {
        return;
      }
      Vec<3> x;
      for (int axis = 0; axis < 3; ++axis) {
        x[axis] = cell_centre(box.low[axis], box.high[axis], index[axis], count[axis], spacing);
      }
      Vec<3> foot = x.cwiseMax(box.low).cwiseMin(box.high);
      if (!box.fluid_is_inside) {
        int axis = 0;
        normals[0].cwiseAbs().maxCoeff(&axis);
        foot[axis] = normals[0][axis] > 0.0 ? box.high[axis] : box.low[axis];
      }
      if (!taken.has_near(x) && !is_behind_another(boundary, x, foot, tolerance, is_own)) {
        taken.add(x);
        append(particles, x, normals, wall);
      }
    };
    const Eigen::Vector3i margin = Eigen::Vector3i::Constant(box.fluid_is_inside ? layers : 0);
    for_each_node(-margin, count + margin, add);
  }
  return particles;
}

/// A node of the lattice that has the box's edges among its nodes, continued by dx beyond it.
double node(double low, double high, int index, int count, double spacing) {
  if (index < 0) {
    return low + index * spacing;
  }
  if (index > count) {
    return high + (index - count) * spacing;
  }
  return low + index * (high - low) / count;
}

/// How many steps the node `index` is behind the box's closed faces (0: on one), and the normals that act there; no
/// normals where no wall particle can stand.
struct NodePlace {
  int layer = 0;
  std::vector<Vec<3>> normals;
};

NodePlace place_of(const Box& box, const Eigen::Vector3i& index, const Eigen::Vector3i& count) {
  const int direction = box.fluid_is_inside ? -1 : 1;  // of growing depth, from the low face on
  NodePlace place;
  if (!box.fluid_is_inside) place.layer = std::numeric_limits<int>::max();
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const int depth = direction * (side == 0 ? index[axis] : count[axis] - index[axis]);
      if (!box.closed[axis][side]) {
        if (box.fluid_is_inside && depth > 0) return {};
        continue;
      }
      const bool is_deeper = box.fluid_is_inside ? depth > place.layer : depth < place.layer;
      if (is_deeper && !box.fluid_is_inside) place.normals.clear();
      if (is_deeper) place.layer = depth;
      if (box.fluid_is_inside ? depth >= 0 : depth == place.layer) {
        place.normals.push_back((box.fluid_is_inside ? 1.0 : -1.0) * inward_normal(axis, side));
      }
    }
  }
  return place;
}

/// Nodes on the faces of boxes, and `layers` - 1 layers of nodes behind them.
WallParticles<3> sample_box_nodes(const Boundary<3>& boundary, double spacing, int layers) {
  const double tolerance = corner_tolerance * spacing;
  WallParticles<3> particles;
  PointGrid<3> taken((least_distance - corner_tolerance) * spacing);
  for (int layer = 0; layer < layers; ++layer) {
    for (const int wall : walls_of(boundary)) {
      const Box box = box_of(boundary, wall);
      const Eigen::Vector3i count = cells_of(box, spacing);
      const auto is_own = [&](std::size_t f) { return boundary.faces[f].wall == wall; };
      const Eigen::Vector3i margin = Eigen::Vector3i::Constant(box.fluid_is_inside ? layer : 0);
      for_each_node(-margin, count + margin + Eigen::Vector3i::Ones(), [&](const Eigen::Vector3i& index) {
        const NodePlace place = place_of(box, index, count);
        if (place.layer != layer || place.normals.empty()) return;
        Vec<3> x;
        for (int axis = 0; axis < 3; ++axis) {
          x[axis] = node(box.low[axis], box.high[axis], index[axis], count[axis], spacing);
        }
        Vec<3> foot = x.cwiseMax(box.low).cwiseMin(box.high);
        if (!box.fluid_is_inside) {
          int axis = 0;
          place.normals[0].cwiseAbs().maxCoeff(&axis);
          foot[axis] = place.normals[0][axis] > 0.0 ? box.high[axis] : box.low[axis];
        }
        if (taken.has_near(x) || (layer > 0 && is_behind_another(boundary, x, foot, tolerance, is_own))) return;
        taken.add(x);
        append(particles, x, place.normals, wall);
      });
    }
    if (layer == 0) particles.on_wall = particles.size();
  }
  return particles;
}

/// Puts the entries `from` to `to` of `part` behind those of `all`.
template <int Dim>
void append_range(WallParticles<Dim>& all, const WallParticles<Dim>& part, std::size_t from, std::size_t to) {
  const auto put = [&](auto& into, const auto& entries) {
    into.insert(into.end(), entries.begin() + from, entries.begin() + to);
  };
  put(all.position, part.position);
  put(all.normal, part.normal);
  put(all.blocked, part.blocked);
  put(all.wall, part.wall);
}

/// The walls of one body after the other, each sampled as if it were alone: bodies part. All that stand on a wall come
/// first.
template <int Dim, class Sample>
WallParticles<Dim> sample_bodies(const Boundary<Dim>& boundary, Sample&& sample) {
  std::set<int> bodies;
  for (const WallProperties& wall : boundary.walls) bodies.insert(wall.body);
  std::vector<WallParticles<Dim>> parts;
  for (const int body : bodies) {
    Boundary<Dim> alone;
    alone.walls = boundary.walls;
    std::ranges::copy_if(boundary.faces, std::back_inserter(alone.faces),
                         [&](const WallFace<Dim>& face) { return boundary.walls[face.wall].body == body; });
    parts.push_back(sample(alone));
  }
  WallParticles<Dim> all;
  for (const WallParticles<Dim>& part : parts) append_range(all, part, 0, part.on_wall);
  all.on_wall = all.size();
  for (const WallParticles<Dim>& part : parts) append_range(all, part, part.on_wall, part.size());
  return all;
}

}  // namespace

template <int Dim>
WallParticles<Dim> make_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers) {
  return sample_bodies(boundary, [&](const Boundary<Dim>& body) {
    if constexpr (Dim == 2) {
      return sample_rows(body, spacing, 0.5 * spacing, layers, farthest_share * layers * spacing);
    } else {
      return sample_boxes(body, spacing, layers);
    }
  });
}

template <int Dim>
WallParticles<Dim> make_surface_particles(const Boundary<Dim>& boundary, double spacing) {
  return make_row_and_dummy_particles(boundary, spacing, 1);
}

template <int Dim>
WallParticles<Dim> make_row_and_dummy_particles(const Boundary<Dim>& boundary, double spacing, int layers) {
  return sample_bodies(boundary, [&](const Boundary<Dim>& body) {
    if constexpr (Dim == 2) {
      return sample_rows(body, spacing, 0.0, layers, farthest_share * layers * spacing);
    } else {
      return sample_box_nodes(body, spacing, layers);
    }
  });
}

template WallParticles<2> make_dummy_particles(const Boundary<2>&, double, int);
template WallParticles<3> make_dummy_particles(const Boundary<3>&, double, int);
template WallParticles<2> make_surface_particles(const Boundary<2>&, double);
template WallParticles<3> make_surface_particles(const Boundary<3>&, double);
template WallParticles<2> make_row_and_dummy_particles(const Boundary<2>&, double, int);
template WallParticles<3> make_row_and_dummy_particles(const Boundary<3>&, double, int);

}  // namespace tailwater
