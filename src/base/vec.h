// Small vectors and matrices of fixed size. Member functions have the names of Eigen's. These are plain values without
// expression templates, because Eigen's took a quarter of the compile time. Decompositions, and sizes that are known
// only at run time, remain with Eigen (base/eigen.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <ostream>

namespace tailwater {

// NOLINTBEGIN(readability-identifier-naming): the names of Eigen's, so that a template takes either
/// A matrix of numbers, stored column by column. Its entries are not set by the default constructor.
template <int Rows, int Columns>
class SmallMatrix {
 public:
  static constexpr int count = Rows * Columns;
  static constexpr bool is_vector = Columns == 1;

  SmallMatrix() = default;
  SmallMatrix(const SmallMatrix&) = default;
  /// Not for temporaries: a column of a matrix is returned as a copy; put_column writes it.
  constexpr SmallMatrix& operator=(const SmallMatrix&) & = default;
  /// A vector of these entries.
  template <typename... Numbers>
  requires(is_vector && sizeof...(Numbers) == Rows && Rows > 1) constexpr SmallMatrix(Numbers... numbers)
      : at_{static_cast<double>(numbers)...} {}
  constexpr explicit SmallMatrix(double number) requires(Rows == 1 && is_vector) : at_{number} {}

  /// A matrix row by row.
  constexpr SmallMatrix(std::initializer_list<std::array<double, Columns>> rows) requires(!is_vector) {
    std::ptrdiff_t i = 0;
    for (const std::array<double, Columns>& row : rows) {
      for (std::ptrdiff_t j = 0; j < Columns; ++j) (*this)(i, j) = row[j];
      ++i;
    }
  }

  static constexpr SmallMatrix Constant(double value) {
    SmallMatrix result{};
    for (double& entry : result.at_) entry = value;
    return result;
  }
  static constexpr SmallMatrix Zero() { return Constant(0.0); }
  static constexpr SmallMatrix Ones() { return Constant(1.0); }
  static constexpr SmallMatrix Identity() {
    static_assert(Rows == Columns);
    SmallMatrix result = Zero();
    for (int i = 0; i < Rows; ++i) result(i, i) = 1.0;
    return result;
  }
  /// The unit vector along a direction.
  static constexpr SmallMatrix Unit(int direction) {
    SmallMatrix result = Zero();
    result[direction] = 1.0;
    return result;
  }
  static constexpr SmallMatrix UnitX() { return Unit(0); }
  static constexpr SmallMatrix UnitY() { return Unit(1); }
  static constexpr SmallMatrix UnitZ() { return Unit(2); }
  /// The vector of the values of a function of the index.
  template <typename Function>
  static constexpr SmallMatrix NullaryExpr(Function&& of_index) {
    SmallMatrix result;
    for (int i = 0; i < count; ++i) result[i] = of_index(i);
    return result;
  }
  /// A copy of numbers that stand column by column.
  static constexpr SmallMatrix Map(const double* numbers) {
    return NullaryExpr([numbers](int i) { return numbers[i]; });
  }

  constexpr double& operator[](std::ptrdiff_t i) { return at_[i]; }
  constexpr double operator[](std::ptrdiff_t i) const { return at_[i]; }
  constexpr double& operator()(std::ptrdiff_t row, std::ptrdiff_t column) { return at_[column * Rows + row]; }
  constexpr double operator()(std::ptrdiff_t row, std::ptrdiff_t column) const { return at_[column * Rows + row]; }
  constexpr double& x() { return at_[0]; }
  constexpr double x() const { return at_[0]; }
  constexpr double& y() { return at_[1]; }
  constexpr double y() const { return at_[1]; }
  constexpr double& z() { return at_[2]; }
  constexpr double z() const { return at_[2]; }
  constexpr double* data() { return at_; }
  constexpr const double* data() const { return at_; }
  constexpr double* begin() { return at_; }
  constexpr const double* begin() const { return at_; }
  constexpr double* end() { return at_ + count; }
  constexpr const double* end() const { return at_ + count; }
  static constexpr int size() { return count; }
  static constexpr int rows() { return Rows; }
  static constexpr int cols() { return Columns; }

  constexpr SmallMatrix& operator+=(const SmallMatrix& other) & {
    for (int i = 0; i < count; ++i) at_[i] += other.at_[i];
    return *this;
  }
  constexpr SmallMatrix& operator-=(const SmallMatrix& other) & {
    for (int i = 0; i < count; ++i) at_[i] -= other.at_[i];
    return *this;
  }
  constexpr SmallMatrix& operator*=(double factor) & {
    for (double& entry : at_) entry *= factor;
    return *this;
  }
  constexpr SmallMatrix& operator/=(double divisor) & {
    for (double& entry : at_) entry /= divisor;
    return *this;
  }
  friend constexpr SmallMatrix operator+(SmallMatrix a, const SmallMatrix& b) { return a += b; }
  friend constexpr SmallMatrix operator-(SmallMatrix a, const SmallMatrix& b) { return a -= b; }
  friend constexpr SmallMatrix operator*(SmallMatrix a, double factor) { return a *= factor; }
  friend constexpr SmallMatrix operator*(double factor, SmallMatrix a) { return a *= factor; }
  friend constexpr SmallMatrix operator/(SmallMatrix a, double divisor) { return a /= divisor; }
  constexpr SmallMatrix operator-() const {
    return each([](double entry) { return -entry; });
  }
  friend constexpr bool operator==(const SmallMatrix& a, const SmallMatrix& b) {
    for (int i = 0; i < count; ++i) {
      if (a.at_[i] != b.at_[i]) return false;
    }
    return true;
  }

  /// Adds to numbers that stand column by column.
  constexpr void add_to(double* sums) const {
    for (int i = 0; i < count; ++i) sums[i] += at_[i];
  }

  constexpr double dot(const SmallMatrix& other) const {
    double sum = at_[0] * other.at_[0];
    for (int i = 1; i < count; ++i) sum += at_[i] * other.at_[i];
    return sum;
  }
  constexpr double squaredNorm() const { return dot(*this); }
  double norm() const { return std::sqrt(squaredNorm()); }
  /// Itself where its length is 0.
  SmallMatrix normalized() const {
    const double square = squaredNorm();
    return square > 0.0 ? *this / std::sqrt(square) : *this;
  }
  void normalize() { *this = normalized(); }
  constexpr SmallMatrix cross(const SmallMatrix& b) const {
    static_assert(Rows == 3 && is_vector);
    const SmallMatrix& a = *this;
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }

  constexpr double sum() const {
    double sum = at_[0];
    for (int i = 1; i < count; ++i) sum += at_[i];
    return sum;
  }
  constexpr double prod() const {
    double product = at_[0];
    for (int i = 1; i < count; ++i) product *= at_[i];
    return product;
  }
  constexpr double mean() const { return sum() / count; }
  constexpr double maxCoeff() const { return *std::max_element(begin(), end()); }
  constexpr double minCoeff() const { return *std::min_element(begin(), end()); }
  /// The largest entry and, written to `where`, its index.
  template <typename Index>
  constexpr double maxCoeff(Index* where) const {
    *where = static_cast<Index>(std::max_element(begin(), end()) - begin());
    return at_[*where];
  }
  template <typename Index>
  constexpr double minCoeff(Index* where) const {
    *where = static_cast<Index>(std::min_element(begin(), end()) - begin());
    return at_[*where];
  }
  bool allFinite() const {
    return std::all_of(begin(), end(), [](double entry) { return std::isfinite(entry); });
  }
  /// Whether no entry is larger than this in size.
  constexpr bool isZero(double most = 1e-12) const {
    return std::all_of(begin(), end(), [most](double entry) { return std::abs(entry) <= most; });
  }
  void setZero() { *this = Zero(); }
  void fill(double value) { *this = Constant(value); }

  template <typename Function>
  constexpr SmallMatrix each(Function&& function) const {
    SmallMatrix result;
    for (int i = 0; i < count; ++i) result.at_[i] = function(at_[i]);
    return result;
  }
  template <typename Function>
  constexpr SmallMatrix each(const SmallMatrix& other, Function&& function) const {
    SmallMatrix result;
    for (int i = 0; i < count; ++i) result.at_[i] = function(at_[i], other.at_[i]);
    return result;
  }
  SmallMatrix cwiseAbs() const {
    return each([](double entry) { return std::abs(entry); });
  }
  constexpr SmallMatrix cwiseMin(const SmallMatrix& other) const {
    return each(other, [](double a, double b) { return std::min(a, b); });
  }
  constexpr SmallMatrix cwiseMax(const SmallMatrix& other) const {
    return each(other, [](double a, double b) { return std::max(a, b); });
  }
  constexpr SmallMatrix cwiseMin(double most) const { return cwiseMin(Constant(most)); }
  constexpr SmallMatrix cwiseMax(double least) const { return cwiseMax(Constant(least)); }
  constexpr SmallMatrix cwiseProduct(const SmallMatrix& other) const {
    return each(other, [](double a, double b) { return a * b; });
  }
  constexpr SmallMatrix cwiseQuotient(const SmallMatrix& other) const {
    return each(other, [](double a, double b) { return a / b; });
  }
  SmallMatrix cwiseSqrt() const {
    return each([](double entry) { return std::sqrt(entry); });
  }

  constexpr SmallMatrix<Columns, Rows> transpose() const {
    SmallMatrix<Columns, Rows> result;
    for (int i = 0; i < Rows; ++i) {
      for (int j = 0; j < Columns; ++j) result(j, i) = (*this)(i, j);
    }
    return result;
  }
  constexpr SmallMatrix<Rows, 1> col(std::ptrdiff_t column) const {
    return SmallMatrix<Rows, 1>::Map(at_ + column * Rows);
  }
  constexpr SmallMatrix<Columns, 1> row(std::ptrdiff_t row) const {
    return SmallMatrix<Columns, 1>::NullaryExpr([this, row](int j) { return (*this)(row, j); });
  }
  /// Several entries of a vector, from the first on or from another.
  template <int Size>
  constexpr SmallMatrix<Size, 1> segment(std::ptrdiff_t first) const {
    return SmallMatrix<Size, 1>::Map(at_ + first);
  }
  template <int Size>
  constexpr SmallMatrix<Size, 1> head() const {
    return segment<Size>(0);
  }
  template <int Size>
  constexpr SmallMatrix<Size, 1> tail() const {
    return segment<Size>(Rows - Size);
  }
  /// Writes these entries of a vector, from the one of index `first` on.
  template <int Size>
  constexpr void put(std::ptrdiff_t first, const SmallMatrix<Size, 1>& entries) {
    for (int i = 0; i < Size; ++i) at_[first + i] = entries[i];
  }
  constexpr void put_column(std::ptrdiff_t column, const SmallMatrix<Rows, 1>& entries) {
    for (int i = 0; i < Rows; ++i) at_[column * Rows + i] = entries[i];
  }
  constexpr SmallMatrix<Rows, 1> diagonal() const {
    return SmallMatrix<Rows, 1>::NullaryExpr([this](int i) { return (*this)(i, i); });
  }
  /// The square matrix with these entries on its diagonal.
  constexpr SmallMatrix<Rows, Rows> asDiagonal() const {
    SmallMatrix<Rows, Rows> result = SmallMatrix<Rows, Rows>::Zero();
    for (int i = 0; i < Rows; ++i) result(i, i) = at_[i];
    return result;
  }
  constexpr double trace() const { return diagonal().sum(); }
  constexpr double determinant() const {
    static_assert(Rows == Columns && (Rows == 2 || Rows == 3));
    const SmallMatrix& A = *this;
    if constexpr (Rows == 2)
      return A(0, 0) * A(1, 1) - A(1, 0) * A(0, 1);
    else
      return A.col(0).dot(A.col(1).cross(A.col(2)));
  }
  constexpr SmallMatrix inverse() const {
    static_assert(Rows == Columns && (Rows == 2 || Rows == 3));
    const SmallMatrix& A = *this;
    SmallMatrix result;
    const double scale = 1.0 / determinant();
    if constexpr (Rows == 2) {
      result(0, 0) = A(1, 1) * scale;
      result(0, 1) = -A(0, 1) * scale;
      result(1, 0) = -A(1, 0) * scale;
      result(1, 1) = A(0, 0) * scale;
    } else {
      for (int i = 0; i < 3; ++i) {
        const auto across = A.col((i + 1) % 3).cross(A.col((i + 2) % 3));
        for (int j = 0; j < 3; ++j) result(i, j) = across[j] * scale;
      }
    }
    return result;
  }

 private:
  double at_[count];
};

// NOLINTEND(readability-identifier-naming)

template <int Rows, int Inner, int Columns>
constexpr SmallMatrix<Rows, Columns> operator*(const SmallMatrix<Rows, Inner>& A,
                                               const SmallMatrix<Inner, Columns>& B) {
  SmallMatrix<Rows, Columns> result;
  for (int j = 0; j < Columns; ++j) {
    for (int i = 0; i < Rows; ++i) {
      double sum = A(i, 0) * B(0, j);
      for (int k = 1; k < Inner; ++k) sum += A(i, k) * B(k, j);
      result(i, j) = sum;
    }
  }
  return result;
}

/// As messages and tests show it: a row a line.
template <int Rows, int Columns>
std::ostream& operator<<(std::ostream& out, const SmallMatrix<Rows, Columns>& A) {
  for (int i = 0; i < Rows; ++i) {
    for (int j = 0; j < Columns; ++j) out << (j > 0 ? " " : i > 0 ? "\n" : "") << A(i, j);
  }
  return out;
}

template <int Dim>
using Vec = SmallMatrix<Dim, 1>;

template <int Dim>
using Mat = SmallMatrix<Dim, Dim>;

/// Number of independent entries of a symmetric Dim x Dim tensor: 3 in 2D, 6 in 3D.
template <int Dim>
inline constexpr int symmetric_size = Dim*(Dim + 1) / 2;

/// A length to the power Dim: the area (2D) or volume (3D) of a cube with that edge.
template <int Dim>
constexpr double power(double length) {
  static_assert(Dim == 2 || Dim == 3);
  return Dim == 2 ? length * length : length * length * length;
}

/// The edge of a square of this area (2D) or a cube of this volume (3D).
template <int Dim>
double edge_of(double volume) {
  return Dim == 2 ? std::sqrt(volume) : std::cbrt(volume);
}

}  // namespace tailwater

/// Compiles a function template over Dim, in the source file that defines it.
#define TAILWATER_IN_2D_AND_3D(function)      \
  template decltype(function<2>) function<2>; \
  template decltype(function<3>) function<3>
