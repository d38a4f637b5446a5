#!/usr/bin/python3
"""Kills runs at random moments, resumes them, and compares their files with those of an undisturbed run.

A dam break is run on -n ranks with frequent checkpoints. At a moment drawn at random, when its processes have worked for
--apart CPU seconds at most, it is killed by SIGKILL: alone the process, of several ranks in turn the launcher alone, mpirun alone and one rank alone.
Nothing may be left of it within --patience seconds. Every file that a reader could have opened is read: tables have
whole lines, field files and lists open, checkpoints are whole. Then `tailwater resume` goes on. At the end tables,
fields and the summary must be those of an undisturbed run, bit for bit.

    scripts/kill_study.py --kills 100
    scripts/kill_study.py --kills 30 -n 2
"""

import argparse
import os
import pathlib
import random
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/app"))

PROGRAM = ROOT / "build/release/bin/tailwater"
os.environ.setdefault("TAILWATER", str(PROGRAM))  # asked for by `program`

import fields  # noqa: E402
from processes import command_line, processes_of  # noqa: E402
from program import SMALL_CASE  # noqa: E402
from resumed import results  # noqa: E402

# Finer than the tests have it, and with checkpoints all the time.
SETTINGS = ("particles.spacing=0.04", "particles.jitter=0.1", "output.checkpoint_interval=0.2",
            "probe.energy.interval=0.01", "output.view_interval=0.05")
ENDLESS = 1e4  # s


def check_readable(out):
    """Raises if any file of the run is torn."""
    for table in [out / "steps.csv", *(out / "probes").glob("*.csv")]:
        text = table.read_text()
        lines = text.split("\n")
        if lines[-1] or len({line.count(",") for line in lines[:-1]}) != 1:
            raise AssertionError(f"{table} has a torn line")
    for series in (out / "fields").glob("*.pvd"):
        for _, path in fields.read_series(series):
            fields.read_points(path)
    for path in (out / "checkpoints").glob("*.h5"):
        head = path.read_bytes()[:512].decode()
        size = next(int(line.split()[1]) for line in head.splitlines() if line.startswith("bytes "))
        if path.stat().st_size != 512 + size:
            raise AssertionError(f"{path} is torn")


def newest_step(out):
    return max((int(path.stem.split("_")[1]) for path in (out / "checkpoints").glob("*.h5")), default=0)


def cpu_seconds(out):
    """CPU seconds of the processes of a run so far."""
    ticks = 0
    for process in processes_of(out):
        try:
            stat = pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()
        except OSError:  # it is gone
            continue
        ticks += int(stat[11]) + int(stat[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def kill(program, out, role):
    """Kills one of the processes of a run; returns its name."""
    mine = processes_of(out)
    mpirun = [process for process in mine if pathlib.Path(command_line(process)[0]).name in ("mpirun", "mpiexec")]
    others = [process for process in mine if process not in mpirun]
    if role == "mpirun" and mpirun:
        victim = mpirun[0]
    elif role == "rank" and len(others) > 1:
        victim = random.choice([process for process in others if process != program.pid])
    else:
        role, victim = "program", program.pid
    try:
        os.kill(victim, signal.SIGKILL)
    except ProcessLookupError:
        pass
    return role


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=PROGRAM, type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--apart", type=float, default=1.5, help="CPU s; longest work between a start and its kill")
    parser.add_argument("--patience", type=float, default=30.0, help="s; in which all processes must be gone")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-n", dest="ranks", type=int, default=1)
    options = parser.parse_args()

    random.seed(options.seed)
    program = options.program.resolve()
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        case, out = folder / "case.toml", folder / "run"
        case.write_text(SMALL_CASE)
        common = ["--quiet", "-n", str(options.ranks)]
        settings = [word for setting in SETTINGS for word in ("--set", setting)]
        start = [program, "run", case, "--out", out, *settings, "--set", f"time.end={ENDLESS}", *common]
        killed = {}
        started_again = 0
        for _ in range(options.kills):
            running = subprocess.Popen(start)
            moment = options.apart * random.random()
            while cpu_seconds(out) < moment and running.poll() is None:
                time.sleep(0.01)
            before = newest_step(out)
            if running.poll() is not None:
                sys.exit(f"kill_study: {start} has ended by itself, with exit code {running.returncode}")
            role = kill(running, out, random.choice(("program", "mpirun", "rank")) if options.ranks > 1 else "program")
            killed[role] = killed.get(role, 0) + 1
            deadline = time.monotonic() + options.patience
            while processes_of(out) and time.monotonic() < deadline:
                running.poll()
                time.sleep(0.02)
            left = [command_line(process) for process in processes_of(out)]
            if left:
                sys.exit(f"kill_study: after the kill of the {role} these go on: {left}")
            running.wait()
            if (out / "case.effective.toml").exists():
                check_readable(out)
                if newest_step(out) < before:
                    sys.exit("kill_study: a checkpoint was lost")
                start = [program, "resume", out, *common]
            started_again += newest_step(out) == 0
        end = 0.01 + max(float(line.split(",")[0]) for line in (out / "steps.csv").read_text().splitlines()[1:])
        subprocess.run([*start, *(["--set", f"time.end={end}"])], check=True)
        subprocess.run([program, "run", case, "--out", folder / "twin", *settings, "--set", f"time.end={end}", *common],
                       check=True)
        disturbed, twin = results(out), results(folder / "twin")
        for resumed in (disturbed, twin):
            resumed["summary.json"].pop("case")  # of a run that started again
        different = [name for name in twin if disturbed.get(name) != twin[name]]
        print(f"{options.kills} kills ({', '.join(f'{count} of the {role}' for role, count in killed.items())}), "
              f"{started_again} of them before the first checkpoint; {newest_step(out)} steps; no process left; no file "
              f"torn; results {'the same bit for bit' if not different else f'differ in {different}'}")
        sys.exit(1 if different or disturbed.keys() != twin.keys() else 0)


if __name__ == "__main__":
    main()
