"""The benchmarks of the modules: runs the program bench_modules (benchmarks/) and reads what Google Benchmark writes."""

import json
import subprocess

from tailwater.errors import DataError

from .metric import Metric
from .speed_runs import WATERS, exponent

# The yardstick of the pressure solve, and the benchmarks that are measured by it.
PRODUCT = "pressure/product"
SOLVES = {"pressure/set_up": "set-up and first iteration", "pressure/cold": "cold solve to 1e-6, set-up included",
          "pressure/step": "both solves of a step"}
COLD_BARS = {2: 55, 3: 40}  # products
BYTES = {"all": "all that a flow holds between steps", "pairs": "pairs", "pair_vectors": "pair vectors",
         "matrix": "weights of the matrix"}


def times(result):
    """{benchmark: (CPU s, counters)}, the shortest of the repetitions. `result` is Google Benchmark's JSON; the
    times are measured by the benchmarks themselves."""
    found = {}
    units = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}
    for entry in result["benchmarks"]:
        if entry.get("run_type", "iteration") != "iteration":
            continue
        if entry.get("error_occurred"):
            raise DataError(f"{entry['name']}: {entry.get('error_message', 'failed')}")
        name = entry["run_name"].removesuffix("/manual_time")
        seconds = entry["real_time"] * units[entry["time_unit"]]
        if name not in found or seconds < found[name][0]:
            found[name] = (seconds, entry)
    return found


def run(program, arguments, min_time, repetitions):
    command = [str(program), *arguments, "--benchmark_format=json", f"--benchmark_min_time={min_time:g}",
               f"--benchmark_repetitions={repetitions}"]
    told = subprocess.run(command, capture_output=True, text=True, check=False)
    if told.returncode != 0:
        raise DataError(" ".join(told.stderr.split()).removeprefix("error: ") or f"exit code {told.returncode}")
    return json.loads(told.stdout)


def require_same_commit(result, commit):
    told = json.loads(result["context"]["provenance"])["commit"]
    if told != commit:
        raise DataError(f"bench_modules was built at commit {told}, the program at {commit}; remedy: build both")


def metrics_of(label, dimension, result):
    """The numbers of one flow. `label` names its size."""
    context, found = result["context"], times(result)
    fluid = int(context["fluid"])

    def metric(name, what, unit, value, high=None):
        return Metric(f"modules.{label}.{name}", f"{label}, {what}", unit, "", high=high, value=value)

    metrics = [metric(name, name, "ns per fluid particle", 1e9 * seconds / fluid)
               for name, (seconds, _) in found.items()]
    if PRODUCT in found:
        product, counters = found[PRODUCT]
        metrics.append(metric("pressure/product.bandwidth", "product: bytes of the matrix over its time", "GB/s",
                              1e-9 * counters["bytes"] / product))
        for name, what in SOLVES.items():
            if name in found:
                seconds, counters = found[name]
                metrics += [metric(f"{name}.products", what, "products", seconds / product,
                                   COLD_BARS[dimension] if name == "pressure/cold" else None),
                            metric(f"{name}.iterations", what, "iterations", counters["iterations_of_solve"])]
    if "step/whole" in found:
        metrics.append(metric("step/whole.iterations", "whole step", "iterations",
                              found["step/whole"][1]["iterations_per_step"]))
    metrics.append(metric("pairs", "pairs", "per fluid particle", int(context["pairs"]) / fluid))
    metrics += [metric(f"bytes.{name}", what, "bytes per fluid particle", float(context[f"bytes.{name}"]) / fluid)
                for name, what in BYTES.items()]
    return metrics


def growth(dimension, results):
    """Exponents of all benchmarks over the number of fluid particles."""
    found = [(int(result["context"]["fluid"]), times(result)) for result in results]
    shared = [name for name in found[0][1] if all(name in other for _, other in found)]
    sizes = [fluid for fluid, _ in found]
    return [Metric(f"modules.{dimension}D.{name}.exponent", f"{dimension}D, {name}: growth with particles", "exponent",
                   "", value=exponent(sizes, [other[name][0] for _, other in found])) for name in shared]


def machine(result):
    """Memory bandwidth and operations per second of one core."""
    return [Metric(name, f"{name}, one core", unit, "", value=1e-9 * entry[counter] / seconds)
            for name, (seconds, entry) in times(result).items()
            for counter, unit in (("bytes", "GB/s"), ("operations", "GFlop/s")) if counter in entry]


def measure(program, level, commit, settings, say):
    """Yields the numbers of the modules, flow by flow. Throws DataError if the program fails."""
    say("the machine")
    yield machine(run(program, ["machine"], level.min_time, level.repeats))
    for dimension, sizes in level.modules.items():
        results = []
        for particles in sizes:
            water = WATERS[dimension]
            say(f"modules, {dimension}D, {particles:g} particles")
            words = ["--steps", str(level.steps)]
            for setting in (*settings, *water.at(water.spacing(particles)), "particles.jitter=0.1"):
                words += ["--set", setting]
            results.append(run(program, [str(water.case), *words], level.min_time, level.repeats))
            require_same_commit(results[-1], commit)
            yield metrics_of(f"{dimension}D {particles:g}", dimension, results[-1])
        if len(sizes) > 1:
            yield growth(dimension, results)
