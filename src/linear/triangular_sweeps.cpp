#include "linear/triangular_sweeps.h"

namespace tailwater {

/// Goes through a triangle row after row.
class TriangularSweeps::Reader {
 public:
  explicit Reader(const Triangle& triangle)
      : count_(triangle.count.data()), column_(triangle.column.data()), value_(triangle.value.data()) {}

  /// Sum of value * x over the next row: two partial sums, so that an addition need not wait for the one before it.
  double next(std::span<const double> x) {
    const int count = *count_++;
    double even = 0.0;
    double odd = 0.0;
    int k = 0;
    for (; k + 2 <= count; k += 2) {
      even += value_[k] * x[column_[k]];
      odd += value_[k + 1] * x[column_[k + 1]];
    }
    if (k < count) even += value_[k] * x[column_[k]];
    column_ += count;
    value_ += count;
    return even + odd;
  }

 private:
  const int* count_;
  const int* column_;
  const double* value_;
};

void TriangularSweeps::take(std::span<const int> begin, std::span<const int> column, std::span<const int> diagonal,
                            std::span<const double> value) {
  const std::size_t rows = diagonal.size();
  scratch_.resize(rows);
  std::size_t entries_of_lower = 0;
  for (std::size_t i = 0; i < rows; ++i) entries_of_lower += diagonal[i] - begin[i];
  const auto resize = [rows](Triangle& triangle, std::size_t entries) {
    triangle.count.resize(rows);
    triangle.column.resize(entries);
    triangle.value.resize(entries);
  };
  resize(lower_, entries_of_lower);
  resize(upper_, column.size() - entries_of_lower - rows);
  std::size_t n = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    lower_.count[i] = diagonal[i] - begin[i];
    for (int k = begin[i]; k < diagonal[i]; ++k, ++n) {
      lower_.column[n] = column[k];
      lower_.value[n] = value[k];
    }
  }
  n = 0;
  for (std::size_t i = rows; i-- > 0;) {  // columns descend too: the row swept last comes last
    upper_.count[rows - 1 - i] = begin[i + 1] - diagonal[i] - 1;
    for (int k = begin[i + 1] - 1; k > diagonal[i]; --k, ++n) {
      upper_.column[n] = column[k];
      upper_.value[n] = value[k];
    }
  }
}

void TriangularSweeps::forward(double omega, std::span<const double> b, std::span<double> x) const {
  Reader row(lower_);
  for (std::size_t i = 0; i < b.size(); ++i) x[i] = omega * (b[i] - row.next(x));
}

void TriangularSweeps::backward(double omega, std::span<const double> b, std::span<double> x) const {
  Reader row(upper_);
  for (std::size_t i = b.size(); i-- > 0;) x[i] = omega * (b[i] - row.next(x));
}

void TriangularSweeps::eisenstat(double omega, std::span<const double> b, std::span<double> x) {
  backward(omega, b, x);
  const double share = 2.0 / omega - 1.0;
  Reader row(lower_);
  for (std::size_t i = 0; i < b.size(); ++i) {
    scratch_[i] = omega * (b[i] - share * x[i] - row.next(scratch_));
    x[i] += scratch_[i];
  }
}

}  // namespace tailwater
