// Plates that make or absorb waves: their motion, and the elevation of their own waves in front of them
// (docs/theory/waves.md).
#pragma once

#include <variant>
#include <vector>

#include "base/vec.h"
#include "case/spec.h"
#include "motion/motion_state.h"
#include "motion/second_order.h"

namespace tailwater {

/// dx; lower waves are not resolved: the surface is known to about half a spacing.
inline constexpr double lowest_resolved_wave = 2.0;

/// One long wave, and the plate that moves with its water: D.G. Goring (1979). A solitary wave has Rayleigh's shape: K.
/// Guizien, E. Barthelemy (2002). An N-wave has a trough as deep as the crest that follows it: S. Tadepalli, C.E.
/// Synolakis (1994).
class LongWave {
 public:
  LongWave(WaveKind kind, double height, double depth, double gravity);

  double stroke(double since) const;
  double elevation(double since, double ahead) const;

 private:
  /// beta (c t - X), with t = 0 at the crest, or in the middle of an N-wave: the plate's place in the wave.
  double phase(double since) const;
  double displacement(double phase) const;
  double elevation_at(double phase) const;

  bool is_solitary_;
  double height_, depth_;
  double celerity_;  ///< m/s
  double beta_;      ///< 1/m
  double first_phase_;
};

/// A sum of sines, which grow from rest.
class PeriodicWaves {
 public:
  /// `gauge` [m] is the distance from the plate at which the elevation is evaluated.
  PeriodicWaves(const WaveMakerTable& maker, double gravity, double gauge);

  double stroke(double since) const;
  double elevation(double since, double ahead) const;

 private:
  struct Sine {
    double omega;
    double wave_number;
    double phase;
    double stroke;      ///< m; amplitude of the plate at the still water's level
    double elevation;   ///< m; amplitude of the wave
    double near_field;  ///< elevation that stays near the plate, over the plate's displacement
  };

  /// The bound waves of second order, and the motion that makes no free waves beside them.
  void add_second_order(const WaveMakerTable& maker, double gravity);

  double ramp_;
  std::vector<Sine> sines_;
  std::vector<SecondOrderWave> second_order_;
};

/// The motion of one plate along itself, in the theory of its waves alone.
class MakerLaw {
 public:
  /// `gauge` [m] is the distance in front of the plate at which the elevation is evaluated.
  MakerLaw(const WaveMakerTable& maker, double gravity, double gauge);

  /// The displacement [m] of the plate at the still water's level, towards the water.
  double stroke(double time) const;
  /// The elevation [m] of its own waves at the gauge.
  double elevation(double time) const;

  /// Gain of the absorption [1/s]: speed [m/s] of the plate at the still water level per metre of elevation of other
  /// waves.
  double gain() const { return gain_; }
  /// Rate [1/s] at which the displacement by absorption decays.
  double forgetting() const { return forgetting_; }

 private:
  double start_;
  double gauge_;
  double gain_;
  double forgetting_;
  std::variant<std::monostate, LongWave, PeriodicWaves> waves_;
};

/// The plate of a table.
template <int Dim>
struct WavePlate {
  /// Throws InputError for a plate that does not reach from the bed above the still water, and for waves that break.
  WavePlate(const CaseSpec& spec, const WaveMakerTable& maker);

  Vec<Dim> foot;     ///< m; on the bed, halfway along the plate
  Vec<Dim> forward;  ///< towards the water
  Vec<Dim> up;
  Vec<Dim> along;  ///< 3D; across both
  double width;    ///< m; along `along`; 1 in 2D
  double depth;    ///< m; of the still water
  double gauge;    ///< m; where the elevation is read, in front of the plate
  bool turns;      ///< about its foot
  bool absorbs;
  MakerLaw law;

  /// The displacement [m] at the still water's level.
  double stroke(double time, const MakerState& state) const { return law.stroke(time) + state.at(time); }
};

}  // namespace tailwater
