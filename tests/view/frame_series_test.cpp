// The frames of a run on 1 to 4 ranks: identical bytes, exact to half a quantum, and unchanged by a resumption.
#include "view/frame_series.h"
#include "geometry/rotation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/box.h"
#include "io/shared_folder.h"

namespace tailwater {
namespace {

constexpr double spacing = 0.01;

/// Water that oscillates in a tank, with particles that enter and leave. Each rank has some of the particles, in no
/// order.
template <int Dim>
struct Swing {
  std::vector<std::int64_t> id;
  std::vector<Vec<Dim>> position;
  std::vector<double> pressure;
  std::vector<double> speed;
  std::vector<AffineMap<Dim>> poses;
  double time;

  Swing(int frame, int count, const Communicator& ranks) : time(0.01 * frame) {
    for (int n = count - 1; n >= 0; --n) {
      if ((n * 7 + frame / 5) % ranks.size() != ranks.rank() || (n + frame) % 97 == 0) continue;
      Vec<Dim> x = Vec<Dim>::Constant(spacing * (n % 40));
      x[1] = spacing * (n / 40) + 0.02 * std::sin(5.0 * time + n);
      x[0] += 0.05 * std::sin(8.0 * time);
      id.push_back(n);
      position.push_back(x);
      pressure.push_back(1000.0 + 500.0 * std::cos(20.0 * time + x[1]) * (frame == 23 ? 10.0 : 1.0));
      speed.push_back(frame == 0 ? 0.0 : 0.4 * std::abs(std::cos(8.0 * time)));
    }
    AffineMap<Dim> pose;
    if constexpr (Dim == 2) {
      pose.linear = rotation_in_plane(time);
    } else {
      pose.linear = rotation_about(Vec<3>(1, 2, 3).normalized(), time);
    }
    pose.constant[0] = time;
    poses = {AffineMap<Dim>(), pose};
  }

  WaterNow<Dim> now() const {
    return {.time = time, .id = id, .position = position, .scalars = {pressure, speed}, .poses = poses};
  }
};

template <int Dim>
Box<Dim> tank() {
  return {Vec<Dim>::Constant(-0.1), Vec<Dim>::Constant(0.6)};
}

std::string name_of_frame(int k) { return fmt::format("{:05}.frame", k); }

template <int Dim>
void write_frames(FrameSeries<Dim>& series, int first, int end, const Communicator& ranks) {
  for (int k = first; k < end; ++k) {
    const Swing<Dim> water(k, 800, ranks);
    series.write(water.now(), ranks);
  }
}

/// All frames, decoded in sequence as a viewer does.
std::vector<Frame> decoded(const std::filesystem::path& folder, int count) {
  std::vector<Frame> frames;
  FramesBefore before;
  for (int k = 0; k < count; ++k) {
    frames.push_back(decode_frame(text_of(folder / name_of_frame(k)), before));
    before.last_but_one = std::exchange(before.last, frames.back().particles);
  }
  return frames;
}

template <int Dim>
void expect_close(const Frame& frame, const Swing<Dim>& truth) {
  const FrameScale& scale = frame.head.scale;
  ASSERT_EQ(frame.particles.id.size(), truth.id.size());
  for (std::size_t n = 0; n < truth.id.size(); ++n) {
    const std::size_t i = truth.id.size() - 1 - n;  // truth is in descending order
    ASSERT_EQ(frame.particles.id[n], truth.id[i]);
    for (int d = 0; d < Dim; ++d) {
      const double quantum = (scale.high[d] - scale.low[d]) / 65535.0;
      EXPECT_LE(quantum, spacing / 100.0);
      EXPECT_NEAR(scale.low[d] + quantum * frame.particles.place[d][n], truth.position[i][d], 0.5001 * quantum);
    }
    const double values[] = {truth.pressure[i], truth.speed[i]};
    for (std::size_t s = 0; s < 2; ++s) {
      const double step = (scale.ranges[s][1] - scale.ranges[s][0]) / 255.0;
      EXPECT_NEAR(scale.ranges[s][0] + step * frame.particles.scalar[s][n], values[s], 0.5001 * step);
    }
  }
}

template <int Dim>
void frames_hold_what_was_written() {
  const SharedFolder folder;
  const Communicator& ranks = folder.ranks();
  FrameSeries<Dim> series(folder.path() / "view", spacing, tank<Dim>());
  write_frames<Dim>(series, 0, 30, ranks);
  if (!ranks.is_root()) return;
  const Communicator alone;
  const std::vector<Frame> frames = decoded(folder.path() / "view", 30);
  int since_key = 0;
  for (int k = 0; k < 30; ++k) {
    const FrameHead& head = frames[k].head;
    expect_close<Dim>(frames[k], Swing<Dim>(k, 800, alone));
    EXPECT_EQ(head.index, static_cast<std::uint32_t>(k));
    since_key = head.order == 0 ? 0 : since_key + 1;
    EXPECT_LT(since_key, 10);
    ASSERT_EQ(head.poses.size(), 2U);
    EXPECT_DOUBLE_EQ(head.poses[1][0], 0.01 * k);
    const double angle = Dim == 2 ? head.poses[1][2] : 2.0 * std::acos(std::min(1.0, head.poses[1][3]));
    EXPECT_NEAR(angle, 0.01 * k, 1e-7);
  }
  EXPECT_EQ(frames[23].head.order, 0);  // its pressure is out of range
  // The frames of a single rank are identical.
  const TemporaryFolder other;
  FrameSeries<Dim> lone(other.path() / "view", spacing, tank<Dim>());
  write_frames<Dim>(lone, 0, 30, alone);
  for (int k = 0; k < 30; ++k) {
    EXPECT_TRUE(text_of(other.path() / "view" / name_of_frame(k)) == text_of(folder.path() / "view" / name_of_frame(k)))
        << "frame " << k;
  }
}

TEST(FrameSeries, HoldsWhatWasWritten2D) { frames_hold_what_was_written<2>(); }
TEST(FrameSeries, HoldsWhatWasWritten3D) { frames_hold_what_was_written<3>(); }

TEST(FrameSeries, GoesOnAsIfItHadNeverStopped) {
  const SharedFolder folder;
  const Communicator& ranks = folder.ranks();
  const std::filesystem::path whole = folder.path() / "whole";
  const std::filesystem::path part = folder.path() / "part";
  FrameSeries<2> series(whole, spacing, tank<2>());
  write_frames<2>(series, 0, 35, ranks);
  for (const int kept : {0, 1, 2, 12, 20, 24}) {
    FrameSeries<2> stopped(part, spacing, tank<2>());
    write_frames<2>(stopped, 0, 33, ranks);
    FrameSeries<2> resumed(part, spacing, tank<2>());
    resumed.go_on(static_cast<std::size_t>(kept), ranks);
    if (ranks.is_root()) {
      EXPECT_FALSE(std::filesystem::exists(part / name_of_frame(kept)));
    }
    ranks.meet();
    write_frames<2>(resumed, kept, 35, ranks);
    if (!ranks.is_root()) continue;
    for (int k = 0; k < 35; ++k) {
      EXPECT_TRUE(text_of(whole / name_of_frame(k)) == text_of(part / name_of_frame(k))) << kept << ", frame " << k;
    }
  }
}

TEST(FrameSeries, GoesOnWithAKeyFrameWhereFramesAreMissingOrDamaged) {
  const SharedFolder folder;
  const Communicator& ranks = folder.ranks();
  const std::filesystem::path view = folder.path() / "view";
  for (const bool is_damaged : {false, true}) {
    FrameSeries<2> series(view, spacing, tank<2>());
    write_frames<2>(series, 0, 8, ranks);
    if (ranks.is_root()) {
      std::filesystem::remove(view / name_of_frame(6));
      if (is_damaged) std::ofstream(view / name_of_frame(6)) << "TWVF";
    }
    ranks.meet();
    FrameSeries<2> resumed(view, spacing, tank<2>());
    resumed.go_on(8, ranks);
    write_frames<2>(resumed, 8, 9, ranks);
    if (ranks.is_root()) {
      EXPECT_EQ(read_frame_head(text_of(view / name_of_frame(8))).head.order, 0);
    }
    ranks.meet();
  }
}

TEST(FrameSeries, IdsMayHaveLargeGaps) {
  const SharedFolder folder;
  FrameSeries<2> series(folder.path() / "view", spacing, tank<2>());
  Swing<2> water(3, 50, folder.ranks());
  for (std::int64_t& id : water.id) id *= 1'000'000'000;
  series.write(water.now(), folder.ranks());
  if (!folder.ranks().is_root()) return;
  Swing<2> all(3, 50, Communicator());
  for (std::int64_t& id : all.id) id *= 1'000'000'000;
  expect_close<2>(decoded(folder.path() / "view", 1)[0], all);
}

TEST(FrameSeries, NoWaterIsAFrameToo) {
  const SharedFolder folder;
  FrameSeries<3> series(folder.path() / "view", spacing, {});
  const Swing<3> none(0, 0, folder.ranks());
  series.write(none.now(), folder.ranks());
  series.write(Swing<3>(1, 100, folder.ranks()).now(), folder.ranks());
  if (!folder.ranks().is_root()) return;
  const std::vector<Frame> frames = decoded(folder.path() / "view", 2);
  EXPECT_EQ(frames[0].particles.size(), 0U);
  expect_close<3>(frames[1], Swing<3>(1, 100, Communicator()));
}

}  // namespace
}  // namespace tailwater
