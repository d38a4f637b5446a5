// Benchmarks of the modules on a flow of a case after some steps. `tailwater bench speed` runs it; by hand:
//   bench_modules CASE [--set KEY=VALUE]... [--steps N] [--benchmark_filter=REGEX and other options of Google
//   Benchmark] bench_modules machine
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "bench.h"
#include "case/reader.h"
#include "flow/pressure_equation.h"
#include "linear/session.h"
#include "results/provenance.h"

namespace tailwater {
namespace {

template <class Value>
void add_context(const std::string& name, Value value) {
  benchmark::AddCustomContext(name, fmt::format("{}", value));
}

template <class Array>
double bytes_of(const Array& values) {
  return static_cast<double>(values.size() * sizeof(values[0]));
}

/// Reports the memory of the flow. The arrays named are the largest; lists and the solver's own are in the sum only.
template <int Dim>
void add_memory(const Stage<Dim>& stage, double bytes_before) {
  const Pairs<Dim>& pairs = stage.flow.pairs();
  add_context("bytes.all", bytes_on_heap() - bytes_before);
  add_context("bytes.pairs", bytes_of(pairs.j));
  add_context("bytes.pair_vectors", bytes_of(stage.flow.surroundings.pair_vectors.ends));
  const auto entries = static_cast<double>(stage.flow.equation->rows.entries());
  add_context("bytes.matrix", entries * sizeof(float));  // its columns are those of the pairs
}

template <int Dim>
void run_modules(const CaseSpec& spec, int steps) {
  const double bytes_before = bytes_on_heap();
  Stage<Dim> stage(spec, steps);
  add_context("provenance", provenance().dump());
  add_context("fluid", stage.fluid());
  add_context("particles", stage.flow.state.particles.owned);
  add_context("pairs", stage.flow.pairs().j.size());
  add_memory(stage, bytes_before);
  const std::string scratch_file =
      std::filesystem::temp_directory_path() / fmt::format("bench_modules_{}.vtp", getpid());
  add_passes(stage, spec, scratch_file);
  add_pressure(stage);
  add_steps(stage);
  benchmark::RunSpecifiedBenchmarks();
  std::filesystem::remove(scratch_file);
}

int run(int argc, char** argv) {
  CLI::App app("Benchmarks of the modules");
  std::string case_file;
  std::vector<std::string> overrides;
  int steps = 10;
  app.add_option("case", case_file, "The case file, or \"machine\"")->required();
  app.add_option("--set", overrides)->allow_extra_args(false);
  app.add_option("--steps", steps, "Steps before the benchmarks")->check(CLI::Range(1, 1000000));
  app.allow_extras();
  CLI11_PARSE(app, argc, argv);

  std::vector<std::string> words = app.remaining();
  words.insert(words.begin(), argv[0]);
  std::vector<char*> remaining;
  for (std::string& word : words) remaining.push_back(word.data());
  int count = static_cast<int>(remaining.size());
  benchmark::Initialize(&count, remaining.data());
  if (benchmark::ReportUnrecognizedArguments(count, remaining.data())) return 2;

  if (case_file == "machine") {
    add_machine();
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  }
  const LinearSession session;
  const CaseSpec spec = read_case(case_file, overrides);
  spec.general.dimension == 2 ? run_modules<2>(spec, steps) : run_modules<3>(spec, steps);
  return 0;
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) {
  try {
    return tailwater::run(argc, argv);
  } catch (const tailwater::UserError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(error.code());
  }
}
