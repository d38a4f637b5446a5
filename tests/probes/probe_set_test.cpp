#include "probes/probe_set.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "io/temporary_folder.h"
#include "probes/tank.h"

namespace tailwater {
namespace {

ProbeTable named(const std::string& name, ProbeTable probe) {
  probe.name = name;
  return probe;
}

ProbeTable of_type(ProbeType type) {
  ProbeTable probe;
  probe.type = type;
  return probe;
}

std::vector<std::string> lines_of(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

using Lines = std::vector<std::string>;

TEST(ProbeSet, WritesOneFilePerProbeWithItsColumns) {
  using T = Tank<2>;
  T tank = T::filled(0.5);
  ProbeTable profile = probe_along(ProbeType::profile, {0.0, 0.0}, {1.0, 0.0});
  profile.times = {0.0};
  tank.spec.probes = {named("depth", probe_at(ProbeType::depth, {0.5, 0.0})),
                      named("wall", probe_at(ProbeType::wall_pressure, {1.0, 0.1})),
                      named("mean", probe_along(ProbeType::wall_pressure_mean, {1.0, 0.1}, {1.0, 0.2})),
                      named("front", of_type(ProbeType::front)),
                      named("profile", profile),
                      named("p", probe_at(ProbeType::pressure, {0.5, 0.1})),
                      named("u", probe_at(ProbeType::velocity, {0.5, 0.1})),
                      named("energy", of_type(ProbeType::energy)),
                      named("volume", of_type(ProbeType::volume)),
                      named("air", of_type(ProbeType::pockets))};
  tank.spec.air.pockets = AirPockets::isothermal;
  const TemporaryFolder temporary;
  const RunFolder folder = RunFolder::create(temporary.path(), false);
  ProbeSet<2> probes(make_probes<2>(tank.spec, tank.boundary), folder);
  ProbeContext<2> context = tank.context();
  context.totals = {1.5, -2.0, 0.25, 0.5, 0.125};
  context.totals.air = {1e4, 0.5, 0.75, -0.25, 8.0, 2.0};
  probes.record(context);

  const std::vector<std::pair<std::string, std::string>> headers{{"depth", "time_s,connected_m,highest_m,wet_m"},
                                                                 {"wall", "time_s,pressure_Pa,impulse_Pa_s"},
                                                                 {"mean", "time_s,pressure_Pa,wet_share,impulse_Pa_s"},
                                                                 {"front", "time_s,front_m,front_connected_m"},
                                                                 {"p", "time_s,pressure_Pa,wet"},
                                                                 {"u", "time_s,u_m_s,v_m_s,wet"}};
  for (const auto& [name, header] : headers) {
    const Lines lines = lines_of(folder.probe(name));
    ASSERT_EQ(lines.size(), 2u) << name;
    EXPECT_EQ(lines[0], header);
  }
  EXPECT_EQ(lines_of(folder.probe("profile"))[0], "time_s,x_m,bed_m,connected_m,highest_m");
  EXPECT_EQ(lines_of(folder.probe("profile")).size(), 21u);
  EXPECT_EQ(lines_of(folder.probe("energy")), (Lines{"time_s,kinetic_J,potential_J,total_J", "0,1.5,-2,-0.5"}));
  EXPECT_EQ(lines_of(folder.probe("volume")),
            (Lines{"time_s,particles,density_error_mean,density_error_rms,volume_out_m3,volume_in_m3",
                   "0,200,0.25,0.5,0.125,0"}));
  EXPECT_EQ(lines_of(folder.probe("air")),
            (Lines{"time_s,pressure_Pa,volume_m3,gas_m3,vented_m3,energy_J,pockets", "0,10000,0.5,0.75,-0.25,8,2"}));
}

TEST(ProbeSet, WritesAtEveryStepAtIntervalsOrAtTimes) {
  using T = Tank<2>;
  T tank = T::filled(0.5);
  ProbeTable each = named("each", of_type(ProbeType::volume));
  ProbeTable spaced = named("spaced", of_type(ProbeType::volume));
  spaced.interval = 0.1;
  ProbeTable timed = named("timed", of_type(ProbeType::volume));
  timed.times = {0.5, 0.125, 9.0};
  tank.spec.probes = {each, spaced, timed};
  const TemporaryFolder temporary;
  const RunFolder folder = RunFolder::create(temporary.path(), false);
  ProbeSet<2> probes(make_probes<2>(tank.spec, tank.boundary), folder);
  // 0.3 is 3 x 0.1 only up to rounding and must not come twice; 0.75 passes several intervals at once.
  const std::vector<double> times{0.0, 0.0625, 0.125, 0.1875, 0.25, 0.3, 0.3125, 0.75, 0.8125};
  for (const double time : times) probes.record(tank.context(time));
  const auto times_in = [&](const std::string& name) {
    std::vector<double> result;
    const Lines lines = lines_of(folder.probe(name));
    for (std::size_t k = 1; k < lines.size(); ++k) result.push_back(std::stod(lines[k]));
    return result;
  };
  EXPECT_EQ(times_in("each"), times);
  EXPECT_EQ(times_in("spaced").size(), 6u);
  EXPECT_EQ(times_in("timed"), (std::vector<double>{0.125, 0.75}));
}

TEST(ProbeSet, IsDueOnlyWhenAProbeIs) {
  using T = Tank<2>;
  T tank = T::filled(0.5);
  ProbeTable timed = named("timed", of_type(ProbeType::volume));
  timed.times = {0.5};
  tank.spec.probes = {timed};
  const TemporaryFolder temporary;
  ProbeSet<2> probes(make_probes<2>(tank.spec, tank.boundary), RunFolder::create(temporary.path(), false));
  EXPECT_FALSE(probes.is_due(0.4));
  EXPECT_TRUE(probes.is_due(0.6));
  probes.record(tank.context(0.6));
  EXPECT_FALSE(probes.is_due(0.7));
}

// A pressure that lasts for one step, between two lines of a table, is in its impulse.
TEST(ProbeSet, ImpulsesHaveTheStepsBetweenTwoLines) {
  using T = Tank<2>;
  T tank = T::filled(0.5);
  ProbeTable each = named("each", probe_at(ProbeType::wall_pressure, {1.0, 0.1}));
  ProbeTable spaced = named("spaced", probe_along(ProbeType::wall_pressure_mean, {1.0, 0.05}, {1.0, 0.15}));
  spaced.interval = 0.5;
  tank.spec.probes = {each, spaced};
  const TemporaryFolder temporary;
  const RunFolder folder = RunFolder::create(temporary.path(), false);
  ProbeSet<2> probes(make_probes<2>(tank.spec, tank.boundary), folder);
  const double calm = T::rho * T::g * 0.4;
  const double blow = 7000.0;
  for (const double time : {0.0, 0.125, 0.25, 0.5, 0.625}) {
    T now = tank;
    if (time == 0.25) {
      for (double& pressure : now.particles.pressure) pressure += blow;
    }
    EXPECT_TRUE(probes.is_due(time));
    probes.record(now.context(time));
  }
  const auto impulses = [&](const std::string& name) {
    std::vector<double> last;
    const Lines lines = lines_of(folder.probe(name));
    for (std::size_t k = 1; k < lines.size(); ++k) last.push_back(std::stod(lines[k].substr(lines[k].rfind(',') + 1)));
    return last;
  };
  const double at_half = 0.5 * calm + 0.125 * blow;
  const std::vector<double> of_each{0.0, 0.125 * calm, 0.25 * calm + 0.125 * blow, at_half, at_half + 0.125 * calm};
  const double rounding = 1e-12 * at_half;
  ASSERT_EQ(impulses("each").size(), of_each.size());
  for (std::size_t k = 0; k < of_each.size(); ++k) EXPECT_NEAR(impulses("each")[k], of_each[k], rounding) << k;
  ASSERT_EQ(impulses("spaced").size(), 2u);
  EXPECT_NEAR(impulses("spaced")[1], at_half, rounding);
}

TEST(ProbeSet, RefusesProbesThatCannotMeasure) {
  using T = Tank<2>;
  const T tank = T::filled(0.5);
  const auto message = [&](const std::vector<ProbeTable>& probes) {
    CaseSpec spec = tank.spec;
    spec.probes = probes;
    return message_of<InputError>([&] { make_probes<2>(spec, tank.boundary); });
  };
  EXPECT_NE(message({named("flat", probe_at(ProbeType::pressure, {0.5, 0.5, 0.5}))}).find("'flat'"), std::string::npos);
  EXPECT_NE(message({named("air", of_type(ProbeType::pockets))}).find("pockets = \"adiabatic\" in [air]"),
            std::string::npos);
}

}  // namespace
}  // namespace tailwater
