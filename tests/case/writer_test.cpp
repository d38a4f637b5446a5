#include "case/writer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "case/toml_text.h"
#include "case_file.h"

namespace tailwater {
namespace {

void expect_round_trip(const std::string& text) {
  const CaseSpec spec = read_text(text);
  const std::string written = effective_case(spec);
  const CaseSpec again = read_text(written);
  EXPECT_EQ(again, spec) << written;
  EXPECT_EQ(effective_case(again), written);
}

TEST(EffectiveCase, OfTheShortestCaseReadsBack) { expect_round_trip(required_keys + water); }

TEST(TomlString, EscapesWhatCannotBeSeen) { EXPECT_EQ(toml_string("a\x01\n\x7f"), "\"a\\u0001\\u000A\\u007F\""); }

TEST(EffectiveCase, WithEveryShapeAndProbeReadsBack) {
  expect_round_trip(
      "[parameters]\nH = \"0.1 + 0.2\"\nT = \"1/3\"\n"
      "[case]\ntitle = \"a \\\"quoted\\\" \\\\ title\\twith tab and \u00e4\"\n"
      "[physics]\ngravity = [\"-0.0\", \"-9.81/3\"]\nviscosity = 1e-15\n"
      "[particles]\nspacing = \"H/7\"\njitter = 0.1\n[domain]\nperiodic_x = [\"-1/3\", \"1e15\"]\n"
      "[time]\nend = \"T\"\n[scheme]\nformulation = \"published\"\nintegrator = \"implicit\"\n"
      "[pressure_solver]\npetsc_options = \"-pressure_ksp_view\"\n"
      "[[fluid]]\nmin = [0, 0]\nmax = [\"H\", \"H\"]\nvelocity = [0.1, \"T\"]\n"
      "[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\nvelocity = [\"H*sin(x) - dx\", \"g*y\"]\n"
      "[[fluid]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [0, \"T\"]]\n"
      "[[wall]]\npoints = [[0, 1], [0, 0]]\nfluid_side = \"right\"\nslip = \"partial\"\nfriction = 0.3\n"
      "[[wall]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [0, 1]]\nfluid_side = \"outside\"\nslip = \"no-slip\"\n"
      "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [1, 1]\nopen = [\"+y\", \"-x\"]\n"
      "[[wall]]\npoints = [[2, 0], [2, 1]]\ndisplacement = [0, \"clamp(T*t, 0, H)\"]\nrotation = \"sin(2*t)\"\n"
      "pivot = [1, \"H\"]\n"
      "[[gate]]\nfrom = [1, 0]\nto = [1, 1]\nspeed = \"2*H\"\n"
      "[[gate]]\nfrom = [3, 0]\nto = [3, 1]\nmotion = \"acceleration\"\nacceleration = \"g*(3 - 1)/(3 + 1)\"\nstart = "
      "0.1\n"
      "[[wave_maker]]\nfrom = [0, 0]\nto = [0, 1]\ndepth = \"H\"\nheight = 0.1\nperiod = \"T\"\n"
      "[[wave_maker]]\nfrom = [4, 0]\nto = [4, 1]\nside = \"+x\"\ndepth = 0.5\nwaves = \"none\"\n"
      "absorption = \"active\"\n"
      "[[damping]]\nmin = [3, 0]\nmax = [4, 1]\nstrength = 2\n"
      "[[probe]]\nname = \"a\"\ntype = \"depth\"\nat = [\"H\", 0]\ninterval = 0.01\n"
      "[[probe]]\nname = \"b\"\ntype = \"wall-pressure\"\nat = [1, 1]\n"
      "[[probe]]\nname = \"c\"\ntype = \"wall-pressure-mean\"\nfrom = [0, 0]\nto = [0, 1]\n"
      "[[probe]]\nname = \"d\"\ntype = \"front\"\ndirection = [-1, 0]\n"
      "[[probe]]\nname = \"e\"\ntype = \"profile\"\nfrom = [0, 0]\nto = [1, 0]\ntimes = [0, 0.1, \"T\"]\n"
      "[[probe]]\nname = \"f\"\ntype = \"pressure\"\nat = [0, 0]\n"
      "[[probe]]\nname = \"g\"\ntype = \"velocity\"\nat = [0, 0]\n"
      "[[probe]]\nname = \"h\"\ntype = \"energy\"\n"
      "[[probe]]\nname = \"i\"\ntype = \"volume\"\n");
}

TEST(EffectiveCase, WithALiquidReadsBack) {
  for (const std::string law :
       {"viscosity = 0.3\n", "rheology = \"bingham\"\nviscosity = 0.3\nyield_stress = 7\n",
        "rheology = \"herschel-bulkley\"\nconsistency = 3\nindex = 0.4\nyield_stress = 7\nrest_viscosity = 1e4\n",
        "rheology = \"power-law\"\nconsistency = 3\nindex = 1.4\n",
        "rheology = \"carreau\"\nviscosity = 3\nindex = 0.4\nrelaxation_time = 0.1\n"}) {
    expect_round_trip(required_keys + mud + "[[liquid]]\nname = \"mud\"\ndensity = 1234.5\n" + law);
  }
}

TEST(EffectiveCase, WithPorousLayersReadsBack) {
  expect_round_trip(
      "parameters.H = 0.6\n" + required_keys + water +
      "[[porous]]\nmin = [0, 0]\nmax = [\"H\", 1]\nporosity = 0.4\ngrain_size = \"dx/3\"\n"
      "[[porous]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 0], [0, 1]]\nporosity = 0.4\nresistance = "
      "\"coefficients\"\nquadratic = 3\nadded_mass = 0\n"
      "[[porous]]\nmin = [0, 0]\nmax = [1, 1]\nporosity = 0.5\nresistance = \"ergun\"\ngrain_size = 0.1\n");
}

TEST(EffectiveCase, InThreeDimensionsReadsBack) {
  expect_round_trip("case.dimension = 3\n" + required_keys +
                    "[domain]\nperiodic_z = [0, 1]\n[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n"
                    "[[wall]]\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [2, 1, 1]\nopen = [\"+z\"]\n"
                    "[[probe]]\nname = \"a\"\ntype = \"depth\"\nat = [0.5, 0.5, 0]\n");
}

TEST(EffectiveCase, OfAProbeWithAndWithoutARegionIsReadAgain) {
  const std::string force = "[[probe]]\nname = \"f\"\ntype = \"force\"\nmoment_about = [0, 0]\n";
  const std::string map = "[[probe]]\nname = \"m\"\ntype = \"pressure-map\"\n";
  for (const std::string region : {"", "walls = [\"bed\"]\n", "region_min = [0, 0]\nregion_max = [1, 1]\n"}) {
    expect_round_trip(required_keys + water + force + region + map + region);
  }
}

TEST(EffectiveCase, OfEnclosedAirIsReadAgain) {
  expect_round_trip(required_keys + "[air]\npockets = \"adiabatic\"\n" + water +
                    "[[pocket]]\nat = [0, 1]\noverpressure = -500\n[[vent]]\nat = [0, 1]\narea = 1e-4\nloss = 1.5\n"
                    "[[vent]]\nat = [1, 1]\narea = 1e-4\n[[probe]]\nname = \"a\"\ntype = \"pockets\"\n");
}

TEST(EffectiveCase, OfAStudyHasTheKeysThatItsSchemeUses) {
  for (const std::string scheme : {"farzin2014", "farmani2020"}) {
    expect_round_trip(required_keys + "[scheme]\nname = \"" + scheme + "\"\n[study]\nshifting = 0\n" + water);
  }
}

TEST(EffectiveCase, SaysUnitAndMeaning) {
  const std::string written = effective_case(read_text(required_keys + water));
  EXPECT_NE(written.find("spacing = 0.1  # m: Distance dx between"), std::string::npos) << written;
}

TEST(TomlFloat, IsNeverAnInteger) {
  EXPECT_EQ(toml_float(1.0), "1.0");
  EXPECT_EQ(toml_float(-0.0), "-0.0");
  EXPECT_EQ(toml_float(1e300), "1e+300");
  EXPECT_EQ(toml_float(0.1), "0.1");
}

/// Doubles of all sizes survive the way through a file with the same bits.
TEST(EffectiveCase, KeepsEveryBit) {
  std::uint64_t bits = 0x9e3779b97f4a7c15;
  CaseSpec spec = read_text(required_keys + water);
  while (spec.parameters.size() < 500) {
    bits = bits * 6364136223846793005u + 1442695040888963407u;
    const double value = std::bit_cast<double>(bits);
    if (std::isfinite(value)) {
      spec.parameters.push_back({fmt::format("p{}", 1000 + spec.parameters.size()), value});
    }
  }
  const CaseSpec again = read_text(effective_case(spec));
  ASSERT_EQ(again.parameters.size(), spec.parameters.size());
  for (std::size_t i = 0; i < spec.parameters.size(); ++i) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(again.parameters[i].value),
              std::bit_cast<std::uint64_t>(spec.parameters[i].value))
        << spec.parameters[i].value;
  }
}

}  // namespace
}  // namespace tailwater
