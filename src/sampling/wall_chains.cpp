// Wall particles in 2D. The faces form chains. A chain is cut into runs at its sharp corners. Each row of particles
// follows the runs at its own distance behind the wall; its corners are the intersections of the shifted faces
// (mitres).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

constexpr double farthest_share = 1.5;       // of the layers' depth; sharp mitres are cut off at this distance
constexpr double min_distance_to_tip = 0.3;  // dx, for the particles in the tip of a crest
constexpr double sharp_turn_cosine = 0.866;  // a corner that turns by more than 30 degrees gets a particle of its own
constexpr double folded_back_cosine = -0.9;  // faces that turn by more than 154 degrees have no useful mitre

/// The joints between the faces of a 2D boundary at shared corners: -1 for a face with a free end.
struct Joints {
  std::vector<int> next, previous;
  std::vector<int> chain;  ///< index of the connected chain of each face
};

/// Joins each face to the one that bounds the same sector of fluid at its corner 1. If several faces meet there, it is
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

/// A run: faces joined without a sharp corner. It ends at sharp corners or free ends; a smooth closed curve has none.
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
      if (run.after < 0 || is_taken[run.after] || is_sharp(boundary, f, run.after)) break;
      f = run.after;
    }
    return run;
  };
  for (int f = 0; f < count; ++f) {
    if (joints.previous[f] < 0 || is_sharp(boundary, joints.previous[f], f)) runs.push_back(follow(f));
  }
  for (int f = 0; f < count; ++f) {
    if (!is_taken[f]) {
      runs.push_back(follow(f));
      runs.back().is_closed = true;
    }
  }
  return runs;
}

/// Intersection of two joined faces that are both moved back by `depth`.
Vec<2> mitre(const WallFace<2>& from, const WallFace<2>& to, double depth) {
  return from.corners[1] - depth / (1.0 + from.normal.dot(to.normal)) * (from.normal + to.normal);
}

/// One row of points along a run.
struct RowOfPlaces {
  std::vector<Vec<2>> places;
  double share;  ///< volume of their particles, over dx^2
};

/// The row at the distance `depth` behind a run; its last point is `free_end` steps from a free end. A sharp corner
/// belongs to the run that starts there.
RowOfPlaces place_row(const Boundary<2>& boundary, const Run& run, double depth, double spacing, double free_end) {
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
  for (std::size_t k = 1; k < corners.size(); ++k) along.push_back(along.back() + (corners[k] - corners[k - 1]).norm());

  // Distances of the first and last point from the run's ends, in steps.
  const double head = run.is_closed ? 0.5 : run.before < 0 ? free_end : 0.0;
  const double tail = run.is_closed ? 0.5 : run.after < 0 ? free_end : 0.0;
  const int steps =
      std::max(head + tail > 0.0 ? 0 : 1, static_cast<int>(std::lround(along.back() / spacing - head - tail)));
  const double step = along.back() / (steps + head + tail);
  const bool leaves_out_last = run.after >= 0 && !run.is_closed;

  // In shorter runs some points are too close together to be kept; the remaining ones keep the full volume.
  const bool is_regular = steps + head + tail >= 2.0;
  RowOfPlaces row{.places = {}, .share = is_regular ? share_of_step(step, spacing) : 1.0};
  std::size_t piece = 1;
  for (int k = 0; k < steps + (leaves_out_last ? 0 : 1); ++k) {
    const double s = (head + k) * step;
    while (piece + 1 < along.size() && along[piece] < s) ++piece;
    const double length = along[piece] - along[piece - 1];
    const double share = length > 0.0 ? std::min((s - along[piece - 1]) / length, 1.0) : 0.0;
    row.places.push_back(corners[piece - 1] + share * (corners[piece] - corners[piece - 1]));
  }
  return row;
}

/// Adds particles at every dx/2 from the first row's corner towards the tip of a crest sharper than a right angle,
/// because the row ends short of the tip. Without them nothing would hold off a fluid particle on the tip, a whole dx
/// away from the nearest wall particle.
void fill_tips(const Boundary<2>& body, const Joints& joints, const WallLayers& layers,
               WallParticleCollector<2>& collector) {
  for (std::size_t f = 0; f < body.faces.size(); ++f) {
    if (joints.next[f] < 0) continue;
    const WallFace<2>& from = body.faces[f];
    const WallFace<2>& to = body.faces[joints.next[f]];
    const bool is_convex = from.normal[0] * to.normal[1] - from.normal[1] * to.normal[0] < 0.0;
    if (!is_convex || from.normal.dot(to.normal) > -corner_tolerance) continue;
    const Vec<2> tip = from.corners[1];
    const Vec<2> back = mitre(from, to, layers.first_depth()) - tip;
    for (double distance = back.norm() - 0.5 * layers.spacing; distance >= min_distance_to_tip * layers.spacing;
         distance -= 0.5 * layers.spacing) {
      collector.add({tip + distance * back.normalized(), tip, {from.normal, to.normal}, from.wall});
    }
  }
}

/// The faces of each chain.
std::vector<std::vector<int>> faces_by_chain(const Joints& joints) {
  std::vector<std::vector<int>> chains;
  for (std::size_t f = 0; f < joints.chain.size(); ++f) {
    chains.resize(std::max<std::size_t>(chains.size(), joints.chain[f] + 1));
    chains[joints.chain[f]].push_back(static_cast<int>(f));
  }
  return chains;
}

/// The wall place at `x`: the nearest point of the chain, and the normals of all faces of the chain at that distance.
WallPlace<2> place_behind(const Boundary<2>& body, const std::vector<int>& chain, const Vec<2>& x, double tolerance) {
  WallPlace<2> place{x, x, {}, -1};
  double nearest = std::numeric_limits<double>::max();
  for (const int f : chain) {
    const Vec<2> point = closest_point(body.faces[f], x);
    const double distance = (x - point).norm();
    if (distance < nearest - tolerance) {
      nearest = distance;
      place.foot = point;
      place.normals.clear();
      place.wall = body.faces[f].wall;
    }
    if (distance <= nearest + tolerance) place.normals.push_back(body.faces[f].normal);
  }
  return place;
}

}  // namespace

WallParticles<2> sample_chains(const Boundary<2>& body, const WallLayers& layers) {
  const double tolerance = corner_tolerance * layers.spacing;
  const double farthest = farthest_share * layers.count * layers.spacing;
  const double free_end = layers.starts_on_wall ? 0.0 : 0.5;
  const Joints joints = join_faces(body, tolerance);
  const std::vector<std::vector<int>> chains = faces_by_chain(joints);
  const std::vector<Run> runs = make_runs(body, joints);
  WallParticleCollector<2> collector(body, layers);
  if (!layers.starts_on_wall) fill_tips(body, joints, layers, collector);
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (const Run& run : runs) {
      const int chain = joints.chain[run.faces.front()];
      const RowOfPlaces row = place_row(body, run, depth, layers.spacing, free_end);
      for (const Vec<2>& x : row.places) {
        WallPlace<2> place = place_behind(body, chains[chain], x, tolerance);
        place.share = row.share;
        // The row folds over itself inside a convex corner. Points there are nearer to the chain than the row is.
        const double distance = (x - place.foot).norm();
        if (distance < depth - 2.0 * tolerance || distance > farthest) continue;
        collector.add_unless_behind_another(place, [&](int f) { return joints.chain[f] == chain; });
      }
    }
    if (depth == 0.0) collector.end_of_places_on_wall();
  }
  return std::move(collector).particles();
}

std::vector<WallParticles<2>> sample_beyond_ends(const Boundary<2>& boundary, const WallLayers& layers) {
  std::vector<WallParticles<2>> parts;
  for (const WallEnd& end : boundary.ends) {
    const WallFace<2>& face = boundary.faces[end.face];
    const Vec<2>& tip = face.corners[end.corner];
    const Vec<2> out = (tip - face.corners[1 - end.corner]).normalized();
    WallParticleCollector<2> collector(boundary, layers.of_wall(boundary.walls[face.wall].moves()));
    for (int layer = 0; layer < layers.count; ++layer) {
      for (int k = 0; k < layers.count; ++k) {
        const Vec<2> foot = tip + (k + 0.5) * layers.spacing * out;
        collector.add({.position = foot - (layers.first_depth() + layer * layers.spacing) * face.normal,
                       .foot = foot,
                       .normals = {face.normal},
                       .wall = face.wall,
                       .is_beyond_end = true});
      }
    }
    parts.push_back(std::move(collector).particles());
  }
  return parts;
}

}  // namespace tailwater
