"""The pictures of the gallery that are not simply the speed at the end of the template's own run."""
from typing import NamedTuple


class Picture(NamedTuple):
    """`time` [s] is that of the picture, the end without one. `colour` is one of those of `tailwater pictures`. `keys` are
    those of a run made for the picture only, for instance where the template leaves a jet of two particles. `mean_since`
    [s] asks for a mean over time, because the vortices of one instant hide the flow."""

    time: float | None = None
    colour: str = "speed"
    keys: dict = {}
    mean_since: float | None = None
    note: str = ""


PICTURES = {
    "dam-break": Picture(time=0.8),
    "dam-break-box": Picture(time=0.6),
    "tank": Picture(colour="pressure"),
    "channel": Picture(colour="pressure"),
    "weir": Picture(keys={"particles.spacing": "P/40", "time.end": 3.0}),
    "broad-weir": Picture(keys={"particles.spacing": "P/20", "time.end": 2.5}),
    "ogee": Picture(keys={"particles.spacing": "Hd/20", "time.end": 2.5}),
    "hydraulic-jump": Picture(keys={"particles.spacing": "h1/10", "time.end": 6.0, "output.fields_interval": 0.05},
                              mean_since=3.0, note="It shows a mean over time: the vortices of one instant look like stripes."),
    "spillway": Picture(time=0.7, note="In the picture the zone reaches 0.09 m below the bed.",
                        keys={"time.end": 0.71, "output.fields_interval": 0.35, "refinement.notch.min": [-0.25, -1.0, -0.09]}),
    "circulation": Picture(colour="pressure",
                           keys={"particles.spacing": "H/8", "parameters.L": "20*H", "time.end": 40.0,
                                 "case.title": "Even flow that circulates through a channel 20 depths long"},
                           note="It shows a channel of a fifth of the length."),
    "shore": Picture(time=3.6),
    "pier": Picture(time=0.6),
    "run-up": Picture(time=3.4),
    "solitary-wave": Picture(time=2.0),
    "tailings": Picture(time=9.0, keys={"particles.spacing": "H/24", "time.end": 9.2}),
    "debris-flow": Picture(time=6.0, keys={"particles.spacing": "h/16", "time.end": 6.2}),
    "concrete-slump": Picture(time=0.21,
                              keys={"particles.spacing": "a/10", "time.end": 0.22, "output.fields_interval": 0.07}),
    "lock-exchange": Picture(colour="liquid"),
    "sloshing": Picture(time=10.9, colour="pressure"),
    "floating-box": Picture(time=0.1, keys={"particles.spacing": "h/40", "time.end": 0.2}),
}
