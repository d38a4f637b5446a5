#include "base/for_each.h"
#include "bench.h"
#include "case/spec.h"
#include "flow/pressure_equation.h"
#include "io/vtp_writer.h"
#include "neighbours/neighbourhood.h"
#include "operators/concentration.h"
#include "operators/pair_vectors.h"
#include "pressure/operators.h"
#include "results/field_output.h"

namespace tailwater {
namespace {

void add_neighbours(auto& stage) {
  auto& flow = stage.flow;
  add_benchmark("neighbours/search", [&] { flow.neighbourhood->update(flow.state.particles); });
}

template <int Dim>
void add_operators(Stage<Dim>& stage) {
  Flow<Dim>& flow = stage.flow;
  const std::size_t owned = flow.state.particles.owned;
  const auto fluid_sums = std::make_shared<std::vector<KernelSums<Dim>>>(owned);
  add_benchmark("operators/kernel_sums", [&flow, fluid_sums] {
    const Particles<Dim>& particles = flow.state.particles;
    for_each(particles.owned, [&](std::size_t i) {
      if (particles.is_fluid(i)) {
        (*fluid_sums)[i] = kernel_sums<Dim>(flow.pairs(), i, flow.setup.scale.kernel_values);
      }
    });
  });
  const auto vectors = std::make_shared<PairVectorField<Dim>>();
  const auto faces = std::make_shared<std::vector<Vec<Dim>>>(flow.surroundings.open_faces);
  const auto mean_interior = std::make_shared<std::vector<double>>(owned);
  const auto room = std::make_shared<std::vector<float>>(flow.pairs().j.size());
  add_benchmark("operators/pair_vectors", [&flow, vectors, faces, mean_interior, room] {
    const Particles<Dim>& particles = flow.state.particles;
    constexpr CorrectionReach reach = CorrectionReach::inside;
    find_corrected_pair_vectors<Dim>(flow.pairs(), flow.halo(),
                                     {kernel_radius(flow.setup.scale.kernel), particles.volume, particles.kind,
                                      flow.surroundings.interior, flow.surroundings.first_moment},
                                     reach, closing_sweeps(reach), *room, *vectors, *faces, *mean_interior);
  });
  add_benchmark("operators/divergence", [&flow] { benchmark::DoNotOptimize(find_divergence(flow)); });
  const auto gradients = std::make_shared<std::vector<Vec<Dim>>>(owned);
  add_benchmark("operators/gradient", [&flow, gradients] {
    flow.discretisation().find_gradient(flow, flow.state.particles.pressure, *gradients);
  });
}

template <int Dim>
void add_closures(Stage<Dim>& stage) {
  add_benchmark("closures/predict",
                [&stage] { benchmark::DoNotOptimize(predict(stage.flow, stage.begin, stage.drive, stage.dt)); });
  const auto shifts = std::make_shared<std::vector<Vec<Dim>>>(stage.flow.state.particles.owned);
  add_benchmark("closures/shift",
                [&stage, shifts] { stage.flow.discretisation().find_shifts(stage.flow, stage.dt, *shifts); });
}

template <int Dim>
void add_assembly(Stage<Dim>& stage) {
  Flow<Dim>& flow = stage.flow;
  add_benchmark("assembly/pattern",
                [&flow] { flow.equation->rows.set_pattern(flow.pairs().row_begin, flow.pairs().j, flow.halo().plan); });
  add_benchmark("assembly/whole", [&stage] { stage.pose(); });
}

}  // namespace

template <int Dim>
void add_passes(Stage<Dim>& stage, const CaseSpec& spec, const std::string& scratch_file) {
  add_neighbours(stage);
  add_benchmark(
      "flow/locate", [&stage] { locate(stage.flow); }, [&stage] { stage.flow.surroundings.are_current = false; });
  add_operators(stage);
  add_closures(stage);
  add_assembly(stage);
  add_benchmark("output/fields", [&stage, output = spec.output, scratch_file] {
    const FluidFields<Dim> fields(stage.flow, stage.flow.state.particles, output.fields);
    write_vtp(scratch_file, 0.0, encode_piece(fields.view()));
  });
}

template <int Dim>
void add_steps(Stage<Dim>& stage) {
  const auto counts = std::make_shared<std::pair<int, int>>();  // iterations, steps
  add_benchmark(
      "step/whole",
      [&stage, counts] {
        counts->first += stage.step().iterations;
        ++counts->second;
      },
      {},
      [counts](benchmark::UserCounters& counters) {
        counters["iterations_per_step"] = static_cast<double>(counts->first) / counts->second;
      });
}

template void add_passes<2>(Stage<2>&, const CaseSpec&, const std::string&);
template void add_passes<3>(Stage<3>&, const CaseSpec&, const std::string&);
template void add_steps<2>(Stage<2>&);
template void add_steps<3>(Stage<3>&);

}  // namespace tailwater
