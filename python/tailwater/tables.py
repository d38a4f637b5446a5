"""Tables: CSV files with a header line of names that include units ("time_s", "discharge_m3_per_s")."""

from pathlib import Path

import numpy as np

from .errors import DataError
from .input_file import LARGEST_TABLE, read_text

__all__ = ["frame", "read_table", "unit_of", "without_unit"]

# Suffixes of names and their units. The longest suffix is tried first, so that "m3_per_s" is not read as "s".
UNITS = {"m3_per_s": "m^3/s", "m_per_s": "m/s", "m_s": "m/s", "rad_per_s": "rad/s", "kg_per_m3": "kg/m^3",
         "N_m_per_m": "N m/m", "N_per_m": "N/m", "Pa_s": "Pa s", "per_s": "1/s", "N_m": "N m", "m3": "m^3",
         "m2": "m^2", "Pa": "Pa", "kg": "kg", "Hz": "Hz", "rad": "rad", "deg": "deg", "bytes": "bytes", "m": "m",
         "s": "s", "J": "J", "N": "N", "W": "W", "W_per_m": "W/m"}
ENDINGS = sorted(UNITS, key=len, reverse=True)


def ending_of(name: str) -> str:
    return next((ending for ending in ENDINGS if name.endswith("_" + ending)), "")


def unit_of(name: str) -> str:
    """The unit of a column, from its name: "m" for "highest_m", "" for a number without a unit."""
    return UNITS.get(ending_of(name), "")


def without_unit(name: str) -> str:
    """The name of a column without its unit: "highest" for "highest_m"."""
    return name.removesuffix("_" + ending_of(name)) if ending_of(name) else name


def read_table(path) -> dict:
    """Reads a CSV file with one header line. Returns {name: array of doubles}. Skips lines that start with `#`, which
    hold provenance. Throws DataError, which names file and line."""
    path = Path(path)
    lines = read_text(path, LARGEST_TABLE).splitlines()
    numbered = [(n, line) for n, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if len(numbered) < 2:
        raise DataError(f"{path}: has no lines of numbers")
    names = [name.strip() for name in numbered[0][1].split(",")]
    rows = []
    for n, line in numbered[1:]:
        try:
            row = [float(cell) for cell in line.split(",")]
        except ValueError as error:
            raise DataError(f"{path}:{n}: {error}") from error
        if len(row) != len(names):
            raise DataError(f"{path}:{n}: {len(row)} numbers under {len(names)} names")
        rows.append(row)
    return dict(zip(names, np.array(rows).T))


def frame(path):
    """Reads a CSV file as a pandas.DataFrame, over `time_s` if it has this column. `attrs["units"]` has the unit of
    each column."""
    import pandas  # slow to import, and most of the package does not need it

    columns = read_table(path)
    table = pandas.DataFrame(columns)
    if "time_s" in columns:
        table = table.set_index("time_s")
    table.attrs["units"] = {name: unit_of(name) for name in columns}
    return table
