// Summaries of cases in sentences.
#include "run/explain.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "case/reader.h"

namespace tailwater {
namespace {

const std::string basin =
    "[case]\ntitle = \"A basin\"\n[particles]\nspacing = 0.05\n[time]\nend = 10\n"
    "[[wall]]\nname = \"tank\"\npoints = [[0, 1], [0, 0], [1, 0], [1, 1]]\nslip = \"no-slip\"\n";

std::vector<std::string> sentences_of_case(const std::string& text, double fluid = 200.0) {
  const CaseSpec spec = read_case_text(text, "case.toml");
  return explain_case(spec, {.particles = {fluid, 300.0},
                             .water = 0.48,
                             .largest_fluid = fluid,
                             .memory = 5e7,
                             .steps = 640.0,
                             .seconds = 3.0});
}

std::vector<std::string> sentences_of(const std::string& more) {
  return sentences_of_case(basin + "roughness = 0.001\n[[fluid]]\nmin = [0, 0]\nmax = [1, 0.5]\n" + more);
}

bool tells(const std::vector<std::string>& sentences, const std::string& text) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(text) != std::string::npos; });
}

TEST(ExplainCase, TellsWaterWallsMeasurementsAndCost) {
  const std::vector<std::string> sentences = sentences_of("[[probe]]\nname = \"a\"\ntype = \"depth\"\nat = [0.5, 0]\n");
  EXPECT_EQ(sentences.front(), "\"A basin\" is a case in two dimensions.");
  for (const char* text :
       {"there are 0.48 m^3 of water per metre of width (480 kg), in 1 box: 200 particles, 0.05 m apart",
        "Walls are 'tank' (polyline of 4 points, rough).", "Gravity is 9.81 m/s^2", "Measured are depth ('a').",
        "The scheme is farzin2014 (robust, explicit",
        "It ends at 10 s: about 640 steps, 3 s on one core of this machine and 50 MB"}) {
    EXPECT_TRUE(tells(sentences, text)) << text;
  }
}

TEST(ExplainCase, TellsWhatMovesComesInAndLeaves) {
  const std::vector<std::string> sentences = sentences_of(
      "[[gate]]\nname = \"g\"\nfrom = [0.5, 0]\nto = [0.5, 0.8]\nspeed = 2\nstart = 1\n"
      "[[wall]]\nname = \"hull\"\nshape = \"box\"\nmin = [0.7, 0.4]\nmax = [0.9, 0.6]\nfluid_side = \"outside\"\n"
      "[[body]]\nname = \"b\"\nwalls = [\"hull\"]\nmass = 20\ncentre = [0.8, 0.5]\nfree = [\"y\"]\n"
      "[[inlet]]\nname = \"in\"\nfrom = [0, 0]\nto = [0, 1]\ndischarge = \"0.1*t\"\n"
      "[[outlet]]\nname = \"out\"\nfrom = [1, 0]\nto = [1, 1]\nlevel = 0.45\n"
      "[[outlet]]\nname = \"hole\"\nfrom = [0.2, 0]\nto = [0.3, 0]\ndirection = [0, -1]\nbeyond = \"air\"\n");
  for (const char* text :
       {"Gate 'g' begins to move at 1 s, at 2 m/s.", "Body 'b' of 20 kg per metre of width floats, free in y.",
        "Water enters at 'in' with a discharge of 0.1*t in m^3/s per metre of width.",
        "It leaves at 'out', against a tailwater at 0.45 m.", "It leaves at 'hole', as a free jet into air.",
        "Nothing is measured"}) {
    EXPECT_TRUE(tells(sentences, text)) << text;
  }
}

TEST(ExplainCase, NamesTheLiquids) {
  const std::string mud = "[[liquid]]\nname = \"mud\"\ndensity = 1200\nviscosity = 10\n";
  const std::string oil = "[[liquid]]\nname = \"oil\"\ndensity = 900\nviscosity = 1\n";
  const std::string low = "[[fluid]]\nmin = [0, 0]\nmax = [1, 0.25]\nliquid = \"mud\"\n";
  const std::string high = "[[fluid]]\nmin = [0, 0.25]\nmax = [1, 0.5]\nliquid = \"oil\"\n";
  EXPECT_TRUE(tells(sentences_of_case(basin + mud + low), "m^3 of 'mud' per metre of width (576 kg)"));
  EXPECT_TRUE(
      tells(sentences_of_case(basin + mud + oil + low + high), "m^3 of 'mud' and 'oil' per metre of width, in"));
}

TEST(ExplainCase, TellsOfPorousLayers) {
  const std::vector<std::string> sentences = sentences_of(
      "[[porous]]\nname = \"core\"\nmin = [0, 0]\nmax = [0.5, 1]\nporosity = 0.4\ngrain_size = 0.02\n"
      "[[porous]]\nname = \"sand\"\nmin = [0.5, 0]\nmax = [1, 1]\nporosity = 0.35\nresistance = "
      "\"coefficients\"\nlinear = 20\n");
  for (const char* text : {"Porous layer 'core' has a porosity of 0.4, and grains of 0.02 m (van-gent).",
                           "Porous layer 'sand' has a porosity of 0.35, and the coefficients a = 20 s/m and b = 0"}) {
    EXPECT_TRUE(tells(sentences, text)) << text;
  }
}

TEST(ExplainCase, TellsOfEnclosedAir) {
  const std::vector<std::string> sentences = sentences_of(
      "[air]\npockets = \"isothermal\"\n[[pocket]]\nat = [0.5, 0.8]\noverpressure = -300\n[[vent]]\nat = [0.5, 1]\n"
      "area = 2e-4\n");
  for (const char* text :
       {"is a gas (isothermal), in an atmosphere of 101325 Pa.", "That at (0.5, 0.8) begins 300 Pa below it.",
        "A vent at (0.5, 1) has 0.0002 m^2 per metre of width, with a loss coefficient of 2.7."}) {
    EXPECT_TRUE(tells(sentences, text)) << text;
  }
}

}  // namespace
}  // namespace tailwater
