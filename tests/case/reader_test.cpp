#include "case/reader.h"

#include <gtest/gtest.h>

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
      "[domain]\nperiodic_x = [0, 4]\n[output]\nfields = [\"id\", \"pressure\"]\n[scheme]\nkernel = \"cubic-spline\"\n"
      "[[fluid]]\nname = \"drop\"\nshape = \"polygon\"\npoints = [[0, 0], [2, 0], [1, 1.5]]\nvelocity = [3, 0]\n"
      "[[wall]]\nshape = \"box\"\nmin = [0, 0]\nmax = [4, 4]\nopen = [\"+y\"]\nslip = \"partial\"\nfriction = 0.25\n"
      "[[probe]]\nname = \"shape\"\ntype = \"profile\"\nfrom = [0, 0]\nto = [4, 0]\ntimes = [0.5, 1]\n");
  EXPECT_EQ(spec.general.title, "Drop");
  EXPECT_EQ(spec.particles.spacing, 1.0);
  EXPECT_EQ(spec.particles.seed, 7);
  EXPECT_EQ(spec.time.end, 2.5);
  EXPECT_EQ(spec.domain.periodic_x, (std::vector<double>{0.0, 4.0}));
  EXPECT_EQ(spec.output.fields, (std::vector<std::string>{"id", "pressure"}));
  EXPECT_EQ(spec.scheme.kernel, KernelName::cubic_spline);
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

TEST(Reader, KeepsTheVelocityThatVariesAsItIsWritten) {
  const CaseSpec spec = read_text("parameters.U = 2\n" + required_keys +
                                  "[[fluid]]\nmin = [0, 0]\nmax = [1, 1]\nvelocity = [\"U*sin(pi*x)\", \"U/dx\"]\n");
  EXPECT_EQ(spec.fluid[0].velocity, (VectorField{"U*sin(pi*x)", 2.0 / spec.particles.spacing}));
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

TEST(Formulation, PublishedChangesDefaultsOnly) {
  const SchemeTable scheme =
      read_text(required_keys + "[scheme]\nkernel = \"cubic-spline\"\nformulation = \"published\"\ncourant = 0.5\n" +
                water)
          .scheme;
  SchemeTable expected{.formulation = Formulation::published};
  expected.kernel = KernelName::cubic_spline;
  expected.laplacian = LaplacianKind::consistent;
  expected.gradient = GradientKind::consistent;
  expected.divergence = DivergenceKind::consistent;
  expected.pair_vectors = PairVectors::kernel;
  expected.source = SourceKind::velocity_divergence;
  expected.surface = SurfaceTreatment::cone;
  expected.walls = WallTreatment::pressure_rows;
  expected.divergence_free = DivergenceFree::start;
  expected.displacement = Displacement::mean_velocity;
  expected.courant = 0.5;
  expected.artificial_viscosity = 0.20;
  expected.viscosity_floor = 0.0;
  expected.noise_viscosity = 0.0;
  expected.smagorinsky = 0.10;
  expected.turbulence = Turbulence::none;
  expected.shifting = ShiftingKind::farzin;
  expected.shifting_strength = 0.10;
  expected.shifting_cap = 0.05;
  expected.implicit_form = ImplicitForm::repeated;
  expected.max_passes = 30;
  expected.relax_pressure = 0.4;
  expected.relax_velocity = 0.3;
  expected.relax_position = 0.4;
  EXPECT_EQ(scheme, expected);
}

TEST(Formulation, PublishedDependsOnTheIntegrator) {
  const SchemeTable scheme =
      read_text(required_keys + water, {"scheme.formulation=published", "scheme.integrator=implicit"}).scheme;
  EXPECT_EQ(scheme.kernel, KernelName::farzin);
  EXPECT_EQ(scheme.courant, 0.12);
  EXPECT_EQ(scheme.shifting_strength, 0.08);
}

TEST(Formulation, DependsOnTheSchemesName) {
  const SchemeTable robust = read_text(required_keys + water, {"scheme.name=farmani2020"}).scheme;
  EXPECT_EQ(robust.source, SourceKind::mixed);
  EXPECT_EQ(robust.kernel, KernelName::wendland_c2);
  const SchemeTable published =
      read_text(required_keys + water, {"scheme.name=farmani2020", "scheme.formulation=published"}).scheme;
  EXPECT_EQ(published.kernel, KernelName::cubic_spline);
  EXPECT_EQ(published.support, 2.0 * 1.2);  // h = 1.2 dx
  EXPECT_EQ(published.source, SourceKind::density);
  EXPECT_EQ(published.courant, 0.1);
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

}  // namespace
}  // namespace tailwater
