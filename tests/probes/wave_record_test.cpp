// Wave statistics of a gauge, for sines with known heights and periods.
#include "probes/wave_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "case/probe_columns.h"

namespace tailwater {
namespace {

constexpr double step = 0.01;    // s
constexpr double period = 1.3;   // s
constexpr double height = 0.06;  // m
constexpr double still = 0.4;    // m
constexpr double band = 0.002;   // m

double wave(double time) { return 0.5 * height * std::sin(2.0 * std::numbers::pi * time / period); }

std::map<std::string, double> lines(const WaveRecord& record) {
  const std::vector<double> totals = record.totals();
  const std::vector<OutputColumn> declared = totals_of(ProbeType::depth, 2);
  std::map<std::string, double> lines;
  for (std::size_t k = 0; k < totals.size(); ++k) lines[declared.at(k).heading] = totals[k];
  return lines;
}

/// Crests lie between samples, at most half a step away, and are missed by 1 - cos(pi step/period). A crossing is
/// shifted by the error of the mean level: the first half wave raises the mean by at most height/(2 pi), weighted by
/// its duration.
TEST(WaveRecord, TellsHeightsAndPeriodOfASine) {
  WaveRecord record(band);
  for (int n = 0; n * step < 20.0 * period; ++n) record.add(n * step, still + wave(n * step));
  const auto found = lines(record);
  const double missed = height * (1.0 - std::cos(std::numbers::pi * step / period));
  EXPECT_EQ(found.at("waves"), 18.0);  // 20 half waves up, of which the first comes before any trough
  EXPECT_NEAR(found.at("height_mean_m"), height, missed);
  EXPECT_NEAR(found.at("height_third_m"), height, missed);
  EXPECT_NEAR(found.at("height_largest_m"), height, missed);
  EXPECT_NEAR(found.at("period_mean_s"), period, 1e-2 * period);
  EXPECT_NEAR(found.at("mean_m"), still, 1e-3 * height);
  EXPECT_NEAR(found.at("least_m"), still - 0.5 * height, missed);
  EXPECT_NEAR(found.at("largest_m"), still + 0.5 * height, missed);
}

/// Every third wave is twice as high: they determine the mean of the highest third, and the mean of all waves is 4/3 of
/// the small ones.
TEST(WaveRecord, TheHighestThirdIsTheSignificantHeight) {
  WaveRecord record(band);
  const auto size = [](double time) { return static_cast<int>(std::floor(time / period + 0.25)) % 3 == 0 ? 2.0 : 1.0; };
  // From trough to trough a wave has one size.
  for (int n = 0; n * step < 31.0 * period; ++n) {
    const double time = n * step;
    record.add(time, still + size(time) * (wave(time) + 0.5 * height) - 0.5 * height);
  }
  const auto found = lines(record);
  EXPECT_GT(found.at("waves"), 25.0);
  EXPECT_NEAR(found.at("height_third_m"), 2.0 * height, 0.01 * height);
  EXPECT_NEAR(found.at("height_mean_m"), 4.0 / 3.0 * height, 0.05 * height);
}

TEST(WaveRecord, TremblingIsNoWave) {
  WaveRecord record(band);
  EXPECT_TRUE(record.totals().empty());
  for (int n = 0; n < 1000; ++n) record.add(n * step, still + (n % 2 == 0 ? 0.9 : -0.9) * band);
  const auto found = lines(record);
  EXPECT_EQ(found.count("waves"), 0u);
  EXPECT_NEAR(found.at("mean_m"), still, 1e-2 * band);
}

/// A record restored from another's state gives the same results.
TEST(WaveRecord, GoesOnFromItsMemory) {
  WaveRecord whole(band);
  WaveRecord half(band);
  for (int n = 0; n < 800; ++n) {
    whole.add(n * step, still + wave(n * step));
    if (n < 400) half.add(n * step, still + wave(n * step));
  }
  WaveRecord rest(band);
  *rest.memory() = *half.memory();
  for (int n = 400; n < 800; ++n) rest.add(n * step, still + wave(n * step));
  EXPECT_EQ(*rest.memory(), *whole.memory());
  EXPECT_GT(rest.memory()->size(), half.memory()->size());
}

}  // namespace
}  // namespace tailwater
