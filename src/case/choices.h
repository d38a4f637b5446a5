// The named alternatives that a case file can select. The names of an enumeration stand below it, in the order of its
// enumerators; the reader, the effective case, the error messages and the help all use this list.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace tailwater {

/// The names of an enumeration; an array where it has names.
template <class Enumeration>
inline constexpr auto choices = nullptr;

enum class BlockShape { box, polygon, fill, mesh };
template <>
inline constexpr auto choices<BlockShape> = std::to_array<std::string_view>({"box", "polygon", "fill", "mesh"});

enum class RegionShape { box, polygon, mesh };
template <>
inline constexpr auto choices<RegionShape> = std::to_array<std::string_view>({"box", "polygon", "mesh"});

enum class ZoneShape { box, polygon, walls, surface };
template <>
inline constexpr auto choices<ZoneShape> = std::to_array<std::string_view>({"box", "polygon", "walls", "surface"});

enum class PorousResistance { van_gent, ergun, coefficients };
template <>
inline constexpr auto choices<PorousResistance> = std::to_array<std::string_view>({"van-gent", "ergun",
                                                                                   "coefficients"});

enum class Rheology { newtonian, power_law, bingham, herschel_bulkley, carreau };
template <>
inline constexpr auto choices<Rheology> = std::to_array<std::string_view>({"newtonian", "power-law", "bingham",
                                                                           "herschel-bulkley", "carreau"});

enum class WallShape { polyline, polygon, box, mesh, plate };
template <>
inline constexpr auto choices<WallShape> = std::to_array<std::string_view>({"polyline", "polygon", "box", "mesh",
                                                                            "plate"});

enum class FluidSide { left, right, inside, outside, above, below, front, back };
template <>
inline constexpr auto choices<FluidSide> = std::to_array<std::string_view>({"left", "right", "inside", "outside",
                                                                            "above", "below", "front", "back"});

enum class Slip { free, no_slip, partial, coulomb };
template <>
inline constexpr auto choices<Slip> = std::to_array<std::string_view>({"free", "no-slip", "partial", "coulomb"});

enum class Beyond { channel, air };
template <>
inline constexpr auto choices<Beyond> = std::to_array<std::string_view>({"channel", "air"});

enum class Turbulence { none, spalart_allmaras };
template <>
inline constexpr auto choices<Turbulence> = std::to_array<std::string_view>({"none", "spalart-allmaras"});

enum class AirPockets { none, adiabatic, isothermal };
template <>
inline constexpr auto choices<AirPockets> = std::to_array<std::string_view>({"none", "adiabatic", "isothermal"});

enum class AxisDirection { minus_x, plus_x, minus_y, plus_y, minus_z, plus_z };
template <>
inline constexpr auto choices<AxisDirection> = std::to_array<std::string_view>({"-x", "+x", "-y", "+y", "-z", "+z"});

enum class MakerType { piston, flap };
template <>
inline constexpr auto choices<MakerType> = std::to_array<std::string_view>({"piston", "flap"});

enum class WaveKind { regular, solitary, n_wave, jonswap, focused, none };
template <>
inline constexpr auto choices<WaveKind> = std::to_array<std::string_view>({"regular", "solitary", "n-wave", "jonswap",
                                                                           "focused", "none"});
/// Whether waves have a period, at least that of the peak of their spectrum.
inline constexpr bool has_period(WaveKind waves) {
  return waves != WaveKind::none && waves != WaveKind::solitary && waves != WaveKind::n_wave;
}

enum class Absorption { none, active };
template <>
inline constexpr auto choices<Absorption> = std::to_array<std::string_view>({"none", "active"});

enum class GateMotion { speed, acceleration, file };
template <>
inline constexpr auto choices<GateMotion> = std::to_array<std::string_view>({"speed", "acceleration", "file"});

enum class SchemeName { farzin2014, farmani2020 };
template <>
inline constexpr auto choices<SchemeName> = std::to_array<std::string_view>({"farzin2014", "farmani2020"});

enum class Formulation { robust, published };
template <>
inline constexpr auto choices<Formulation> = std::to_array<std::string_view>({"robust", "published"});

enum class Integrator { explicit_projection, implicit_projection };
template <>
inline constexpr auto choices<Integrator> = std::to_array<std::string_view>({"explicit", "implicit"});

enum class PairVectors { kernel, corrected, corrected_to_surface };
template <>
inline constexpr auto choices<PairVectors> = std::to_array<std::string_view>({"kernel", "corrected",
                                                                              "corrected-to-surface"});

enum class DivergenceFree { start, midway };
template <>
inline constexpr auto choices<DivergenceFree> = std::to_array<std::string_view>({"start", "midway"});

enum class Displacement { new_velocity, mean_velocity };
template <>
inline constexpr auto choices<Displacement> = std::to_array<std::string_view>({"new-velocity", "mean-velocity"});

enum class KrylovMethod { automatic, bicgstab, gmres, fgmres };
template <>
inline constexpr auto choices<KrylovMethod> = std::to_array<std::string_view>({"auto", "bicgstab", "gmres", "fgmres"});

enum class PreconditionerName { automatic, ssor, cell_multigrid, ilu, boomeramg, gamg, jacobi };
template <>
inline constexpr auto choices<PreconditionerName> =
    std::to_array<std::string_view>({"auto", "ssor", "cell-multigrid", "ilu", "boomeramg", "gamg", "jacobi"});

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
template <>
inline constexpr auto choices<ProbeType> = std::to_array<std::string_view>(
    {"depth", "wall-pressure", "wall-pressure-mean", "front", "profile", "pressure", "velocity", "energy", "volume",
     "discharge", "force", "pressure-map", "motion", "run-up", "level-map", "velocity-profile", "pockets"});

/// Faces of an axis-parallel box, by the direction of their outward normal; in 2D the first four.
inline constexpr std::array<std::string_view, 6> box_face_names{"-x", "+x", "-y", "+y", "-z", "+z"};

/// Fields of the particles that can be written for ParaView.
inline constexpr std::array<std::string_view, 11> field_names{
    "pressure",   "velocity",  "density_error", "is_free_surface", "eddy_viscosity",
    "shear_rate", "viscosity", "liquid",        "density",         "volume",
    "id"};

template <class Enumeration>
constexpr std::string_view name_of(Enumeration value) {
  return choices<Enumeration>[static_cast<std::size_t>(value)];
}

}  // namespace tailwater
