#include "run/frame_output.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/for_each.h"
#include "geometry/boundary.h"
#include "view/scene.h"

namespace tailwater {
namespace {

/// Enough to play a run for 16 seconds without a jump.
constexpr double default_frames = 400.0;

/// From where it is drawn to where it is now, of each pose of the scene.
template <int Dim>
std::vector<AffineMap<Dim>> poses_of(const Flow<Dim>& flow) {
  const std::vector<int> pose_of_wall = pose_of_walls(flow.walls.boundary);
  std::vector<AffineMap<Dim>> poses;
  for (const auto& moving : flow.setup.wall_motion.moving()) {
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
      interval_(spec.output.view_interval > 0.0 ? spec.output.view_interval : spec.time.end / default_frames) {}

template <int Dim>
void FrameOutput<Dim>::begin(const CaseSpec& spec, const Flow<Dim>& flow) {
  // Walls of the flow are where they are now; a viewer moves them from where they are drawn.
  const bool is_root = flow.setup.ranks.is_root();
  const std::string scene = is_root ? scene_json<Dim>(spec, make_boundary<Dim>(spec)).dump() + "\n" : "";
  series_.write_beside(scene_name, scene, flow.setup.ranks);
}

template <int Dim>
void FrameOutput<Dim>::write_due(const Flow<Dim>& flow) {
  if (flow.state.time < next_) return;
  write(flow);
  next_ = due_after(flow.state.time);
}

template <int Dim>
void FrameOutput<Dim>::write(const Flow<Dim>& flow) {
  if (last_time_ == flow.state.time) return;
  last_time_ = flow.state.time;
  const Particles<Dim>& particles = flow.state.particles;
  const std::vector<std::size_t> fluid =
      indices_where(particles.owned, [&](std::size_t i) { return particles.is_fluid(i); });
  std::vector<std::int64_t> id(fluid.size());
  std::vector<Vec<Dim>> position(fluid.size());
  std::vector<double> pressure(fluid.size());
  std::vector<double> speed(fluid.size());
  for_each(fluid.size(), [&](std::size_t k) {
    const std::size_t i = fluid[k];
    id[k] = particles.id[i];
    position[k] = particles.position[i];
    pressure[k] = particles.pressure[i];
    speed[k] = particles.velocity[i].norm();
  });
  const std::vector<AffineMap<Dim>> poses = poses_of(flow);
  series_.write({.time = flow.state.time, .id = id, .position = position, .scalars = {pressure, speed}, .poses = poses},
                flow.setup.ranks);
}

template <int Dim>
double FrameOutput<Dim>::due_after(double time) const {
  return (std::floor(time / interval_) + 1.0) * interval_;
}

template <int Dim>
nlohmann::json FrameOutput<Dim>::saved() const {
  return {{"count", series_.size()}, {"interval", interval_}, {"next", next_}, {"last", last_time_}};
}

template <int Dim>
void FrameOutput<Dim>::take_up(const nlohmann::json& saved, const Communicator& ranks) {
  series_.go_on(saved.at("count"), ranks);
  next_ = saved.at("next");
  last_time_ = saved.at("last");
  if (saved.at("interval") != interval_) next_ = due_after(last_time_);
}

template class FrameOutput<2>;
template class FrameOutput<3>;

}  // namespace tailwater
