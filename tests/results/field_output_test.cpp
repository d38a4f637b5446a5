#include "results/field_output.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <variant>

#include "case/choices.h"
#include "support/dimensions.h"
#include "support/pond.h"

namespace tailwater {
namespace {

template <class Dimension>
class FluidFieldsTest : public testing::Test {};

TYPED_TEST_SUITE(FluidFieldsTest, Dimensions);

TYPED_TEST(FluidFieldsTest, HoldsTheWaterInTheOrderOfItsIds) {
  constexpr int Dim = TypeParam::value;
  Flow<Dim> flow = make_flow<Dim>(pond_case<Dim>());
  Particles<Dim>& particles = flow.state.particles;
  const std::vector<Vec<Dim>> start(particles.position.begin(), particles.position.end());
  // As after sorting for the cache: particles swapped whole.
  std::reverse(particles.id.begin(), particles.id.end());
  std::reverse(particles.position.begin(), particles.position.end());
  particles.kind[2] = ParticleKind::wall;
  const std::int64_t wall_id = particles.id[2];

  const FluidFields<Dim> fields(flow, particles, {"id"});
  const ParticleFields<Dim> view = fields.view();
  ASSERT_EQ(view.fields.size(), 1u);
  const auto ids = std::get<std::span<const std::int64_t>>(view.fields[0].values);
  ASSERT_EQ(ids.size(), start.size() - 1);
  ASSERT_EQ(view.position.size(), ids.size());
  for (std::size_t k = 0; k < ids.size(); ++k) {
    EXPECT_EQ(ids[k], static_cast<std::int64_t>(k) + (static_cast<std::int64_t>(k) >= wall_id ? 1 : 0));
    EXPECT_EQ(view.position[k], start[static_cast<std::size_t>(ids[k])]);
  }
}

TYPED_TEST(FluidFieldsTest, GivesTheFieldsThatAreAskedFor) {
  constexpr int Dim = TypeParam::value;
  const Flow<Dim> flow = make_flow<Dim>(pond_case<Dim>());
  const std::vector<std::string> names(field_names.begin(), field_names.end());
  const FluidFields<Dim> all(flow, flow.state.particles, names);
  const auto view = all.view();
  ASSERT_EQ(view.fields.size(), names.size());
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_EQ(view.fields[k].name, names[k]);
    std::visit([&](const auto& values) { EXPECT_EQ(values.size(), flow.state.particles.owned); },
               view.fields[k].values);
  }
  EXPECT_TRUE((FluidFields<Dim>(flow, flow.state.particles, {}).view().fields.empty()));
}

}  // namespace
}  // namespace tailwater
