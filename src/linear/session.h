// The lifetime of MPI in this process, and of PETSc where a system needs it (petsc.h).
#pragma once

#include <string>

namespace tailwater {

class LinearSession {
 public:
  /// Starts MPI. Throws SolverError when it does not start.
  LinearSession();
  ~LinearSession();
  LinearSession(const LinearSession&) = delete;
  LinearSession& operator=(const LinearSession&) = delete;

 private:
  bool has_started_mpi_ = false;
};

/// "PETSc 3.18.5, Open MPI v4.1.4", for the run's summary; without PETSc if no system has needed it.
std::string linear_library_version();

}  // namespace tailwater
