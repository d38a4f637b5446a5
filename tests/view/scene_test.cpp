// The scene of a case: all data that a viewer needs to draw everything except water.
#include "view/scene.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "case/reader.h"
#include "io/temporary_folder.h"

namespace tailwater {
namespace {

constexpr const char* start = R"(
[particles]
spacing = 0.1
[time]
end = 2
)";

const std::string tank = R"(
[[fluid]]
min = [0, 0]
max = [1, 0.5]
[[wall]]
points = [[0, 2], [0, 0], [4, 0], [4, 2]]
)";

template <int Dim>
Json scene_of(const std::string& text) {
  const CaseSpec spec = read_case_text(start + text, "case");
  return scene_json<Dim>(spec, make_boundary<Dim>(spec));
}

TEST(Scene, OfAFlume) {
  const Json scene = scene_of<2>(R"(
[[fluid]]
min = [0, 0]
max = [1, 0.5]
[[wall]]
name = "bed"
points = [[0, 2], [0, 0], [4, 0]]
[[gate]]
name = "lock"
from = [1, 0]
to = [1, 0.6]
speed = 1
[[wall]]
name = "hull"
shape = "box"
min = [2, 0.3]
max = [2.4, 0.6]
fluid_side = "outside"
[[body]]
name = "barge"
walls = ["hull"]
mass = 60
centre = [2.2, 0.4]
inertia = [1]
[[outlet]]
name = "end"
from = [4, 0]
to = [4, 2]
[[probe]]
name = "gauge"
type = "depth"
at = [0.5, 0]
)");
  EXPECT_EQ(scene["dimension"], 2);
  EXPECT_EQ(scene["end"], 2.0);
  ASSERT_EQ(scene["walls"].size(), 3U);
  const Json& bed = scene["walls"][0];
  EXPECT_EQ(bed["name"], "bed");
  EXPECT_EQ(bed["kind"], "wall");
  EXPECT_EQ(bed["moving"], nullptr);
  EXPECT_EQ(bed["polylines"], Json::parse("[[[0.0, 2.0], [0.0, 0.0], [4.0, 0.0]]]"));
  // The hull is closed; hull and gate move, each by its own pose.
  const Json& hull = scene["walls"][1];
  EXPECT_EQ(hull["kind"], "body");
  ASSERT_EQ(hull["polylines"].size(), 1U);
  EXPECT_EQ(hull["polylines"][0].size(), 5U);
  EXPECT_EQ(hull["polylines"][0].front(), hull["polylines"][0].back());
  const Json& gate = scene["walls"][2];
  EXPECT_EQ(gate["kind"], "gate");
  EXPECT_EQ(gate["name"], "lock");
  EXPECT_EQ(hull["moving"], 0);
  EXPECT_EQ(gate["moving"], 1);
  EXPECT_EQ(scene["bodies"][0]["name"], "barge");
  EXPECT_EQ(scene["bodies"][0]["pose"], 0);
  EXPECT_EQ(scene["outlets"][0]["name"], "end");
  EXPECT_EQ(scene["outlets"][0]["direction"], Json::parse("[1.0, 0.0]"));
  EXPECT_EQ(scene["probes"][0]["file"], "probes/gauge.csv");
  EXPECT_EQ(scene["probes"][0]["points"], Json::parse("[[0.5, 0.0]]"));
  EXPECT_EQ(scene["probes"][0]["columns"], Json::parse(R"(["connected_m", "highest_m", "wet_m"])"));
  EXPECT_EQ(scene["box"]["max"], Json::parse("[4.0, 2.0]"));
}

TEST(Scene, HoldsWhatWasMeasuredWithinTheTimeOfTheRun) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "lab.csv") << "t [s], depth [mm]\n-1, 9\n0, 400\n0.5, 380\n2, 300\n3, 9\n";
  const Json scene = scene_of<2>(tank + R"([[probe]]
name = "all"
type = "energy"
[[probe]]
name = "gauge"
type = "depth"
at = [0.5, 0]
[[measurement]]
probe = "gauge"
column = "wet"
file = ")" + (folder.path() / "lab.csv").string() +
                                 "\"\n");
  EXPECT_EQ(scene["measurements"], Json::parse(R"([{"probe": "gauge", "column": "wet_m", "file": "lab.csv",
                                                    "time": [0.0, 0.5, 2.0], "value": [0.4, 0.38, 0.3]}])"));
}

TEST(Scene, APlateIsDrawnOnce) {
  const Json scene = scene_of<2>(tank + R"([[wall]]
name = "sheet"
shape = "plate"
points = [[2, 0], [2, 0.5], [2.5, 0.8]]
)");
  EXPECT_TRUE(scene["walls"][1]["plate"]);
  EXPECT_EQ(scene["walls"][1]["polylines"], Json::parse("[[[2.0, 0.0], [2.0, 0.5], [2.5, 0.8]]]"));
}

TEST(Scene, HasPlacesOfAirAndVentsAsWideAsTheirArea) {
  constexpr const char* air = R"([air]
pockets = "adiabatic"
[[pocket]]
at = [3, 1]
overpressure = 100
[[vent]]
at = [3, 1.5]
area = 0.02
)";
  const Json scene = scene_of<2>(tank + air);
  EXPECT_EQ(scene["pockets"], Json::parse(R"([{"name": "pocket1", "at": [3.0, 1.0]}])"));
  EXPECT_EQ(scene["vents"], Json::parse(R"([{"name": "vent1", "at": [3.0, 1.5], "width": 0.02}])"));
  const Json hole = scene_of<3>(R"(
[case]
dimension = 3
[air]
pockets = "adiabatic"
[[fluid]]
min = [0, 0, 0]
max = [0.5, 0.5, 0.5]
[[wall]]
shape = "box"
min = [0, 0, 0]
max = [1, 1, 1]
[[vent]]
at = [0.5, 0.5, 1]
area = 0.00785398163
)");
  EXPECT_NEAR(hole["vents"][0]["width"].get<double>(), 0.1, 1e-6) << "of pi/4 d^2";
}

TEST(Scene, TrianglesOfABoxShareTheirCorners) {
  const Json scene = scene_of<3>(R"(
[case]
dimension = 3
[[fluid]]
min = [0, 0, 0]
max = [0.5, 0.5, 0.5]
[[wall]]
shape = "box"
min = [0, 0, 0]
max = [1, 1, 1]
open = ["+z"]
)");
  const Json& triangles = scene["walls"][0]["triangles"];
  EXPECT_EQ(triangles["positions"].size(), 3 * 8U);
  ASSERT_EQ(triangles["indices"].size(), 3 * 10U);  // five faces of two
  // Counter-clockwise as seen from the water in the middle.
  for (std::size_t k = 0; k < 10; ++k) {
    std::array<Vec<3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto first = 3 * triangles["indices"][3 * k + c].get<std::size_t>();
      for (std::size_t d = 0; d < 3; ++d) corners[c][d] = triangles["positions"][first + d].get<double>();
    }
    const Vec<3> normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    EXPECT_GT(normal.dot(Vec<3>::Constant(0.5) - corners[0]), 0.0);
  }
}

}  // namespace
}  // namespace tailwater
