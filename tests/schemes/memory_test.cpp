// Memory of a flow per particle when its matrix is assembled: of arrays with an entry per pair, only the neighbours and
// the weights remain.
#include <gtest/gtest.h>
#include <malloc.h>

#include "schemes/cases.h"
#include "support/dimensions.h"

namespace tailwater {
namespace {

template <class Dimension>
class MemoryTest : public testing::Test {};
TYPED_TEST_SUITE(MemoryTest, Dimensions);

double bytes_on_heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

// Fields take 460 bytes in 2D and 720 in 3D; another array of 4 bytes per pair would add 92 and 202.
TYPED_TEST(MemoryTest, OfArraysByPairAMatrixKeepsTheNeighboursAndTheWeights) {
  constexpr int Dim = TypeParam::value;
  constexpr int edge = Dim == 2 ? 60 : 16;
  const CaseSpec spec = tank_case<Dim>(1.0 / edge, 1.0, 1.0);
  const double before = bytes_on_heap();
  Flow<Dim> flow = make_flow<Dim>(spec);
  sort_particles(flow);
  start(flow);
  for (int n = 0; n < 3; ++n) advance(flow, next_time_step(flow));

  const double dt = next_time_step(flow);
  const StepStart<Dim> begin = begin_step(flow, dt);
  const WallDrive<Dim> drive = drive_walls(flow, begin.wall_velocity, dt);
  locate(flow);
  Prediction<Dim> predicted = predict(flow, begin, drive, dt);
  const std::vector<double> target = target_divergence(flow, std::move(predicted.velocity_gradient), dt);
  const PosedEquation equation = assemble(flow, predicted, target, drive, dt);

  const double bytes = bytes_on_heap() - before;
  if (bytes <= 0.0) GTEST_SKIP() << "this allocator does not tell what it has given";
  const auto particles = static_cast<double>(flow.state.particles.owned);
  const auto pairs = static_cast<double>(flow.pairs().j.size());
  const double rest = (bytes - pairs * (sizeof(std::int32_t) + sizeof(float))) / particles;
  EXPECT_LT(rest, Dim == 2 ? 520.0 : 850.0)
      << pairs / particles << " pairs, " << flow.walls.all / particles << " rows of walls each";
}

}  // namespace
}  // namespace tailwater
