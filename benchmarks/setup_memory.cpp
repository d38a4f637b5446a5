// Cost of the set-up of a case on each rank, before any step: memory and time of its checks, its walls and its water.
//   mpirun -n N build/release/bin/setup_memory CASE [KEY=VALUE...]
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "case/reader.h"
#include "checks/check.h"
#include "linear/session.h"
#include "published/make_flow.h"

namespace tailwater {
namespace {

/// MB; the most that this process has held so far
double peak_memory() {
  std::ifstream file("/proc/self/status");
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) * 1.024e-3;
  }
  return 0.0;
}

void tell(const Communicator& ranks, const char* what, std::chrono::steady_clock::time_point start) {
  const double most = ranks.largest(peak_memory());
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (ranks.is_root()) fmt::print("{}: {:.1f} s, at most {:.0f} MB per rank\n", what, seconds, most);
}

template <int Dim>
void set_up(const CaseSpec& spec, const Communicator& ranks) {
  const auto start = std::chrono::steady_clock::now();
  tell(ranks, "nothing", start);
  {
    const Boundary<Dim> boundary = make_boundary<Dim>(spec);
    const FluidParticles<Dim> fluid = make_fluid_particles(spec, boundary, ranks);
    tell(ranks, "water", start);
    for (const Finding& finding : check_geometry(spec, boundary, fluid)) {
      if (ranks.is_root()) fmt::print("{}\n", finding.message());
    }
    tell(ranks, "checks", start);
  }
  const Flow<Dim> flow = make_flow<Dim>(spec, ranks);
  tell(ranks, "flow", start);
  const std::size_t all = ranks.sum(flow.state.particles.owned);
  const std::size_t rows = ranks.largest(flow.walls.particles.size());
  if (ranks.is_root()) fmt::print("{} particles, {} rows of walls, at most {} on a rank\n", all, flow.walls.all, rows);
}

int run(int argc, char** argv) {
  const LinearSession session;
  if (argc < 2) {
    fmt::print("usage: setup_memory CASE [KEY=VALUE...]\n");
    return 2;
  }
  const CaseSpec spec = read_case(argv[1], std::vector<std::string>(argv + 2, argv + argc));
  if (spec.general.dimension == 2) {
    set_up<2>(spec, Communicator::world());
  } else {
    set_up<3>(spec, Communicator::world());
  }
  return 0;
}

}  // namespace
}  // namespace tailwater

int main(int argc, char** argv) { return tailwater::run(argc, argv); }
