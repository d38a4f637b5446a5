"""Functions common to all fuzzers: calls of the program under limits, and campaigns of many mutations."""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import resource
import signal
import subprocess

PROGRAM = os.environ["TAILWATER"]

# s of CPU time, which does not depend on other work of the machine
LONGEST = 10 * int(os.environ.get("TAILWATER_SLOWDOWN", 1))
LONGEST_WAIT = 1200  # s of elapsed time, also on a busy machine


def run_within_limits(arguments, folder):
    """(exit code, standard error) of the program. A program that takes too long is ended by a signal: SIGXCPU if it
    computes, SIGKILL if it waits."""
    program = subprocess.Popen([PROGRAM, *arguments], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               env={**os.environ, "TAILWATER_FP_TRAPS": "0"})
    resource.prlimit(program.pid, resource.RLIMIT_CPU, (LONGEST, LONGEST + 1))
    try:
        _, error = program.communicate(timeout=LONGEST_WAIT)
    except subprocess.TimeoutExpired:
        program.kill()
        _, error = program.communicate()
    return program.returncode, error.decode(errors="replace")


def look_for_findings(code, error, codes):
    """The fault of an answer of the program, or None."""
    if code in (-signal.SIGXCPU, -signal.SIGKILL):
        return "a hang"
    if code not in codes:
        return f"exit code {code}"
    lines = error.splitlines()
    if code == 0 and any(not line.startswith("warning: ") for line in lines):
        return "a message that is no warning"
    if code in (2, 3, 4) and not any(line.startswith("error: ") for line in lines):
        return "refused without a reason"
    return None


def campaign(run_one, numbers, seed, keep=None, workers=1):
    """({exit code: count}, [(number, finding)]) of `run_one(number, seed, keep)`."""
    with concurrent.futures.ThreadPoolExecutor(workers) as pool:
        results = list(pool.map(lambda number: run_one(number, seed, keep), numbers))
    codes = collections.Counter(code for code, _ in results)
    return codes, [(number, finding) for number, (_, finding) in zip(numbers, results) if finding]


def arguments(about):
    """The options of every fuzzer."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("--first", type=int, default=0, help="number of the first mutation")
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--seed", default="1")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="folder for whatever provoked a finding")
    return parser


def main(options, run_one):
    """Runs a campaign by the options of the command line; returns the exit code of the fuzzer."""
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    numbers = range(options.first, options.first + options.count)
    codes, findings = campaign(run_one, numbers, options.seed, options.keep, options.workers)
    print("exit codes:", dict(sorted(codes.items(), key=str)))
    for number, finding in findings:
        print(f"number {number}: {finding}")
    print(f"{len(findings)} findings in {options.count} mutations")
    return 1 if findings else 0
