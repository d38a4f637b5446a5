"""Tailwater from a script: free-surface water flow by incompressible SPH.

    import tailwater as tw

    case = tw.Case.template("weir")
    case["parameters.q"] = 0.06
    run = case.run("out", ranks=2)
    run.probes["upstream"]                      # a pandas.DataFrame
    run.last()["velocity"]                      # fields as arrays
    tw.sweep(case, {"particles.spacing": [0.02, 0.015, 0.01]}, jobs=2).table()
    tw.study(case, budget=600).table()          # each number with an interval
    tw.report("my_study").write("report.html")  # a page by which others can judge and reproduce it
    with case.simulation() as simulation:       # in this process
        for step in simulation:
            step.position, step.velocity, step.pressure

Numbers are in SI units; in 2D forces, masses and discharges are those of a metre of width. The guide is
docs/guide/python.md."""

from .case import Case, Check
from .curves import Curve
from .errors import DataError, Error, InputError, IoError, RunWarning, SolverError
from .fields import Frame
from .program import program, version
from .report import Report, report
from .run import Probes, Run
from .study import Study, study
from .sweep import Sweep, sweep
from .view import View

__all__ = ["Case", "Check", "Curve", "DataError", "Error", "Frame", "InputError", "IoError", "Probes", "Report", "Run",
           "RunWarning", "SolverError", "Study", "Sweep", "View", "program", "report", "study", "sweep", "version"]
