#include "operators/pair_vectors.h"

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
void find_kernel_gradients(const Pairs<Dim>& pairs, std::span<Vec<Dim>> pair_vectors) {
  for_each(pair_vectors.size(), [&](std::size_t k) { pair_vectors[k] = pairs.dW[k] * pairs.e[k]; });
}

template <int Dim>
void find_moment_corrections(const Pairs<Dim>& pairs, double radius, std::span<const double> interior,
                             std::span<const Mat<Dim>> first_moment, std::span<Mat<Dim>> correction) {
  for_each(pairs.owned(), [&](std::size_t i) {
    const double share = interior[i];
    correction[i].setIdentity();
    if (share == 0.0) return;
    // Weights 1 - (r/R)^2: a mean over as many neighbours as there are, and continuous.
    Mat<Dim> sum = share * first_moment[i];
    double weights = share;
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      const double q = pairs.r[k] / radius;
      const double weight = interior[j] * (1.0 - q * q);
      sum += weight * first_moment[j];
      weights += weight;
    }
    const Mat<Dim> mean = sum / weights;
    correction[i] = (1.0 - share) * Mat<Dim>::Identity() + share * mean.inverse();
  });
}

template <int Dim>
void find_corrected_gradients(const Pairs<Dim>& pairs, std::span<const Mat<Dim>> correction,
                              std::span<Vec<Dim>> pair_vectors) {
  for_each(pairs.owned(), [&](std::size_t i) {
    const Mat<Dim> own = correction[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      pair_vectors[k] = (0.5 * pairs.dW[k]) * ((own + correction[pairs.j[k]]) * pairs.e[k]);
    }
  });
}

template <int Dim>
OpenFaces<Dim> find_open_faces(const Pairs<Dim>& pairs, std::span<const double> volume,
                               std::span<const double> interior, std::span<const Vec<Dim>> pair_vectors) {
  OpenFaces<Dim> faces;
  faces.divisor.assign(pairs.owned(), 0.0);
  faces.half.assign(pairs.owned(), Vec<Dim>::Zero());
  for_each(pairs.owned(), [&](std::size_t i) {
    if (interior[i] == 0.0) return;
    double diagonal = 0.0;
    Vec<Dim> sum = Vec<Dim>::Zero();
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      diagonal -= volume[j] * pairs.dW[k] / pairs.r[k];
      sum += volume[j] * pair_vectors[k];
    }
    faces.divisor[i] = diagonal / interior[i];
    faces.half[i] = -0.5 * sum;
  });
  return faces;
}

template <int Dim>
void sweep_faces(const Pairs<Dim>& pairs, std::span<const double> volume, const OpenFaces<Dim>& faces,
                 std::span<const Vec<Dim>> l, std::span<Vec<Dim>> next) {
  for_each(pairs.owned(), [&](std::size_t i) {
    next[i].setZero();
    if (faces.divisor[i] == 0.0) return;
    Vec<Dim> sum = faces.half[i];
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      const auto j = pairs.j[k];
      sum -= (volume[j] * pairs.dW[k] / pairs.r[k]) * l[j];
    }
    next[i] = sum / faces.divisor[i];
  });
}

template <int Dim>
void close_faces(const Pairs<Dim>& pairs, std::span<const Vec<Dim>> l, std::span<Vec<Dim>> pair_vectors) {
  for_each(pairs.owned(), [&](std::size_t i) {
    for (std::size_t k = pairs.begin(i); k < pairs.end(i); ++k) {
      pair_vectors[k] -= (pairs.dW[k] / pairs.r[k]) * (l[i] - l[pairs.j[k]]);
    }
  });
}

#define TAILWATER_INSTANTIATE(Dim)                                                                                  \
  template void find_kernel_gradients<Dim>(const Pairs<Dim>&, std::span<Vec<Dim>>);                                 \
  template void find_moment_corrections<Dim>(const Pairs<Dim>&, double, std::span<const double>,                    \
                                             std::span<const Mat<Dim>>, std::span<Mat<Dim>>);                       \
  template void find_corrected_gradients<Dim>(const Pairs<Dim>&, std::span<const Mat<Dim>>, std::span<Vec<Dim>>);   \
  template OpenFaces<Dim> find_open_faces<Dim>(const Pairs<Dim>&, std::span<const double>, std::span<const double>, \
                                               std::span<const Vec<Dim>>);                                          \
  template void sweep_faces<Dim>(const Pairs<Dim>&, std::span<const double>, const OpenFaces<Dim>&,                 \
                                 std::span<const Vec<Dim>>, std::span<Vec<Dim>>);                                   \
  template void close_faces<Dim>(const Pairs<Dim>&, std::span<const Vec<Dim>>, std::span<Vec<Dim>>);
TAILWATER_INSTANTIATE(2)
TAILWATER_INSTANTIATE(3)
#undef TAILWATER_INSTANTIATE

}  // namespace tailwater
