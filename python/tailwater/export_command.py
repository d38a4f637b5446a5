"""Export a run to VTKHDF, NetCDF and a ParaView state: `tailwater export`.

Exit codes: 0 done, 2 bad input, 4 a file cannot be written."""

import argparse
import datetime
import os
import sys
from pathlib import Path

from .command_line import Parser, exit_code_of
from .netcdf import EPOCH
from .run import Run


def moment(text):
    try:
        return datetime.datetime.fromisoformat(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f'"{text}" is no time; write it as in 2026-03-01T12:00') from None


def parser():
    command = Parser("tailwater export")
    command.description = "Export a run to VTKHDF, NetCDF and a ParaView state. Existing files are replaced."
    command.epilog = "Example: tailwater export my_run --vtkhdf water.vtkhdf --netcdf gauges.nc --paraview state.py"
    command.add_argument("run", metavar="DIR", help="folder of a run, which may still be running")
    command.add_argument("--vtkhdf", type=Path, metavar="FILE", help="write all particle fields and output times to one VTKHDF "
                         "file, for ParaView 5.12 or newer (needs python3-h5py)")
    command.add_argument("--netcdf", type=Path, metavar="FILE", help="write the time series of the probes as NetCDF (CF-1.8)")
    command.add_argument("--paraview", type=Path, metavar="FILE", help="write a Python state that opens the field files in "
                         "ParaView, coloured by pressure")
    command.add_argument("--start", type=moment, default=EPOCH, metavar="TIME", help="date and time of t = 0 in the NetCDF "
                         f"file, for example 2026-03-01T12:00 ({EPOCH:%Y-%m-%d})")
    return command


def write_files(options):
    """Writes the files that the options name. Throws DataError, IoError."""
    run = Run(options.run)
    if options.netcdf:
        run.to_netcdf(options.netcdf, start=options.start)
    if options.paraview:
        run.to_paraview(options.paraview)
    if options.vtkhdf:
        run.to_vtkhdf(options.vtkhdf)


def main(arguments=None):
    command = parser()
    options = command.parse_args(arguments)
    if not (options.vtkhdf or options.netcdf or options.paraview):
        command.error("give one of --vtkhdf FILE, --netcdf FILE and --paraview FILE")
    if options.program:
        os.environ["TAILWATER"] = str(options.program)
    try:
        return exit_code_of(lambda: write_files(options))
    except KeyboardInterrupt:
        return 130


if __name__ == "__main__":
    sys.exit(main())
