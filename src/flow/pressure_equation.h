// The pressure equation of a flow: its rows and their solver.
#pragma once

#include "linear/linear_solver.h"
#include "linear/linear_system.h"

namespace tailwater {

struct PressureEquation {
  /// Throws InputError as the solver does.
  PressureEquation(const Communicator& ranks, const PressureSolverTable& settings, const SystemTraits& water)
      : rows(ranks), solver(settings, water) {}

  LinearSystem rows;  ///< the pair vectors use their workspace first
  LinearSolver solver;
  bool has_matrix = false;  ///< whether a second projection has left the matrix of the present positions

  /// Frees the matrix and the solver's data derived from it.
  void forget_matrix() {
    has_matrix = false;
    solver.forget();
    rows.forget_weights();
  }
};

}  // namespace tailwater
