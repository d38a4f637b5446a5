// Walls that would have to pull the water, as a part of a flow. Walls hold water only up to physics.tension; beyond it
// the water separates, as if air came in. Where no air can come in, as in a full conduit, the flow is then wrong. The
// part follows the pressure that the water would have if walls held it, and warns at the end of a run in which a large
// part of a wall should have pulled. It does not change the flow. A run that is resumed begins anew.
#pragma once

#include <cstdint>
#include <unordered_map>

#include "flow/flow.h"
#include "flow/part.h"

namespace tailwater {

/// Walls that should have pulled.
template <int Dim>
struct Pull {
  double area = 0.0;                  ///< m^(Dim-1)
  double tension = 0.0;               ///< Pa; largest mean over the time with water
  Vec<Dim> where = Vec<Dim>::Zero();  ///< m; there
};

template <int Dim>
class PulledWalls final : public Part<Dim> {
 public:
  explicit PulledWalls(const CaseSpec& spec);

  /// The walls whose mean tension is more than half of the mean pressure on all walls. Collective.
  Pull<Dim> find(const Flow<Dim>& flow) const;

  std::string_view name() const override { return "pulled_walls"; }
  void see_tension(const Flow<Dim>& flow, std::span<const double> pressure,
                   const std::vector<double>& allowed) override;
  void finish_step(Flow<Dim>& flow, const StepStart<Dim>& start, double dt) override;
  void warn_at_end(const Flow<Dim>& flow) const override;

 private:
  /// A wall particle with water beside it, in the present step.
  struct Reading {
    std::int32_t row;
    float pressure;  ///< Pa; above the lowest that its wall holds
  };
  struct Record {
    float wet = 0.0F;    ///< s; with water beside it
    float pulls = 0.0F;  ///< s; with a pressure below 0
    float pull = 0.0F;   ///< Pa s
  };

  double area_of(const Flow<Dim>& flow, std::size_t row) const;

  double spacing_;  ///< m
  double tension_;  ///< Pa; physics.tension
  int layers_;
  std::vector<Reading> readings_;
  std::unordered_map<std::int64_t, Record> records_;  ///< by number of the row, of this rank
  double pressed_ = 0.0;                              ///< N s; pressures above 0 times area
  double wet_ = 0.0;                                  ///< m^(Dim-1) s
  double time_ = 0.0;                                 ///< s
};

template <int Dim>
std::unique_ptr<Part<Dim>> make_pulled_walls(const CaseSpec& spec, const Setup<Dim>& setup,
                                             const Boundary<Dim>& boundary);

}  // namespace tailwater
