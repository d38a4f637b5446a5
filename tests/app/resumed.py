"""Comparison of a resumed run with an uninterrupted one."""

import copy
import json

# Values that depend on the machine and its clock.
TIMINGS = {"cost": None, "ranks": ("exchange_share", "reduction_share")}
CLOCK_COLUMNS = ("exchange_share", "reduction_share")


def without_timings(summary):
    """A copy of a summary without values that differ from run to run of the same case."""
    summary = copy.deepcopy(summary)
    for block, keys in TIMINGS.items():
        if keys is None:
            del summary[block]
        else:
            for key in keys:
                summary[block].pop(key, None)
    return summary


def results(run):
    """All results of a run except checkpoints and log, by name: bytes, or numbers where timings are removed."""
    found = {}
    for path in sorted(run.rglob("*")):
        name = str(path.relative_to(run))
        if path.is_dir() or name.startswith("checkpoints/") or name == "log.txt":
            continue
        if name == "summary.json":
            found[name] = without_timings(json.loads(path.read_text()))
        elif name == "ranks.csv":
            head, *rows = (line.split(",") for line in path.read_text().splitlines())
            kept = [k for k, column in enumerate(head) if column not in CLOCK_COLUMNS]
            found[name] = [[row[k] for k in kept] for row in (head, *rows)]
        else:
            found[name] = path.read_bytes()
    return found


def assert_same_results(test, run, other, apart_from=()):
    """Asserts bit-identical results, except for the keys `apart_from` of the summary. The message names the first file
    that differs, without its bytes."""
    a, b = results(test.folder / run), results(test.folder / other)
    for summary in (a["summary.json"], b["summary.json"]):
        for key in apart_from:
            del summary[key]
    test.assertEqual(a.keys(), b.keys())
    for name in a:
        if isinstance(a[name], bytes):
            test.assertTrue(a[name] == b[name], f"{name} of {run} differs from that of {other}")
        else:
            test.assertEqual(a[name], b[name], f"{name} of {run} and {other}")
