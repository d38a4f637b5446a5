#include "results/frame_output.h"

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "base/for_each.h"
#include "geometry/boundary.h"
#include "motion/wall_motion.h"
#include "parallel/together.h"
#include "view/scene.h"

namespace tailwater {
namespace {

/// Enough frames to play a run for 16 seconds without a visible jump.
constexpr double default_frames = 400.0;
/// By default at most every eighth step makes a frame, which takes 6 to 7 % of a step: less than 1 % of the run.
constexpr std::int64_t default_least_steps = 8;

/// The transform of each pose of the scene from the drawn to the present position.
template <int Dim>
std::vector<AffineMap<Dim>> poses_of(const Flow<Dim>& flow) {
  const std::vector<int> pose_of_wall = pose_of_walls(flow.walls.boundary);
  std::vector<AffineMap<Dim>> poses;
  for (const auto& moving : flow.setup.wall_motion->moving()) {
    const auto pose = static_cast<std::size_t>(pose_of_wall[moving.wall]);
    if (pose >= poses.size()) poses.resize(pose + 1);
    poses[pose] = moving.at(flow.state.time, flow.state.motion);
  }
  return poses;
}

}  // namespace

template <int Dim>
FrameOutput<Dim>::FrameOutput(const CaseSpec& spec, const RunFolder& folder, const Flow<Dim>& flow)
    : series_(folder.view(), spec.particles.spacing, flow.box()),
      schedule_(spec.output.view_interval > 0.0 ? spec.output.view_interval : spec.time.end / default_frames),
      min_steps_(spec.output.view_interval > 0.0 ? 1 : default_least_steps) {}

template <int Dim>
void FrameOutput<Dim>::begin(const CaseSpec& spec, const Flow<Dim>& flow) {
  // Walls of the flow are at their present place; a viewer moves them from where they are drawn.
  std::string scene;
  do_on_root(flow.setup.ranks, [&] { scene = scene_json<Dim>(spec, make_boundary<Dim>(spec)).dump() + "\n"; });
  series_.write_beside(scene_name, scene, flow.setup.ranks);
}

template <int Dim>
void FrameOutput<Dim>::write_due(const Flow<Dim>& flow) {
  if (!schedule_.is_due(flow.state.time) || flow.state.step < next_step_) return;
  write(flow);
  schedule_.set_next(flow.state.time);
  next_step_ = flow.state.step + min_steps_;
}

template <int Dim>
void FrameOutput<Dim>::write(const Flow<Dim>& flow) {
  if (schedule_.last() == flow.state.time) return;
  schedule_.set_last(flow.state.time);
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<std::size_t> fluid = indices_where(particles.owned, [&](std::size_t i) {
    return particles.is_fluid(i) && !flow.walls.boundary.is_in_duct(particles.position[i]);
  });
  std::vector<std::int64_t> id(fluid.size());
  std::vector<Vec<Dim>> position(fluid.size());
  std::vector<double> pressure(fluid.size());
  std::vector<double> speed(fluid.size());
  const bool has_sizes = flow.setup.graded != nullptr;
  const bool has_liquids = flow.setup.liquids.are_several();
  std::vector<double> size(has_sizes ? fluid.size() : 0);
  std::vector<double> liquid(has_liquids ? fluid.size() : 0);
  for_each(fluid.size(), [&](std::size_t k) {
    const std::size_t i = fluid[k];
    id[k] = particles.id[i];
    position[k] = particles.position[i];
    pressure[k] = particles.pressure[i];
    speed[k] = particles.velocity[i].norm();
    if (has_sizes) size[k] = edge_of<Dim>(particles.volume[i]);
    if (has_liquids) liquid[k] = flow.setup.liquids.of(particles.id[i]);
  });
  std::vector<std::span<const double>> scalars{pressure, speed};  // as frame_scalars names them
  if (has_sizes) scalars.emplace_back(size);
  if (has_liquids) scalars.emplace_back(liquid);
  const std::vector<AffineMap<Dim>> poses = poses_of(flow);
  series_.write({.time = flow.state.time, .id = id, .position = position, .scalars = scalars, .poses = poses},
                flow.setup.ranks);
}

template <int Dim>
Json FrameOutput<Dim>::saved() const {
  Json saved = schedule_.saved();
  saved["count"] = series_.size();
  saved["next_step"] = next_step_;
  return saved;
}

template <int Dim>
void FrameOutput<Dim>::restore(const Json& saved, const Communicator& ranks) {
  series_.go_on(saved.at("count"), ranks);
  schedule_.restore(saved);
  next_step_ = saved.value("next_step", next_step_);
}

template class FrameOutput<2>;
template class FrameOutput<3>;

}  // namespace tailwater
