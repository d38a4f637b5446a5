"""One number that is compared with a target."""

import math
from dataclasses import dataclass, replace

from tailwater.errors import DataError


@dataclass(frozen=True)
class Metric:
    """One number of a comparison. `value` is None if it could not be computed; `note` then contains the reason. RMS
    differences from laboratory curves also have the value with the best shift in time of the measured curve, and
    that shift. `paper` is the value that the case's paper reports for its own code, `peers` are values of other
    codes: (name, lowest, highest). An error from several spacings has its observed `order`, and from three or more
    also an `uncertainty`, in both directions. `met_because` is the reason why a value outside of its target counts
    as met."""

    name: str
    what: str
    unit: str
    against: str
    low: float | None = None
    high: float | None = None
    value: float | None = None
    shifted_value: float | None = None
    shift: float | None = None
    shift_unit: str = "T"
    order: float | None = None
    uncertainty: float | None = None
    note: str = ""
    met_because: str = ""
    paper: float | None = None
    peers: tuple | None = None

    @property
    def verdict(self):
        """Result of the value alone."""
        if self.low is None and self.high is None:
            return ""
        return "met" if self.met_because else result_of(self.value, self.low, self.high)

    @property
    def result(self):
        """Result of the value with its uncertainty: "met", "missed" or "not resolved"."""
        return self.verdict if self.verdict == "" or self.met_because else result_of(self.value, self.low, self.high,
                                                                                     self.uncertainty)


RESULTS = ("met", "missed", "not resolved")


def result_of(value, low, high, uncertainty=None):
    """"met" or "missed" if the interval is inside or outside the target; "not resolved" if it contains a bound of
    the target."""
    if value is None or not math.isfinite(value):
        return "missed"
    least, most = -math.inf if low is None else low, math.inf if high is None else high
    half = uncertainty or 0.0
    if least <= value - half and value + half <= most:
        return "met"
    return "missed" if value + half < least or value - half > most else "not resolved"


def shown(metric):
    """The value of a metric's record, with its uncertainty if there is one."""
    if metric["value"] is None:
        return "-"
    return f"{metric['value']:.3g}" + (f" ± {metric['uncertainty']:.2g}" if metric.get("uncertainty") is not None else "")


def bar(low, high):
    """A target as text, such as "0.6..0.66", "<= 0.05" or ">= 1.5"; empty if there is none."""
    if None not in (low, high):
        return f"{low:g}..{high:g}"
    return f"<= {high:g}" if high is not None else f">= {low:g}" if low is not None else ""


def measure(metric, compute):
    """The metric with the value, or the dict of several fields, that `compute()` returns; with the reason instead if
    the value cannot be computed."""
    try:
        found = compute()
    except DataError as error:
        return replace(metric, note=str(error))
    return replace(metric, **(found if isinstance(found, dict) else {"value": found}))
