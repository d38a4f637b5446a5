#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "checks/broken_case.h"
#include "checks/preview.h"
#include "geometry/ducts.h"
#include "geometry/from_spec.h"
#include "geometry/meshes.h"
#include "sampling/wall_particles.h"
#include "sampling/water_lattice.h"

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
  return preview_svg<Dim>(
      spec, boundary, make_fluid_particles<Dim>(spec, boundary),
      make_dummy_particles<Dim>(boundary, spec.particles.spacing, 3, {}, lattice_behind_meshes(spec, boundary)),
      find_ducts(spec, boundary));
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

TEST(Preview, ShowsLayersZonesAndMooringLines) {
  CaseSpec spec = tank();
  const std::size_t without = occurrences(preview<2>(spec), "<polygon");
  PorousTable box, polygon;
  box.name = "core";
  box.min = {0.2, 0.0};
  box.max = {0.4, 9.0};  // beyond the picture
  polygon.name = "armour";
  polygon.shape = RegionShape::polygon;
  polygon.points = {{0.4, 0.0}, {0.6, 0.0}, {0.4, 0.3}};
  spec.porous = {box, polygon};
  DampingTable damping;
  damping.name = "damping1";
  damping.min = {0.7, 0.0};
  damping.max = {1.0, 0.4};
  spec.damping = {damping};
  MooringTable line;
  line.name = "mooring1";
  line.at = {0.5, 0.3};
  line.anchor = {-0.5, 0.0};
  spec.moorings = {line};
  const std::string svg = preview<2>(spec);
  EXPECT_EQ(occurrences(svg, "<polygon"), without + 3);
  for (const char* name : {"core", "armour", "damping1", "mooring1"}) {
    EXPECT_NE(svg.find(fmt::format(">{}</text>", name)), std::string::npos) << name;
  }
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
  const std::string svg = preview<2>(spec);
  EXPECT_NE(svg.find(">weir &amp; end</text>"), std::string::npos);
  EXPECT_EQ(occurrences(svg, R"(stroke="#1e8449" stroke-width="1"/>)"), 4 * (spec.inlets.size() + spec.outlets.size()))
      << "the ducts beyond the ends";
  spec.outlets.clear();
  EXPECT_EQ(preview<2>(spec).find("weir"), std::string::npos);
}

TEST(Preview, ShowsVentsAndPockets) {
  CaseSpec spec = tank();
  spec.vents = {{.name = "vent1", .at = {0.5, 0.5}, .area = 0.01}};
  spec.pockets = {{.name = "pocket1", .at = {0.5, 0.6}, .overpressure = 100.0}};
  const std::string svg = preview<2>(spec);
  EXPECT_NE(svg.find(">vent1</text>"), std::string::npos);
  EXPECT_NE(svg.find(">pocket1</text>"), std::string::npos);
}

TEST(Preview, CirclesBadPlaces) {
  const CaseSpec spec = tank();
  const Boundary<2> boundary = make_boundary<2>(spec);
  const std::array<Vec<2>, 2> places{Vec<2>(0.5, 0.1), Vec<2>(2.5, 0.1)};
  const std::string svg = preview_svg<2>(spec, boundary, make_fluid_particles<2>(spec, boundary), {}, {}, places);
  EXPECT_EQ(occurrences(svg, "<circle"), 2u);
  EXPECT_NE(svg.find(">2.5</text>"), std::string::npos) << "the picture reaches to the second place";
}

TEST(Preview, OfAFineMeshDoesNotDrawItsFaces) {
  CaseSpec spec = empty_case(0.1, 3);
  const MeshFolder folder;
  spec.walls = {folder.wall(sheet_mesh(110, [](double x, double y) { return 0.1 * x * y; }), FluidSide::above)};
  spec.fluid = {box_fluid({0.0, 0.0, 0.3}, {0.4, 0.5, 0.4})};
  EXPECT_LT(preview<3>(spec).size(), 1'000'000u) << "24 200 triangles would be 8 MB";
}

TEST(BrokenCase, MarksThePlacesThatTheFindingNames) {
  const Clause edge{"the edge from {} to {}", place(Vec<3>(0.0, -1.5, 2e-5)), place(Vec<3>(1.0, 2.0, 3.25))};
  const CaseLabel wall("wall", "(4, 5, 6)");  // a name is no place
  const auto found =
      places_of<3>({Finding::error("edge-open", {"{}: {} leaves triangle {}", wall, edge, 3}, {"turn it over"})});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0], Vec<3>(0.0, -1.5, 2e-5));
  EXPECT_EQ(found[1], Vec<3>(1.0, 2.0, 3.25));
  EXPECT_TRUE(
      places_of<2>({Finding::error("too-little-memory", {"too much memory"}, {"use a larger spacing"})}).empty());
}

TEST(BrokenCase, ShowsTheTrianglesOfAMeshThatCannotBeAWall) {
  const MeshFolder folder;
  CaseSpec spec = empty_case(0.1, 3);
  spec.walls = {box_wall({0, 0, 0}, {2.0, 1.0, 1.0}, {"+z"}),
                folder.wall(box_mesh({0.5, 0.0, 0.0}, {1.0, 0.5, 0.5}), FluidSide::outside)};
  spec.fluid = {box_fluid({0.0, 0.0, 0.0}, {0.5, 1.0, 0.5})};
  EXPECT_EQ(draw_broken_case<3>(spec).fluid.position.size(), 5u * 10u * 5u) << "nothing is wrong";

  TriangleMesh open = box_mesh({0.5, 0.0, 0.0}, {1.0, 0.5, 0.5});
  open.triangles.pop_back();
  spec.walls[1] = folder.wall(open, FluidSide::outside);
  spec.walls[1].translate = {0.0, 0.0, 3.0};
  const BrokenCase<3> drawing = draw_broken_case<3>(spec);
  EXPECT_EQ(drawing.boundary.faces.size(), 5u * 2u + 11u);
  EXPECT_EQ(drawing.boundary.faces.back().wall, 1);
  EXPECT_GE(drawing.boundary.faces.back().corners[0][2], 3.0) << "where it stands in the case";
  for (const WallFace<3>& face : drawing.boundary.faces) {
    EXPECT_LT(face.wall, std::ssize(drawing.boundary.walls)) << "probes read the properties of walls";
  }
  EXPECT_TRUE(drawing.fluid.position.empty()) << "without all walls nobody knows where water can be";

  spec.walls[1].file = "nowhere.stl";
  EXPECT_EQ(draw_broken_case<3>(spec).boundary.faces.size(), 5u * 2u);
}

}  // namespace
}  // namespace tailwater
