"""The probes of a run as a NetCDF file by the CF-1.8 conventions, for xarray, MATLAB and similar programs.

Each probe with a time series of numbers is a station (CF featureType timeSeries). Each column of the tables is a
variable over station and time, with its name in the table; it is NaN for probes without this column. Probes with the
same times share one time axis; otherwise each station has its own (CF, H.2.1 and H.2.2)."""

import datetime

import numpy as np

from . import tables
from .errors import DataError
from .program import version
from .whole_file import write_whole

__all__ = ["EPOCH", "write_netcdf"]

EPOCH = datetime.datetime(1970, 1, 1)
UNITS = {"": "1", "deg": "degree", "bytes": "byte"}  # names of units that differ in UDUNITS
AXES = "XYZ"
NOTHING = np.float64(np.nan)  # a double, like the variables


def series_of(run) -> dict:
    """The tables by probe, for probes with one line per time. Throws DataError if there is none."""
    found = {}
    for probe in run.case.get("probe", []):
        path = run.path / "probes" / f"{probe['name']}.csv"
        if not path.is_file():
            continue
        table = tables.read_table(path)
        if "time_s" in table and (np.diff(table["time_s"]) > 0).all():
            found[probe["name"]] = table
    if not found:
        raise DataError(f"{run.path}: no probe of the run has read numbers over time")
    return found


def place_of(probe, dimension) -> np.ndarray:
    """The position of a probe [m]: the middle of a line, NaN for a probe without a position."""
    if "at" in probe:
        place = probe["at"]
    elif "from" in probe and "to" in probe:
        place = np.mean([probe["from"], probe["to"]], axis=0)
    else:
        place = ()
    return np.pad(np.asarray(place, float), (0, dimension - len(place)), constant_values=NOTHING)


def describe(node, **attributes):
    """Sets attributes of a file or a variable; texts are UTF-8."""
    for key, value in attributes.items():
        setattr(node, key, value.encode() if isinstance(value, str) else value)


class Writer:
    """Writes variables of one file."""

    def __init__(self, file):
        self.file = file

    def variable(self, name, dimensions, values, **attributes):
        made = self.file.createVariable(name, "c" if values.dtype.kind == "S" else "d", dimensions)
        describe(made, **attributes)
        made[:] = values

    def texts(self, name, words, **attributes):
        """Writes a variable with one text per station."""
        encoded = np.array([word.encode() for word in words])
        length = f"{name}_length"
        self.file.createDimension(length, encoded.dtype.itemsize)
        self.variable(name, ("station", length), encoded.view("S1").reshape(len(words), -1), **attributes)


def write_stations(writer, run, names):
    """Writes the names, kinds and positions of the stations. Returns the names of these variables."""
    probes = {probe["name"]: probe for probe in run.case.get("probe", [])}
    writer.file.createDimension("station", len(names))
    writer.texts("station_name", names, cf_role="timeseries_id", long_name="name of the probe")
    writer.texts("station_type", [probes[name]["type"] for name in names], long_name="type of the probe")
    places = np.array([place_of(probes[name], run.dimension) for name in names])
    for axis in range(run.dimension):
        upward = {"axis": "Z", "positive": "up"} if axis == run.dimension - 1 else {"axis": AXES[axis]}
        writer.variable(AXES[axis].lower(), ("station",), places[:, axis], units="m",
                        long_name=f"{AXES[axis].lower()} of the probe, of a line its middle", **upward)
    return " ".join(["station_name", "station_type", *AXES[:run.dimension].lower()])


def write_series(file, run, series, start):
    writer = Writer(file)
    stations = write_stations(writer, run, list(series))
    times = [table["time_s"] for table in series.values()]
    length = max(map(len, times))
    is_shared = all(np.array_equal(times[0], time) for time in times)
    axis = "time" if is_shared else "observation"
    file.createDimension(axis, length)

    def padded(values):
        return np.pad(values, (0, length - len(values)), constant_values=NOTHING)

    writer.variable("time", ("time",) if is_shared else ("station", axis),
                    times[0] if is_shared else np.array([padded(time) for time in times]),
                    units=f"seconds since {start:%Y-%m-%d %H:%M:%S}", calendar="standard", standard_name="time", axis="T",
                    long_name="time since the start of the run", **({} if is_shared else {"_FillValue": NOTHING}))
    for name in dict.fromkeys(name for table in series.values() for name in table if name != "time_s"):
        unit = tables.unit_of(name)
        values = np.array([padded(table[name]) if name in table else np.full(length, NOTHING) for table in series.values()])
        writer.variable(name, ("station", axis), values, units=UNITS.get(unit, unit), _FillValue=NOTHING,
                        long_name=tables.without_unit(name).replace("_", " "), coordinates=stations if is_shared else f"time {stations}")


def source_of(run) -> str:
    """The version of the program that made a finished run; otherwise the installed version."""
    summary = run.summary
    return f"tailwater {summary['version']} (commit {summary['commit']})" if summary else version()


def write_netcdf(run, path, start):
    """`start` is the date and time at which the run's time is 0: a datetime, or an ISO 8601 text without a time zone.
    Throws DataError, IoError, and ValueError if `start` is not a date and time."""
    from scipy.io import netcdf_file  # slow to import

    if isinstance(start, str):
        start = datetime.datetime.fromisoformat(start)
    if start.tzinfo is not None:
        start = start.astimezone(datetime.timezone.utc).replace(tzinfo=None)
    series = series_of(run)

    def write(part):
        with netcdf_file(part, "w", version=2) as file:
            now = datetime.datetime.now(datetime.timezone.utc)
            describe(file, Conventions="CF-1.8", featureType="timeSeries", title=run.title,
                     source=source_of(run),
                     history=f"{now:%Y-%m-%dT%H:%M:%SZ} tailwater export of {run.path}")
            write_series(file, run, series, start)

    write_whole(path, write)
