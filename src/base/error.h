// The errors a user can meet, apart from broken invariants (assert.h). Each kind has its exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace tailwater {

enum class ExitCode : int {
  done = 0,
  bad_input = 2,
  solver_failed = 3,
  io_failed = 4,
  interrupted = 130,
};

/// Base of all errors that end a command with a message to its user.
class UserError : public std::runtime_error {
 public:
  UserError(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// The case file, the command line or the geometry is wrong. The message names the place, the value and the remedy.
class InputError : public UserError {
 public:
  explicit InputError(const std::string& message) : UserError(ExitCode::bad_input, message) {}
};

/// A linear solve did not converge, or a step produced a value that is not finite.
class SolverError : public UserError {
 public:
  explicit SolverError(const std::string& message) : UserError(ExitCode::solver_failed, message) {}
};

/// A file or folder cannot be read or written.
class IoError : public UserError {
 public:
  explicit IoError(const std::string& message) : UserError(ExitCode::io_failed, message) {}
};

}  // namespace tailwater
