// The flow on which all benchmarks of modules run, and their timing.
#pragma once

#include <benchmark/benchmark.h>
#include <malloc.h>

#include <cstdint>
#include <ctime>
#include <functional>
#include <string>
#include <utility>

#include "neighbours/decomposition.h"
#include "pressure/stages.h"
#include "published/make_flow.h"
#include "schemes/advance.h"

namespace tailwater {

inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Bytes that this process holds on the heap, PETSc's included.
inline double bytes_on_heap() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

/// Registers `work`, timed by CPU time: other programs on the machine disturb it less than a clock. `prepare` comes
/// before each and is not timed. `counters` are read after the last.
inline void add_benchmark(const std::string& name, std::function<void()> work, std::function<void()> prepare = {},
                          std::function<void(benchmark::UserCounters&)> counters = {}) {
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) {
                                 for ([[maybe_unused]] auto _ : state) {
                                   if (prepare) prepare();
                                   const double begin = cpu_seconds();
                                   work();
                                   benchmark::ClobberMemory();
                                   state.SetIterationTime(cpu_seconds() - begin);
                                 }
                                 if (counters) counters(state.counters);
                               })
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

constexpr int steps_between_sorts = 10;  // as a run has them

/// A flow after some steps, with everything that the verbs of the next step hand to each other.
template <int Dim>
struct Stage {
  Stage(const CaseSpec& spec, int steps) : flow(make_flow<Dim>(spec)) {
    locate(flow);
    tailwater::start(flow);
    for (int n = 0; n < steps; ++n) step();
    repartition(flow);
    dt = next_time_step(flow);
    gather_walls(flow);
    assign_roles(flow);
    for (const auto& part : flow.parts) part->begin_step(flow, dt);
    begin = save_step_start(flow);
    drive = drive_walls(flow, begin.wall_velocity, dt);
    locate(flow);
    predicted = predict(flow, begin, drive, dt);
    target = target_divergence(flow, std::move(predicted.velocity_gradient), dt);
    pose();
  }

  StepReport step() {
    if (flow.state.step % steps_between_sorts == 0) repartition(flow);
    return advance(flow, next_time_step(flow));
  }

  /// The pressure equation of the next step.
  void pose() { equation = assemble(flow, predicted, target, drive, dt); }

  std::size_t fluid() const {
    const Particles<Dim>& particles = flow.state.particles;
    return std::count(particles.kind.begin(), particles.kind.begin() + static_cast<std::ptrdiff_t>(particles.owned),
                      ParticleKind::fluid);
  }

  Flow<Dim> flow;
  double dt = 0.0;
  StepStart<Dim> begin;
  WallDrive<Dim> drive;
  Prediction<Dim> predicted;
  std::vector<double> target;
  PosedEquation equation;
};

/// Neighbours, operators, closures, assembly and output. The stage outlives the benchmarks.
template <int Dim>
void add_passes(Stage<Dim>& stage, const CaseSpec& spec, const std::string& scratch_file);

/// The pressure solve, and the matrix-vector product by which it is measured.
template <int Dim>
void add_pressure(Stage<Dim>& stage);

/// Whole steps. They move the particles, so they come last.
template <int Dim>
void add_steps(Stage<Dim>& stage);

/// Measures memory and one core, after McCalpin's STREAM; no flow is needed.
void add_machine();

}  // namespace tailwater
