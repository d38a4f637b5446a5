// The named alternatives that a case file can select. Each enumeration lists its names here, once, in the order of its
// enumerators; the reader, the effective case, the error messages and the help all use this list.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tailwater {

enum class BlockShape { box, polygon, fill, mesh };
enum class WallShape { polyline, polygon, box, mesh, plate };
enum class FluidSide { left, right, inside, outside, above, below, front, back };
enum class Slip { free, no_slip, partial };
enum class Turbulence { none, spalart_allmaras };
enum class AirPockets { none, adiabatic, isothermal };
enum class AxisDirection { minus_x, plus_x, minus_y, plus_y, minus_z, plus_z };
enum class MakerType { piston, flap };
enum class WaveKind { regular, solitary, jonswap, none };
enum class Absorption { none, active };
enum class GateMotion { speed, acceleration, file };

enum class SchemeName { farzin2014, farmani2020 };
enum class Formulation { robust, published };
enum class Integrator { explicit_projection, implicit_projection };

enum class PairVectors { kernel, corrected, corrected_to_surface };
enum class DivergenceFree { start, midway };
enum class Displacement { new_velocity, mean_velocity };

enum class KrylovMethod { automatic, bicgstab, gmres, fgmres };
enum class PreconditionerName { automatic, ssor, cell_multigrid, ilu, boomeramg, gamg, jacobi };

enum class ProbeType {
  depth,
  wall_pressure,
  wall_pressure_mean,
  front,
  profile,
  pressure,
  velocity,
  energy,
  volume,
  discharge,
  force,
  pressure_map,
  motion,
  run_up,
  level_map,
  velocity_profile,
  pockets,
};

template <class Enumeration>
struct Choices;

template <>
struct Choices<BlockShape> {
  static constexpr std::array<std::string_view, 4> names{"box", "polygon", "fill", "mesh"};
};
template <>
struct Choices<WallShape> {
  static constexpr std::array<std::string_view, 5> names{"polyline", "polygon", "box", "mesh", "plate"};
};
template <>
struct Choices<FluidSide> {
  static constexpr std::array<std::string_view, 8> names{"left",  "right", "inside", "outside",
                                                         "above", "below", "front",  "back"};
};
template <>
struct Choices<Slip> {
  static constexpr std::array<std::string_view, 3> names{"free", "no-slip", "partial"};
};
template <>
struct Choices<Turbulence> {
  static constexpr std::array<std::string_view, 2> names{"none", "spalart-allmaras"};
};
template <>
struct Choices<AirPockets> {
  static constexpr std::array<std::string_view, 3> names{"none", "adiabatic", "isothermal"};
};
template <>
struct Choices<AxisDirection> {
  static constexpr std::array<std::string_view, 6> names{"-x", "+x", "-y", "+y", "-z", "+z"};
};
template <>
struct Choices<MakerType> {
  static constexpr std::array<std::string_view, 2> names{"piston", "flap"};
};
template <>
struct Choices<WaveKind> {
  static constexpr std::array<std::string_view, 4> names{"regular", "solitary", "jonswap", "none"};
};
template <>
struct Choices<Absorption> {
  static constexpr std::array<std::string_view, 2> names{"none", "active"};
};
template <>
struct Choices<GateMotion> {
  static constexpr std::array<std::string_view, 3> names{"speed", "acceleration", "file"};
};
template <>
struct Choices<SchemeName> {
  static constexpr std::array<std::string_view, 2> names{"farzin2014", "farmani2020"};
};
template <>
struct Choices<Formulation> {
  static constexpr std::array<std::string_view, 2> names{"robust", "published"};
};
template <>
struct Choices<Integrator> {
  static constexpr std::array<std::string_view, 2> names{"explicit", "implicit"};
};
template <>
struct Choices<PairVectors> {
  static constexpr std::array<std::string_view, 3> names{"kernel", "corrected", "corrected-to-surface"};
};
template <>
struct Choices<DivergenceFree> {
  static constexpr std::array<std::string_view, 2> names{"start", "midway"};
};
template <>
struct Choices<Displacement> {
  static constexpr std::array<std::string_view, 2> names{"new-velocity", "mean-velocity"};
};
template <>
struct Choices<KrylovMethod> {
  static constexpr std::array<std::string_view, 4> names{"auto", "bicgstab", "gmres", "fgmres"};
};
template <>
struct Choices<PreconditionerName> {
  static constexpr std::array<std::string_view, 7> names{"auto",      "ssor", "cell-multigrid", "ilu",
                                                         "boomeramg", "gamg", "jacobi"};
};
template <>
struct Choices<ProbeType> {
  static constexpr std::array<std::string_view, 17> names{"depth",
                                                          "wall-pressure",
                                                          "wall-pressure-mean",
                                                          "front",
                                                          "profile",
                                                          "pressure",
                                                          "velocity",
                                                          "energy",
                                                          "volume",
                                                          "discharge",
                                                          "force",
                                                          "pressure-map",
                                                          "motion",
                                                          "run-up",
                                                          "level-map",
                                                          "velocity-profile",
                                                          "pockets"};
};

/// Faces of an axis-parallel box, by the direction of their outward normal; in 2D the first four.
inline constexpr std::array<std::string_view, 6> box_face_names{"-x", "+x", "-y", "+y", "-z", "+z"};

/// Fields of the particles that can be written for ParaView.
inline constexpr std::array<std::string_view, 6> field_names{"pressure",        "velocity",       "density_error",
                                                             "is_free_surface", "eddy_viscosity", "id"};

template <class Enumeration>
constexpr std::string_view name_of(Enumeration value) {
  return Choices<Enumeration>::names[static_cast<std::size_t>(value)];
}

}  // namespace tailwater
