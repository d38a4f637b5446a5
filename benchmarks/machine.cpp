#include <memory>
#include <numeric>
#include <vector>

#include "bench.h"

namespace tailwater {
namespace {

/// Three arrays of 256 MB together: several times the last cache of this decade's machines.
constexpr std::size_t count = std::size_t{256} * 1000 * 1000 / (3 * sizeof(double));

struct Arrays {
  std::vector<double> a = std::vector<double>(count, 1.0);
  std::vector<double> b = std::vector<double>(count, 2.0);
  std::vector<double> c = std::vector<double>(count, 3.0);
};

/// Bytes that the loop names; those that a store fetches first are not counted.
std::function<void(benchmark::UserCounters&)> moved(double arrays) {
  return [arrays](benchmark::UserCounters& counters) {
    counters["bytes"] = arrays * static_cast<double>(count * sizeof(double));
  };
}

using Packet = float __attribute__((vector_size(32)));  // as loops over pairs compute
constexpr int packets = 10;                             // that do not wait for each other, and stay in registers
constexpr int rounds = 1000000;

/// Returns something that depends on all of them, so that none is left out.
double multiply_and_add() {
  Packet x[packets] = {};
  for (int round = 0; round < rounds; ++round) {
#pragma GCC unroll 10
    for (Packet& packet : x) packet = 0.5F * packet + 1.0F;
  }
  Packet sum = x[0];
  for (int k = 1; k < packets; ++k) sum += x[k];
  double total = 0.0;
  for (int k = 0; k < 8; ++k) total += sum[k];
  return total;
}

}  // namespace

void add_machine() {
  const auto arrays = std::make_shared<Arrays>();
  const auto sum = std::make_shared<double>(0.0);
  add_benchmark(
      "machine/read",
      [=] {
        constexpr std::size_t width = 32;  // independent sums, so that no addition waits for another
        double sums[width] = {};
        const double* const a = arrays->a.data();
        for (std::size_t i = 0; i + width <= count; i += width) {
          for (std::size_t k = 0; k < width; ++k) sums[k] += a[i + k];
        }
        *sum += std::accumulate(sums, sums + width, 0.0);
      },
      {}, moved(1));
  add_benchmark(
      "machine/copy", [=] { std::copy(arrays->a.begin(), arrays->a.end(), arrays->c.begin()); }, {}, moved(2));
  add_benchmark(
      "machine/triad",
      [=] {
        double* const a = arrays->a.data();
        const double* const b = arrays->b.data();
        const double* const c = arrays->c.data();
        for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + 0.25 * c[i];
      },
      {}, moved(3));
  add_benchmark(
      "machine/multiply_add", [=] { *sum += multiply_and_add(); }, {},
      [](benchmark::UserCounters& counters) {
        counters["operations"] = 2.0 * rounds * packets * sizeof(Packet) / sizeof(float);
      });
}

}  // namespace tailwater
