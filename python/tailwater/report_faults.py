"""Faults that make a number unreliable: a leak, a missed level, energy that rose, an unfinished run, an answer that
still changes, a single spacing."""

import math
import re

from .case_differences import differing_keys
from .errors import DataError
from .input_file import LARGEST_TABLE, read_text
from .readings import rise_at_end
from .study import number, quantities_of

__all__ = ["SEVERAL_PROGRAMS", "UNFINISHED", "energy_of", "faults_of", "warnings_of", "water_of"]

LEAK = 1e-3  # of the initial water and inflow
MIN_SPACINGS = 3
MIN_READINGS = 10  # of a probe in the time over which its result is taken
UNFINISHED, SEVERAL_PROGRAMS = "unfinished", "its runs were made by programs of different commits"
START_STEPS = 10  # in which water that is released at once finds its pressure
AT_END = 0.05  # of the range of the readings; a largest value that the end of the run raises by more is still rising
RISING, FALLING = (f"the answer was still {word} at the end of the run" for word in ("rising", "falling"))
MAX_KEYS = 3  # differing keys that a fault names
# Warnings of the program, found by words of its messages (a test checks that the sources still contain them).
MESSAGES = {"the energy rose": re.compile(r"energy rose"),
            "the water is too dense or too light": re.compile(r"mean density of the water"),
            "particles pile up": re.compile(r"particles pile up"),
            "a level is not held": re.compile(r"not hold its level|level at .* not held"),
            "an open end does not deliver the prescribed discharge": re.compile(r"(brings|draws|passes) (less|more) water than")}


def water_of(summary):
    """The water balance [m^3], also relative to the initial water and inflow."""
    balance = summary.get("water_balance")
    if not balance:
        return {}
    volume = {name: balance[name]["volume_m3"] for name in ("start", "in", "inside", "outside", "out")}
    total = volume["start"] + volume["in"]
    missing = total - volume["inside"] - volume["outside"] - volume["out"]
    # Water that is outside temporarily counts as well.
    particles = max(summary["particles"]["fluid"], 1)
    outside = max(volume["outside"], summary["volume"]["outside_the_walls_most"] / particles * volume["inside"])
    return volume | {"missing": missing, "missing_relative": missing / total if total else 0.0,
                     "outside_most": outside, "outside_relative": outside / total if total else 0.0,
                     "density_error_mean": summary["volume"]["density_error_mean"],
                     "density_error_rms": summary["volume"]["density_error_rms"],
                     "ends": balance["inlets"] + balance["outlets"]}


def energy_of(summary):
    """The energy balance [J], and its largest rise relative to the initial energy."""
    energy = summary.get("energy")
    return dict(energy) if energy else {}


def change_of(run, answer):
    """[(kind, details)] of an answer that is a mean and still changes at the end of the run."""
    what = words_of(run, answer)
    return [("the answer is not steady", what)] if "still" in what else []


def start_of(run, answer):
    """[(kind, details)] of an answer that is a largest value of the first steps, unless the mean has about its size."""
    time = re.match(r"at ([\d.e+-]+) s", words_of(run, answer))
    is_last = time and float(time[1]) >= 0.999 * run.summary["time_s"]["reached"]
    if not time or is_last or float(time[1]) > START_STEPS * run.summary["steps"]["dt_mean_s"]:
        return []
    quantities = run.results[answer["probe"]]["quantities"]
    one = next(one for one in quantities if one["name"] == answer["quantity"])
    mean = math.hypot(*(other["value"] for other in quantities
                        if other["unit"] == one["unit"] and "second half" in other["what"]))
    if mean > 0.95 * abs(one["value"]):
        return []
    return [("the answer is a value of the start, when all water is released at once", one["what"])]


def end_of(run, answer):
    """[(kind, details)] of an answer that is a largest or least value, and that still rises or falls at the end."""
    rise = rise_at_end(run, answer["probe"], answer["quantity"])
    where = f"the last reading is {100 * abs(rise):.2g} % of the range beyond the others; remedy: a later time.end"
    return [(RISING if rise > 0 else FALLING, where)] if abs(rise) > AT_END else []


def words_of(run, answer) -> str:
    """The words of the summary on the answer, such as "mean of the second half"; "" if there are none."""
    quantities = run.results.get(answer["probe"], {}).get("quantities", [])
    return next((one["what"] for one in quantities if one["name"] == answer["quantity"]), "")


def times_of_readings(run, probe):
    """The times [s] at which a probe was read; None without its table."""
    try:
        lines = read_text(run.path / "probes" / f"{probe}.csv", LARGEST_TABLE).splitlines()[1:]
        return sorted({float(line.partition(",")[0]) for line in lines if line and not line.startswith("#")})
    except (DataError, ValueError):
        return None


def readings_of(run, answer):
    """[(kind, details)] of an answer for which a probe was never read, or too seldom. The value of the last reading needs
    no others, as of a profile at one time."""
    probe = answer["probe"]
    found = {quantity for name, quantity in quantities_of(run) if name == probe}
    if not found or (answer["quantity"] and answer["quantity"] not in found):
        return [("the answer has no result", f"too few readings of the probe '{probe}', or none")]
    times, words = times_of_readings(run, probe), words_of(run, answer)
    is_of_the_end = times and times[-1] > 0 and words == f"at {times[-1]:.4g} s"
    is_of_each_step = times and len(times) > run.summary.get("steps", {}).get("count", 0)
    if not times or not words or is_of_the_end or is_of_each_step:
        return []
    is_mean = "second half" in words
    start = 0.5 * run.summary["time_s"]["reached"] if is_mean else 0.0
    count = sum(time >= start for time in times)
    where = f"{count} of the probe '{probe}' in the {'second half of the ' if is_mean else ''}run"
    return [("the answer has too few readings", where)] if count < MIN_READINGS else []


def faults_of_run(run, answer):
    """[(kind, details)] of one run."""
    summary = run.summary
    if run.status != "done":
        reached, end = summary.get("time_s", {}).get("reached"), run.case["time"]["end"]
        place = f"at t = {reached:.4g} of {end:.4g} s" if reached is not None else f"before t = {end:.4g} s"
        return [(f"a run is {UNFINISHED}", f"{run.status} {place}")]
    water, found = water_of(summary), [
        *readings_of(run, answer), *change_of(run, answer), *start_of(run, answer),
        *end_of(run, answer)] if answer else []
    if water["outside_relative"] > LEAK:
        found.append(("water leaks", f"{100 * water['outside_relative']:.3g} % left the walls"))
    if abs(water["missing_relative"]) > LEAK:
        found.append(("the water balance does not close", f"{100 * water['missing_relative']:.3g} % is unaccounted for"))
    for end in water["ends"]:
        miss = end.get("level_missed")
        if miss and miss["for_s"] > 0:
            found.append(("a level is not held", f"'{end['name']}', off by {abs(miss['by_m']):.3g} m for {miss['for_s']:.3g} s"))
    told = {kind for kind, _ in found}
    for kind, words in MESSAGES.items():
        if kind not in told and any(words.search(warning) for warning in summary["warnings"]):
            found.append((kind, detail_of(kind, summary)))
    return found


def detail_of(kind, summary):
    if kind == "the energy rose":
        energy = summary["energy"]
        return f"by {energy['largest_rise_J']:.3g} J, {100 * energy['largest_rise_over_start']:.3g} % of the start"
    if kind == "the water is too dense or too light":
        return f"by {100 * summary['volume']['density_error_mean']:.2g} % on average"
    return ""


def difference_of(roles):
    """A fault of the runs of a study that differ in other keys than a study varies; "" if there is none."""
    found = differing_keys(roles)
    if not found:
        return ""
    keys = [f"{key} = {' and '.join(map(short, values))}" for key, values in list(found.items())[:MAX_KEYS]]
    more = f", and {len(found) - MAX_KEYS} more keys" if len(found) > MAX_KEYS else ""
    return f"its runs are of different cases ({', '.join(keys)}{more})"


def short(value):
    """A value for a fault; long lists and texts are cut off."""
    text = "nothing" if value is None else number(value) if isinstance(value, float) else str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def faults_of(study_fault, roles, is_study, answer=None) -> list:
    """Reasons why the number is not reliable, one for each kind of fault; empty if no fault was detected. A fault of
    any run of a study counts, because the interval is computed from all runs. A value that still rises or falls must do
    so in most runs, because the last reading of one run may be the largest by chance. `roles` are (role, Run); `answer`
    has the probe and the quantity of the number, "" for any; it is empty for a case without probes."""
    runs = [run for _, run in roles]
    faults = [study_fault] if study_fault else []
    if not answer:
        faults.append("the case has no probe, so there is no number; remedy: add a [[probe]] and run it again")
    kinds = {}
    for run in runs:
        for kind, detail in faults_of_run(run, answer):
            kinds.setdefault(kind, []).append((run.spacing, detail))
    for kind, where in kinds.items():
        if kind in (RISING, FALLING) and 2 * len(where) <= len(runs):
            continue
        detail = next((detail for _, detail in where if detail), "")
        spacings = ", ".join(number(spacing) for spacing in sorted({spacing for spacing, _ in where}))
        faults.append(kind + (f" ({detail})" if detail else "") + (f" at the spacing {spacings} m" if is_study else ""))
    if len({run.summary["commit"] for run in runs if "commit" in run.summary}) > 1:
        faults.append(SEVERAL_PROGRAMS)
    if difference := difference_of(roles):
        faults.append(difference)
    if not is_study:
        faults.append("one spacing only, so its uncertainty is unknown")
    elif len({run.spacing for run in runs if run.status == "done"}) < MIN_SPACINGS:
        faults.append(f"fewer than {MIN_SPACINGS} finished spacings, so its uncertainty is unknown")
    return faults


def warnings_of(roles) -> list:
    """Each warning once, with the spacings of the runs that have it."""
    found = {}
    for _, run in roles:
        for warning in run.summary.get("warnings", []):
            found.setdefault(warning, []).append(run.spacing)
    return [{"message": warning, "spacings_m": sorted(set(spacings))} for warning, spacings in found.items()]
