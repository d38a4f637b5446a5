// The triangular sweeps of SSOR over a matrix with unit diagonal, A = L + I + U. They have a copy of L and one of U,
// each in the order in which its sweep reads it: memory is what a sweep waits for, and a sweep through the whole rows
// would drag both halves through the cache to use one.
#pragma once

#include <span>
#include <vector>

namespace tailwater {

class TriangularSweeps {
 public:
  /// Copies a matrix of compressed rows: the entries of row i are begin[i] .. begin[i + 1], with ascending columns, and
  /// its diagonal, 1, is at diagonal[i].
  void take(std::span<const int> begin, std::span<const int> column, std::span<const int> diagonal,
            std::span<const double> value);

  /// x = (D + L)^-1 b with D = I/omega. All vectors have one entry per row.
  void forward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + U)^-1 b.
  void backward(double omega, std::span<const double> b, std::span<double> x) const;
  /// x = (D + L)^-1 A (D + U)^-1 b, in Eisenstat's form (docs/theory/linear.md).
  void eisenstat(double omega, std::span<const double> b, std::span<double> x);

 private:
  /// Half of the entries, row after row in the order of the sweep.
  struct Triangle {
    std::vector<int> count;  ///< entries of each row
    std::vector<int> column;
    std::vector<double> value;
  };
  class Reader;

  Triangle lower_;  ///< rows ascending
  Triangle upper_;  ///< rows descending
  std::vector<double> scratch_;
};

}  // namespace tailwater
