#include "neighbours/pairs.h"

#include <algorithm>
#include <cmath>

#include "base/for_each.h"

namespace tailwater {

template <int Dim>
void evaluate_pairs(const Kernel<Dim>& kernel, std::span<const Vec<Dim>> position, std::span<const std::int64_t> id,
                    double least_distance, const NeighbourList& list, Pairs<Dim>& pairs) {
  const std::size_t rows = list.row_begin.size() - 1;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < rows; ++i) longest = std::max(longest, list.row_begin[i + 1] - list.row_begin[i]);
  std::vector<std::int32_t> row_j(longest);
  std::vector<Vec<Dim>> row_d(longest);
  std::vector<double> squared(longest);
  std::vector<double> row_W(longest);
  std::vector<double> row_F(longest);

  pairs.row_begin.resize(rows + 1);
  pairs.row_begin[0] = 0;
  const auto empty = [&](auto&... arrays) {
    // Room for all candidates is not touched beyond the pairs, and costs no memory. A little more than that, because
    // the next list may be longer.
    const std::size_t room = list.j.size() + list.j.size() / 8;
    ((arrays.clear(), arrays.capacity() < list.j.size() ? arrays.reserve(room) : void()), ...);
  };
  empty(pairs.j, pairs.d, pairs.W, pairs.F);

  const double radius = kernel_radius(kernel);
  const double radius_squared = radius * radius;
  const double least_squared = least_distance * least_distance;
  std::visit(
      [&](const auto chosen) {
        for (std::size_t i = 0; i < rows; ++i) {  // in order: rows are packed one behind the other
          // A rejected candidate is overwritten by the next one, without a branch: whether a candidate is within the
          // support is unpredictable.
          const Vec<Dim> r_i = position[i];
          const std::size_t end = list.row_begin[i + 1];
          std::size_t n = 0;
          for (std::size_t k = list.row_begin[i]; k < end; ++k) {
            const std::int32_t j = list.j[k];
            Vec<Dim> r_ij = r_i - position[j];
            double square = r_ij.squaredNorm();
            if (square <= least_squared) [[unlikely]] {
              square = least_squared;
              r_ij = (id[j] > id[i] ? least_distance : -least_distance) * Vec<Dim>::UnitX();
            }
            row_j[n] = j;
            row_d[n] = r_ij;
            squared[n] = square;
            n += square < radius_squared;
          }
          for_each(n, [&, W = row_W.data(), F = row_F.data(), s = squared.data()](std::size_t k) {
            const double r = std::sqrt(s[k]);
            W[k] = chosen.value(r);
            F[k] = -chosen.derivative(r) / r;
          });
          const auto count = static_cast<std::ptrdiff_t>(n);
          pairs.j.insert(pairs.j.end(), row_j.begin(), row_j.begin() + count);
          pairs.d.insert(pairs.d.end(), row_d.begin(), row_d.begin() + count);
          pairs.W.insert(pairs.W.end(), row_W.begin(), row_W.begin() + count);
          pairs.F.insert(pairs.F.end(), row_F.begin(), row_F.begin() + count);
          pairs.row_begin[i + 1] = pairs.j.size();
        }
      },
      kernel);
}

template void evaluate_pairs<2>(const Kernel<2>&, std::span<const Vec<2>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<2>&);
template void evaluate_pairs<3>(const Kernel<3>&, std::span<const Vec<3>>, std::span<const std::int64_t>, double,
                                const NeighbourList&, Pairs<3>&);

}  // namespace tailwater
