// Rules of single tables beyond the type and range of each key: defaults that depend on other keys, and checks that
// involve several keys. Problems are reported to the reader; keys with a wrong value of their own were reported before
// and are left out.
#pragma once

#include <span>
#include <string_view>

#include "case/key_info.h"
#include "case/spec.h"
#include "case/table_reader.h"

namespace tailwater {

/// Sets the defaults that depend on the dimension or on other keys of the table, which are read ahead for this.
template <class Table>
void set_defaults(Table&, TableReader&) {}
void set_defaults(FluidTable& fluid, TableReader& reader);
void set_defaults(WallTable& wall, TableReader& reader);
void set_defaults(WaveMakerTable& maker, TableReader& reader);
void set_defaults(DampingTable& damping, TableReader& reader);
void set_defaults(BodyTable& body, TableReader& reader);
void set_defaults(InletTable& inlet, TableReader& reader);
void set_defaults(OutletTable& outlet, TableReader& reader);
void set_defaults(SchemeTable& scheme, TableReader& reader);
void set_defaults(ProbeTable& probe, TableReader& reader);
void set_defaults(PorousTable& porous, TableReader& reader);
void set_defaults(RefinementTable& zone, TableReader& reader);
void set_defaults(LiquidTable& liquid, TableReader& reader);

/// Reads the files that a sound table names. Points from a file become the table's own, and the name of a mesh file
/// becomes absolute, so that the case no longer depends on its folder.
template <class Table>
void read_linked_files(Table&, TableReader&) {}
void read_linked_files(FluidTable& fluid, TableReader& reader);
void read_linked_files(WallTable& wall, TableReader& reader);
void read_linked_files(GateTable& gate, TableReader& reader);
void read_linked_files(PorousTable& porous, TableReader& reader);
void read_linked_files(InletTable& inlet, TableReader& reader);
void read_linked_files(OutletTable& outlet, TableReader& reader);
/// The columns of the file depend on the probe, so its values are read after all tables (measurements.h).
void read_linked_files(MeasurementTable& measurement, TableReader& reader);

/// Checks a table that has been read.
template <class Table>
void check(const Table&, TableReader&) {}
void check(const DomainTable& domain, TableReader& reader);
void check(const PhysicsTable& physics, TableReader& reader);
void check(const FluidTable& fluid, TableReader& reader);
void check(const WallTable& wall, TableReader& reader);
void check(const GateTable& gate, TableReader& reader);
void check(const WaveMakerTable& maker, TableReader& reader);
void check(const BodyTable& body, TableReader& reader);
void check(const MooringTable& mooring, TableReader& reader);
void check(const DampingTable& damping, TableReader& reader);
void check(const RefinementTable& zone, TableReader& reader);
void check(const PorousTable& porous, TableReader& reader);
void check(const LiquidTable& liquid, TableReader& reader);
void check(const InletTable& inlet, TableReader& reader);
void check(const OutletTable& outlet, TableReader& reader);
void check(const ProbeTable& probe, TableReader& reader);

/// Checks that the keys needed by the chosen shape or type are given, and no others (key_use.h). `rows` are the keys of
/// the table as read, `table` its name without index.
void check_key_uses(std::string_view table, std::span<const KeyInfo> rows, TableReader& reader);

}  // namespace tailwater
