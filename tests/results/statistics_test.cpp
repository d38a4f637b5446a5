#include "results/statistics.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace tailwater {
namespace {

FlowMeasures with_energy(double kinetic, double potential) {
  FlowMeasures measures;
  measures.kinetic_energy = kinetic;
  measures.potential_energy = potential;
  return measures;
}

StepReport step_of(double dt, int passes, int iterations) {
  StepReport report;
  report.dt = dt;
  report.passes = passes;
  report.iterations = iterations;
  return report;
}

TEST(RunStatistics, AddUpSteps) {
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  statistics.add(step_of(0.3, 1, 4), with_energy(1.0, 8.0), 0);
  statistics.add(step_of(0.1, 3, 20), with_energy(1.0, 6.0), 5);
  statistics.add(step_of(0.2, 2, 6), with_energy(3.0, 5.5), 2);
  const auto json = statistics.json(98, 100);
  EXPECT_EQ(json["steps"]["count"], 3);
  EXPECT_DOUBLE_EQ(json["steps"]["dt_mean_s"].get<double>(), 0.2);
  EXPECT_EQ(json["steps"]["dt_least_s"], 0.1);
  EXPECT_EQ(json["steps"]["dt_largest_s"], 0.3);
  EXPECT_EQ(json["pressure_solver"]["solves"], 6);
  EXPECT_DOUBLE_EQ(json["pressure_solver"]["passes_per_step"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(json["pressure_solver"]["iterations_per_solve"].get<double>(), 5.0);
  // Energies 10, 9, 7, 8.5: the largest rise is from 7, not from the start.
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_J"].get<double>(), 1.5);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_over_start"].get<double>(), 0.15);
  EXPECT_EQ(json["energy"]["largest_rise_less_density_work_over_start"], json["energy"]["largest_rise_over_start"]);
  EXPECT_EQ(json["volume"]["outside_the_walls_most"], 5);
  EXPECT_EQ(json["volume"]["outside_the_walls_end"], 2);
  EXPECT_EQ(json["volume"]["fluid_particles_start"], 100);
  EXPECT_EQ(json["volume"]["fluid_particles_end"], 98);
}

// A tide that ended where it began had no work left, and an old rise of the energy was held against it.
TEST(RunStatistics, KeepTheLargestWorkOfATide) {
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  StepReport report = step_of(0.1, 1, 1);
  for (const double work : {3.0, 1.0, -4.0}) {
    report.work.ends = work;
    report.work.walls = -work;
    statistics.add(report, with_energy(0.0, 10.0), 0);
  }
  EXPECT_EQ(statistics.largest_work_of_ends(), 4.0);
  EXPECT_EQ(statistics.largest_work_of_walls(), 4.0);
}

TEST(RunStatistics, KeepEnergyThatTheDensitySourceBringsApart) {
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  StepReport report = step_of(0.1, 1, 1);
  report.work.density = 1.5;
  statistics.add(report, with_energy(0.0, 11.0), 0);  // 1 of the 1.5 arrives, the rest is dissipated
  report.work.density = 0.25;
  statistics.add(report, with_energy(0.0, 12.0), 0);  // 0.75 more than the source explains
  const auto json = statistics.json(1, 1);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_J"].get<double>(), 2.0);
  EXPECT_DOUBLE_EQ(json["energy"]["density_work_J"].get<double>(), 1.75);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_less_density_work_over_start"].get<double>(), 0.075);
}

TEST(RunStatistics, WhatMovingWallsBringIsNoRise) {
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  StepReport report = step_of(0.1, 1, 1);
  report.work.walls = 2.0;
  report.work.viscous = -0.5;
  report.density_share = 0.5;
  statistics.add(report, with_energy(0.0, 11.5), 0);
  report.work.walls = 0.0;
  report.work.viscous = 0.25;  // dragged along
  report.density_share = 1.0;
  statistics.add(report, with_energy(0.0, 12.0), 0);
  const auto json = statistics.json(1, 1);
  EXPECT_DOUBLE_EQ(json["energy"]["brought_by_walls_J"].get<double>(), 2.25);
  EXPECT_DOUBLE_EQ(json["energy"]["viscous_work_J"].get<double>(), -0.25);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_J"].get<double>(), 0.25);  // 10, 9.5, 9.75
  EXPECT_DOUBLE_EQ(json["energy"]["density_share_mean"].get<double>(), 0.75);
}

TEST(RunStatistics, WhatASlopeWithoutEndBringsIsNoRise) {
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  StepReport report = step_of(0.1, 1, 1);
  report.work.slope = 3.0;
  statistics.add(report, with_energy(2.5, 10.0), 0);  // friction took half a joule
  report.work.slope = 0.0;
  statistics.add(report, with_energy(2.75, 10.0), 0);
  const auto json = statistics.json(1, 1);
  EXPECT_DOUBLE_EQ(json["energy"]["brought_by_slope_J"].get<double>(), 3.0);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_J"].get<double>(), 0.25);
}

TEST(RunStatistics, EnergyThatLeftIsNeitherLostNorGained) {
  FlowMeasures later = with_energy(1.0, 5.0);
  later.departed.energy = 4.0;
  FlowMeasures last = with_energy(0.0, 0.0);
  last.departed.energy = 10.5;
  RunStatistics statistics(with_energy(0.0, 10.0), 10.0);
  statistics.add(step_of(0.1, 1, 1), later, 0);
  statistics.add(step_of(0.1, 1, 1), last, 0);
  const auto json = statistics.json(0, 100);
  EXPECT_DOUBLE_EQ(json["energy"]["out_J"].get<double>(), 10.5);
  EXPECT_DOUBLE_EQ(json["energy"]["largest_rise_J"].get<double>(), 0.5);
}

TEST(RunStatistics, DivideByNothingWithoutSteps) {
  const auto json = RunStatistics(with_energy(0.0, 0.0), 1.0).json(0, 0);
  EXPECT_EQ(json["steps"]["count"], 0);
  EXPECT_EQ(json["steps"]["dt_mean_s"], 0.0);
  EXPECT_EQ(json["energy"]["largest_rise_over_start"], 0.0);
}

TEST(RunStatistics, CountInterventionsPerParticleAndStep) {
  RunStatistics statistics(with_energy(0.0, 1.0), 1.0);
  StepReport report = step_of(0.1, 1, 1);
  report.interventions = {.stopped_at_walls = 3, .capped_shifts = 1, .fallback_rows = 2, .restarted_solves = 1};
  statistics.add(report, with_energy(0.0, 1.0), 0);
  statistics.add(report, with_energy(0.0, 1.0), 0);
  const auto json = statistics.json(10, 10);
  EXPECT_EQ(json["interventions"]["stopped_at_walls"], 6);
  EXPECT_EQ(json["interventions"]["fallback_rows"], 4);
  EXPECT_EQ(json["interventions"]["restarted_solves"], 2);
  EXPECT_DOUBLE_EQ(json["interventions"]["stopped_and_capped_per_particle_step"].get<double>(), 8.0 / 20.0);
}

}  // namespace
}  // namespace tailwater
