#include <gtest/gtest.h>

#include <string>

#include "cases.h"
#include "geometry/preview.h"

namespace tailwater {
namespace {

using namespace testing_cases;

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

template <int Dim>
std::string preview(const CaseSpec& spec) {
  const Boundary<Dim> boundary = make_boundary<Dim>(spec);
  return preview_svg<Dim>(spec, boundary, make_fluid_particles<Dim>(spec, boundary),
                          make_dummy_particles<Dim>(boundary, spec.particles.spacing, 3));
}

TEST(Preview, ShowsParticlesWallsProbesAndCounts) {
  CaseSpec spec = tank();
  spec.general.title = "Tank <at> rest & quiet";
  ProbeTable probe;
  probe.name = "H1";
  probe.at = {0.5, 0.0};
  spec.probes = {probe};
  const std::string svg = preview<2>(spec);
  EXPECT_EQ(occurrences(svg, "M"), 40u + 84u) << "a dot per particle";
  EXPECT_NE(svg.find("Tank &lt;at&gt; rest &amp; quiet"), std::string::npos);
  EXPECT_NE(svg.find("spacing 0.1 m, 40 fluid and 84 wall particles"), std::string::npos);
  EXPECT_NE(svg.find(">H1</text>"), std::string::npos);
}

TEST(Preview, DrawsOutlinesWhenThereAreTooManyParticles) {
  CaseSpec spec = tank();
  spec.particles.spacing = 0.002;
  const std::string svg = preview<2>(spec);
  EXPECT_EQ(occurrences(svg, "<polygon"), 1u) << "100 000 particles are one block";
  EXPECT_EQ(occurrences(svg, "<path"), 1u) << "the wall's";
}

TEST(Preview, Projects3DOnXAndZ) {
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {1.0, 0.5, 0.6}, {"+z"})};
  spec.fluid = {box_fluid({0, 0, 0}, {0.4, 0.5, 0.4})};
  EXPECT_NE(preview<3>(spec).find("z (m)"), std::string::npos);
}

TEST(Preview, ShowsOutlets) {
  CaseSpec spec = open_channel();
  spec.outlets[0].name = "weir & end";
  EXPECT_NE(preview<2>(spec).find(">weir &amp; end</text>"), std::string::npos);
  spec.outlets.clear();
  EXPECT_EQ(preview<2>(spec).find("weir"), std::string::npos);
}

}  // namespace
}  // namespace tailwater
