// The lifetime of MPI and PETSc in this process.
#pragma once

#include <string>

namespace tailwater {

class LinearSession {
 public:
  /// Starts MPI and PETSc. Throws SolverError when they do not start.
  LinearSession();
  ~LinearSession();
  LinearSession(const LinearSession&) = delete;
  LinearSession& operator=(const LinearSession&) = delete;
};

/// "PETSc 3.18.5, Open MPI v4.1.4", for the run's summary.
std::string linear_library_version();

}  // namespace tailwater
