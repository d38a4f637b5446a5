// A program of one's own that runs a case, with a folder or in memory: a_run CASE.toml [DIR]
#include <cstdio>

#include "case/reader.h"
#include "linear/session.h"
#include "run/run_case.h"
#include "run/simulation.h"

int main(int count, char** arguments) {
  const tailwater::LinearSession session;
  const tailwater::CaseSpec spec = tailwater::read_case(arguments[1]);
  if (count > 2) return static_cast<int>(tailwater::run_case(spec, {.case_file = arguments[1], .out = arguments[2]}));
  tailwater::require_sound_geometry(spec);
  tailwater::Simulation<2> simulation(spec);
  for (simulation.start(); !simulation.has_ended(); simulation.step()) {
  }
  std::printf("%.17g\n", simulation.flow().state.time);
}
