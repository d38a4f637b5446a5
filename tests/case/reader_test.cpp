#include "case/reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "case/formulation.h"
#include "case_file.h"

namespace tailwater {
namespace {

TEST(Reader, GivesDefaultsForAllThatIsAbsent) {
  CaseSpec expected;
  expected.particles.spacing = 0.1;
  expected.time.end = 1.0;
  FluidTable& block = expected.fluid.emplace_back();
  block.name = "fluid1";
  block.min = block.rotate = block.translate = {0.0, 0.0};
  block.max = {1.0, 1.0};
  block.velocity = {0.0, 0.0};
  EXPECT_EQ(read_text(required_keys + water), expected);
}

TEST(Reader, ReadsEveryKindOfValue) {
  const CaseSpec spec = read_text(
      "[case]\ntitle = \"Drop\"\n[particles]\nspacing = 1\nseed = 7\n[time]\nend = 2.5\n"
      "[domain]\nperiodic_x = [0, 4]\n[output]\nfields = [\"id\", \"pressure\"]\n[scheme]\npair_vectors = \"kernel\"\n"
      "[[fluid]]\nname = \"drop\"\nshape = \"polygon\"\npoints = [[0, 0], [2, 0], [1, 1.5]]\nvelocity = [3, 0]\n"
      "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [4, 4]\nopen = [\"+y\"]\nslip = \"partial\"\nfriction = 0.25\n"
      "[[probe]]\nname = \"shape\"\ntype = \"profile\"\nfrom = [0, 0]\nto = [4, 0]\ntimes = [0.5, 1]\n");
  EXPECT_EQ(spec.general.title, "Drop");
  EXPECT_EQ(spec.particles.spacing, 1.0);
  EXPECT_EQ(spec.particles.seed, 7);
  EXPECT_EQ(spec.time.end, 2.5);
  EXPECT_EQ(spec.domain.periodic_x, (std::vector<double>{0.0, 4.0}));
  EXPECT_EQ(spec.output.fields, (std::vector<std::string>{"id", "pressure"}));
  EXPECT_EQ(spec.scheme.pair_vectors, PairVectors::kernel);
  EXPECT_EQ(spec.fluid[0].name, "drop");
  EXPECT_EQ(spec.fluid[0].points, (std::vector<Coordinates>{{0.0, 0.0}, {2.0, 0.0}, {1.0, 1.5}}));
  EXPECT_EQ(spec.fluid[0].velocity, (VectorField{3.0, 0.0}));
  EXPECT_EQ(spec.walls[0].name, "wall1");
  EXPECT_EQ(spec.walls[0].open, (std::vector<std::string>{"+y"}));
  EXPECT_EQ(spec.walls[0].slip, Slip::partial);
  EXPECT_EQ(spec.walls[0].friction, 0.25);
  EXPECT_EQ(spec.walls[0].fluid_side, FluidSide::inside);
  EXPECT_EQ(spec.probes[0].type, ProbeType::profile);
  EXPECT_EQ(spec.probes[0].times, (std::vector<double>{0.5, 1.0}));
}

TEST(Reader, TakesANameForAListOfOne) {
  const CaseSpec spec = read_text(required_keys + water + "[output]\nfields = \"id\"\n");
  EXPECT_EQ(spec.output.fields, (std::vector<std::string>{"id"}));
}

TEST(Reader, KeepsTheVelocityThatVariesAsItIsWritten) {
  const CaseSpec spec = read_text("parameters.U = 2\n" + required_keys +
                                  "[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\nvelocity = [\"U*sin(pi*x)\", \"U/dx\"]\n");
  EXPECT_EQ(spec.fluid[0].velocity, (VectorField{"U*sin(pi*x)", 2.0 / spec.particles.spacing}));
}

TEST(Reader, ParametersSpacingAndGravityUseOneAnother) {
  const CaseSpec spec = read_text(
      "[parameters]\nc = \"sqrt(g*H)\"\nH = 0.4\nrows = \"H/dx\"\nS = 0.75\n"
      "[particles]\nspacing = \"H/(g/0.5)\"\n"
      "[physics]\ngravity = [\"S*10\", -10]\n"
      "[time]\nend = \"c\"\n"
      "[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\n");
  EXPECT_EQ(spec.particles.spacing, 0.4 / 25.0);
  EXPECT_EQ(spec.parameters, (std::vector<Parameter>{{"H", 0.4}, {"S", 0.75}, {"c", std::sqrt(5.0)}, {"rows", 25.0}}));
}

TEST(Reader, EvaluatesExpressionsWhereverANumberMayStand) {
  const CaseSpec spec = read_text(
      "[parameters]\nL = \"2*H\"\nH = 0.5\n"  // L before H in the file and after it in the alphabet
      "[particles]\nspacing = \"H/4\"\nseed = \"3+4\"\n"
      "[physics]\ngravity = [0, \"-8*H\"]\nviscosity = \"g*dx\"\n"
      "[time]\nend = \"sqrt(g)*L\"\n"
      "[[fluid]]\nmin = [0, \"dx\"]\nmax = [\"L\", \"L+H\"]\n"
      "[[wall]]\npoints = [[0, \"-H\"], [\"L\", 0]]\n");
  EXPECT_EQ(spec.parameters, (std::vector<Parameter>{{"H", 0.5}, {"L", 1.0}}));
  EXPECT_EQ(spec.particles.spacing, 0.125);
  EXPECT_EQ(spec.particles.seed, 7);
  EXPECT_EQ(spec.physics.gravity, (Coordinates{0.0, -4.0}));
  EXPECT_EQ(spec.physics.viscosity, 0.5);
  EXPECT_EQ(spec.time.end, 2.0);
  EXPECT_EQ(spec.fluid[0].min, (Coordinates{0.0, 0.125}));
  EXPECT_EQ(spec.fluid[0].max, (Coordinates{1.0, 1.5}));
  EXPECT_EQ(spec.walls[0].points, (std::vector<Coordinates>{{0.0, -0.5}, {1.0, 0.0}}));
}

TEST(Reader, FillsInWhatDependsOnTheDimension) {
  const CaseSpec spec =
      read_text("case.dimension = 3\n" + required_keys +
                "[[fluid]]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[[probe]]\nname = \"f\"\ntype = \"front\"\n");
  EXPECT_EQ(spec.physics.gravity, (Coordinates{0.0, 0.0, -9.81}));
  EXPECT_EQ(spec.fluid[0].velocity, (VectorField{0.0, 0.0, 0.0}));
  EXPECT_EQ(spec.probes[0].direction, (Coordinates{1.0, 0.0, 0.0}));
}

TEST(Reader, ReadsOutlets) {
  const CaseSpec spec = read_text(required_keys + water +
                                  "[[outlet]]\nfrom = [1, 0]\nto = [1, \"2*dx\"]\n"
                                  "[[outlet]]\nname = \"left\"\nfrom = [0, 0]\nto = [0, 1]\ndirection = [-1, 0]\n");
  EXPECT_EQ(spec.outlets[0].name, "outlet1");
  EXPECT_EQ(spec.outlets[0].to, (Coordinates{1.0, 2.0 * spec.particles.spacing}));
  EXPECT_EQ(spec.outlets[0].direction, (Coordinates{1.0, 0.0}));
  EXPECT_EQ(spec.outlets[1].name, "left");
  EXPECT_EQ(spec.outlets[1].direction, (Coordinates{-1.0, 0.0}));
}

TEST(Reader, NumbersNamelessBlocksAndWallsByTheirPlace) {
  const CaseSpec spec = read_text(required_keys + water + "[[fluid]]\nname = \"b\"\nmin = [2, 0]\nmax = [3, 1]\n" +
                                  "[[fluid]]\nmin = [4, 0]\nmax = [5, 1]\n[[wall]]\npoints = [[0, 0], [1, 0]]\n");
  EXPECT_EQ(spec.fluid[0].name, "fluid1");
  EXPECT_EQ(spec.fluid[1].name, "b");
  EXPECT_EQ(spec.fluid[2].name, "fluid3");
  EXPECT_EQ(spec.walls[0].name, "wall1");
  EXPECT_EQ(spec.walls[0].fluid_side, FluidSide::left);
}

TEST(Formulation, DecidesTheCourantNumberUnlessItIsGiven) {
  const auto courant = [](const std::vector<std::string>& settings) {
    return read_text(required_keys + water, settings).scheme.courant;
  };
  const std::string published = "scheme.formulation=published";
  const std::string two_step = "scheme.name=farmani2020";
  EXPECT_EQ(courant({}), 0.55);
  EXPECT_EQ(courant({published}), 0.05);
  EXPECT_EQ(courant({published, "scheme.integrator=implicit"}), 0.12);
  EXPECT_EQ(courant({two_step}), 0.25);
  EXPECT_EQ(courant({two_step, published}), 0.1);
  EXPECT_EQ(courant({published, "scheme.courant=0.5"}), 0.5);
}

TEST(Formulation, SaysWhereWallsStandAndHowFarTheKernelReaches) {
  const auto traits = [](const std::vector<std::string>& settings) {
    return traits_of(read_text(required_keys + water, settings));
  };
  const std::string published = "scheme.formulation=published";
  const std::string two_step = "scheme.name=farmani2020";
  EXPECT_EQ(traits({}).support, 3.0);
  EXPECT_EQ(traits({"study.support=4"}).support, 4.0);
  EXPECT_FALSE(traits({}).walls.on_wall);
  EXPECT_TRUE(traits({published}).walls.on_wall);
  EXPECT_FALSE(traits({published}).walls.behind);
  EXPECT_EQ(traits({two_step, published}).support, 2.0 * 1.2);  // h = 1.2 dx
  EXPECT_TRUE(traits({two_step, published}).walls.behind);
  EXPECT_EQ(traits({}).no_floating, "");
  EXPECT_NE(traits({"study.displacement=mean-velocity"}).no_floating, "");
  EXPECT_NE(traits({two_step}).no_floating, "");
  EXPECT_NE(traits({published}).no_reaction, "");
}

TEST(Formulation, RobustIsTheStructsOwnDefaults) {
  SchemeTable scheme;
  apply_formulation(scheme);
  EXPECT_EQ(scheme, SchemeTable{});
}

TEST(Formulation, RobustIsTheSameForBothIntegrators) {
  SchemeTable scheme{.integrator = Integrator::implicit_projection};
  const SchemeTable expected = scheme;
  apply_formulation(scheme);
  EXPECT_EQ(scheme, expected);
}

TEST(Reader, SaysThatAFileCannotBeRead) {
  try {
    read_case("/nowhere/case.toml");
    FAIL();
  } catch (const IoError& error) {
    EXPECT_NE(std::string(error.what()).find("/nowhere/case.toml"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("No such file"), std::string::npos) << error.what();
  }
  EXPECT_THROW(read_case(std::filesystem::temp_directory_path()), IoError);
}

TEST(CaseReader, LocatesFindingsByTableNameAndKey) {
  const std::string text = required_keys + water + "[[wall]]\npoints = [[0, 1], [1, 1]]\n" +
                           "[[wall]]\nname = \"bed\"\npoints = [[0, 0],\n [1, 0]]\n# the end\n";
  const CaseSpec spec = read_case_text(text, "case.toml", {"time.end=2"});
  const auto position_of = [&](const CaseLabel& label) {
    const Findings found =
        spec.sources.located({Finding::error("label-wrong", {"{} is wrong", label}, {"correct it"})});
    return found[0].position.text() + (found[0].about.index ? fmt::format(" [{}]", *found[0].about.index) : "");
  };
  const CaseLabel bed("wall", "bed");
  EXPECT_EQ(position_of(bed.with_key("points")), "case.toml:10:10 [1]");
  EXPECT_EQ(position_of(bed.with_key("slip")), "case.toml:8:1 [1]") << "that of the table, which does not have the key";
  EXPECT_EQ(position_of(CaseLabel("wall", "wall1")), "case.toml:6:1 [0]") << "the name that it has by default";
  EXPECT_EQ(position_of(CaseLabel("particles").with_key("spacing")), "case.toml:1:21");
  EXPECT_EQ(position_of(CaseLabel("time").with_key("end")), "--set time.end=2");
  EXPECT_EQ(position_of(CaseLabel("vent", "bed")), "") << "there is none";
  EXPECT_EQ(spec.sources.lines(bed), (std::array{8, 11}));
}

TEST(CaseReader, ReportsFindingsWithTableIndexAndKey) {
  try {
    read_text(required_keys + water + "[[wall]]\npoints = [[0, 1], [1, 1]]\n[[wall]]\npoints = [[0, 0], [1]]\n");
    FAIL() << "the case is wrong";
  } catch (const CaseError& error) {
    const Finding& finding = error.findings().at(0);
    EXPECT_EQ(finding.about.table, "wall");
    EXPECT_EQ(finding.about.index, 1);
    EXPECT_EQ(finding.about.key, "points");
    EXPECT_EQ(finding.position.line, 9);
    EXPECT_EQ(finding.position.column, 19);
    EXPECT_EQ(finding.position.end_column, 22);
  }
}

}  // namespace
}  // namespace tailwater
