// Wall particles in 2D. The faces form chains. A chain is cut into runs at its sharp corners. Each row of particles
// follows the runs at its own distance behind the wall; its corners are the intersections of the shifted faces
// (mitres). A wall that goes on in the next period is joined to itself, and cut into runs there.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "sampling/wall_layers.h"

namespace tailwater {
namespace {

constexpr double farthest_share = 1.5;       // of the layers' depth; sharp mitres are cut off at this distance
constexpr double min_distance_to_tip = 0.3;  // dx, for the particles in the tip of a crest
constexpr double sharp_turn_cosine = 0.866;  // a corner that turns by more than 30 degrees gets a particle of its own
constexpr double min_sine_of_corner = 0.25;  // with less, two faces go on as one
constexpr double folded_back_cosine = -0.9;  // faces that turn by more than 154 degrees have no useful mitre

/// The joint of a face to the next one, or to an image of it.
struct Joint {
  int face = -1;                  ///< -1: the end is free
  Vec<2> moved = Vec<2>::Zero();  ///< m; of the next face to the period of this one

  bool exists() const { return face >= 0; }
  bool is_between_periods() const { return !moved.isZero(0.0); }
};

/// The joints between the faces of a 2D boundary at shared corners.
struct Joints {
  std::vector<Joint> next, previous;
  std::vector<int> chain;  ///< index of the connected chain of each face
};

constexpr double widest_corner_gap = 0.5;  // dx, of a corner that leaves no opening (geometry/rim_ends.h)
constexpr double longest_end = 1.0;  // dx, of a wall beyond a wall that it crosses, with too few particles behind it

/// The body, where walls that nearly meet, or go on a little beyond the place where they cross, meet in a corner that
/// water fills. Otherwise the walls would have rows of their own, and none in the corner behind them, where water would
/// escape.
Boundary<2> with_closed_corners(Boundary<2> body, double spacing, double tolerance) {
  std::vector<WallFace<2>>& faces = body.faces;
  const auto is_joined = [&](std::size_t f, int corner) {
    return std::ranges::any_of(faces, [&](const WallFace<2>& other) {
      return &other != &faces[f] && (other.corners[1 - corner] - faces[f].corners[corner]).norm() <= tolerance;
    });
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    for (std::size_t j = 0; j < faces.size(); ++j) {
      Vec<2>& end = faces[i].corners[1];
      Vec<2>& start = faces[j].corners[0];
      if (i == j || (end - start).norm() > longest_end * spacing || is_joined(i, 1) || is_joined(j, 0)) continue;
      const Vec<2> along = end - faces[i].corners[0];
      const double closing = along.dot(faces[j].normal);
      if (closing > -min_sine_of_corner * along.norm()) continue;
      const Vec<2> corner = end - faces[j].height(end) / closing * along;
      const bool is_crossed = (closest_point(faces[i], corner) - corner).norm() <= tolerance &&
                              (closest_point(faces[j], corner) - corner).norm() <= tolerance;
      if (is_crossed || (end - start).norm() <= widest_corner_gap * spacing) end = start = corner;
    }
  }
  return body;
}

/// Joins each face to the one that bounds the same sector of fluid at its corner 1. If several faces meet there, it is
/// the one across the smallest angle of fluid.
Joints join_faces(const Boundary<2>& boundary, double tolerance) {
  const std::vector<WallFace<2>>& faces = boundary.faces;
  const int count = static_cast<int>(faces.size());
  struct Candidate {
    double fluid_angle;
    int from, to;
    Vec<2> moved;
  };
  std::vector<Candidate> candidates;
  const auto consider = [&](int i, int j, const Vec<2>& moved) {
    const Vec<2>& n = faces[i].normal;
    const Vec<2>& m = faces[j].normal;
    const double turn_cosine = n.dot(m);
    const bool meet = (faces[i].corners[1] - faces[j].corners[0] - moved).norm() <= tolerance;
    if (!meet || turn_cosine <= folded_back_cosine) return;
    const double left_turn = std::atan2(n[0] * m[1] - n[1] * m[0], turn_cosine);
    candidates.push_back({std::numbers::pi - left_turn, i, j, moved});
  };
  for (int i = 0; i < count; ++i) {
    Box<2> around(faces[i].corners[1]);
    around.widen(tolerance);
    for (int j = 0; j < count; ++j) {
      if (i != j) consider(i, j, Vec<2>::Zero());
      visit_images<2>(boundary.domain, Box<2>(faces[j].corners[0]), around,
                      [&](const Vec<2>& moved) { consider(i, j, moved); });
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.fluid_angle < b.fluid_angle; });
  Joints joints{std::vector<Joint>(count), std::vector<Joint>(count), std::vector<int>(count, -1)};
  for (const Candidate& c : candidates) {
    if (!joints.next[c.from].exists() && !joints.previous[c.to].exists()) {
      joints.next[c.from] = {c.to, c.moved};
      joints.previous[c.to] = {c.from, -c.moved};
    }
  }
  int chains = 0;
  for (int f = 0; f < count; ++f) {
    if (joints.chain[f] < 0) {
      for (int g = f; g >= 0 && joints.chain[g] < 0; g = joints.next[g].face) joints.chain[g] = chains;
      for (int g = joints.previous[f].face; g >= 0 && joints.chain[g] < 0; g = joints.previous[g].face) {
        joints.chain[g] = chains;
      }
      ++chains;
    }
  }
  return joints;
}

bool is_sharp(const WallFace<2>& from, const WallFace<2>& to) { return from.normal.dot(to.normal) < sharp_turn_cosine; }

/// A run: faces joined without a sharp corner. It ends at sharp corners, between periods or at free ends; a smooth
/// closed curve has none.
struct Run {
  std::vector<int> faces;
  std::optional<WallFace<2>> before = {};  ///< the face joined to its start, where it is in this period; free without
  std::optional<WallFace<2>> after = {};   ///< likewise at its end
  bool is_closed = false;
};

std::vector<Run> make_runs(const Boundary<2>& boundary, const Joints& joints) {
  const std::vector<WallFace<2>>& faces = boundary.faces;
  const int count = static_cast<int>(faces.size());
  const auto beside = [&](const Joint& joint) {
    return joint.exists() ? std::optional(faces[joint.face].moved(joint.moved)) : std::nullopt;
  };
  // Whether a run ends where a face is joined to the next one.
  const auto divides = [&](int from, const Joint& joint) {
    return !joint.exists() || joint.is_between_periods() || is_sharp(faces[from], faces[joint.face]);
  };
  std::vector<bool> is_taken(count, false);
  std::vector<Run> runs;
  const auto follow = [&](int first) {
    Run run;
    run.before = beside(joints.previous[first]);
    for (int f = first;; f = joints.next[f].face) {
      run.faces.push_back(f);
      is_taken[f] = true;
      if (divides(f, joints.next[f]) || is_taken[joints.next[f].face]) break;
    }
    run.after = beside(joints.next[run.faces.back()]);
    return run;
  };
  for (int f = 0; f < count; ++f) {
    if (divides(f, joints.previous[f])) runs.push_back(follow(f));
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

/// The row at the distance `depth` behind a run; its last point is `free_end` steps from a free end, and from a plane
/// between two periods where the wall goes on without a sharp corner. Such a corner belongs to the run that starts
/// there.
RowOfPlaces place_row(const Boundary<2>& boundary, const Run& run, double depth, double spacing, double free_end) {
  const auto face = [&](int f) -> const WallFace<2>& { return boundary.faces[f]; };
  const WallFace<2>& first = face(run.faces.front());
  const WallFace<2>& last = face(run.faces.back());
  std::vector<Vec<2>> corners;
  corners.push_back(run.before ? mitre(*run.before, first, depth) : Vec<2>(first.corners[0] - depth * first.normal));
  for (std::size_t k = 1; k < run.faces.size(); ++k) {
    corners.push_back(mitre(face(run.faces[k - 1]), face(run.faces[k]), depth));
  }
  corners.push_back(run.after ? mitre(last, *run.after, depth) : Vec<2>(last.corners[1] - depth * last.normal));
  std::vector<double> along{0.0};
  for (std::size_t k = 1; k < corners.size(); ++k) along.push_back(along.back() + (corners[k] - corners[k - 1]).norm());

  // Distances of the first and last point from the run's ends, in steps.
  const double head = run.is_closed ? 0.5 : run.before && is_sharp(*run.before, first) ? 0.0 : free_end;
  const double tail = run.is_closed ? 0.5 : run.after && is_sharp(last, *run.after) ? 0.0 : free_end;
  const int steps =
      std::max(head + tail > 0.0 ? 0 : 1, static_cast<int>(std::lround(along.back() / spacing - head - tail)));
  const double step = along.back() / (steps + head + tail);
  const bool leaves_out_last = run.after && tail == 0.0;

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
    const Joint& joint = joints.next[f];
    if (!joint.exists()) continue;
    const WallFace<2>& from = body.faces[f];
    const WallFace<2> to = body.faces[joint.face].moved(joint.moved);
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

/// The faces of each chain, and their images within `margin` (m) of the domain.
std::vector<std::vector<WallFace<2>>> faces_by_chain(const Boundary<2>& body, const Joints& joints, double margin) {
  const Box<2> space = space_around<2>(body.domain, margin);
  std::vector<std::vector<WallFace<2>>> chains;
  for (std::size_t f = 0; f < joints.chain.size(); ++f) {
    chains.resize(std::max<std::size_t>(chains.size(), joints.chain[f] + 1));
    std::vector<WallFace<2>>& chain = chains[joints.chain[f]];
    chain.push_back(body.faces[f]);
    visit_images<2>(body.domain, body.faces[f].box(), space,
                    [&](const Vec<2>& by) { chain.push_back(body.faces[f].moved(by)); });
  }
  return chains;
}

/// The wall place at `x`: the nearest point of the chain, and the normals of all faces of the chain at that distance.
WallPlace<2> place_behind(const std::vector<WallFace<2>>& chain, const Vec<2>& x, double tolerance) {
  WallPlace<2> place{x, x, {}, -1};
  double nearest = std::numeric_limits<double>::max();
  for (const WallFace<2>& face : chain) {
    const Vec<2> point = closest_point(face, x);
    const double distance = (x - point).norm();
    if (distance < nearest - tolerance) {
      nearest = distance;
      place.foot = point;
      place.normals.clear();
      place.wall = face.wall;
    }
    if (distance <= nearest + tolerance) place.normals.push_back(face.normal);
  }
  return place;
}

}  // namespace

WallParticles<2> sample_chains(const Boundary<2>& body, const WallLayers& layers) {
  const double tolerance = corner_tolerance * layers.spacing;
  const Boundary<2> closed = with_closed_corners(body, layers.spacing, tolerance);
  const double farthest = farthest_share * layers.count * layers.spacing;
  const double free_end = layers.starts_on_wall ? 0.0 : 0.5;
  const Joints joints = join_faces(closed, tolerance);
  const std::vector<std::vector<WallFace<2>>> chains = faces_by_chain(closed, joints, 2.0 * farthest);
  const std::vector<Run> runs = make_runs(closed, joints);
  WallParticleCollector<2> collector(closed, layers);
  if (!layers.starts_on_wall) fill_tips(closed, joints, layers, collector);
  for (int layer = 0; layer < layers.count; ++layer) {
    const double depth = layers.first_depth() + layer * layers.spacing;
    for (const Run& run : runs) {
      const int chain = joints.chain[run.faces.front()];
      const RowOfPlaces row = place_row(closed, run, depth, layers.spacing, free_end);
      for (const Vec<2>& x : row.places) {
        WallPlace<2> place = place_behind(chains[chain], x, tolerance);
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
