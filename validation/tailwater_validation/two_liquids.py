"""Errors of runs of two liquids in cases/liquids against theory. As in exact_flows.py, each function takes a Run and
returns its numbers by name."""

import numpy as np

from . import exact_flows
from .profiles import rms

SETTLED = 0.5  # fraction of a run after which layers from disordered particles count as at rest


def layered_tank(run):
    """From the second half of the run: pressure_error, the rms error over the pressure on the floor; speed, rms over
    sqrt(g H); and mixed_fraction, the fraction of the volume whose neighbours are mostly of another liquid."""
    depth, ratio = run.parameters["H"], run.parameters["ratio"]
    interface = 0.52 * depth
    on_floor = 1000 * run.gravity * (depth - interface + ratio * interface)
    errors, speeds = [], []
    frames = exact_flows.frames(run)
    for frame in (frame for frame in frames if frame.time >= SETTLED * frames[-1].time):
        pressure, velocity = exact_flows.fields(run, frame, "pressure", "velocity")
        y = frame.position[:, 1].astype(float)
        exact = 1000 * run.gravity * np.where(y > interface, depth - y, depth - interface + ratio * (interface - y))
        errors.append(rms(pressure - exact) / on_floor)
        speeds.append(rms(np.linalg.norm(velocity, axis=1)) / np.sqrt(run.gravity * depth))
    return {"pressure_error": float(np.mean(errors)), "speed": float(np.mean(speeds)),
            "mixed_fraction": max(liquid["mixed_fraction"] for liquid in run.summary["liquids"])}


def mode(run):
    """Times (s), and the amplitude (m/s) in each frame of the vertical velocity cos(k x) of two layers of the depth h
    between lids, by least squares."""
    k, h = run.parameters["k"], run.parameters["h"]
    times, amplitudes = [], []
    for frame in exact_flows.frames(run):
        velocity, = exact_flows.fields(run, frame, "velocity")
        x, y = frame.position[:, :2].astype(float).T
        shape = np.sinh(k * np.minimum(y, 2 * h - y)) / np.sinh(k * h) * np.cos(k * x)
        times.append(frame.time)
        amplitudes.append((shape * velocity[:, 1]).sum() / (shape**2).sum())
    return np.array(times), np.array(amplitudes)


def zeros(times, values):
    """Times at which a curve of straight lines is 0."""
    k = np.flatnonzero(values[:-1] * values[1:] < 0)
    return times[k] + (times[k + 1] - times[k]) * values[k] / (values[k] - values[k + 1])


def internal_wave(run):
    """period_error: from the zeros of the mode's velocity, from the first to the last, less 1. height_error: its
    amplitude at the last extreme over that of the start, less 1."""
    times, amplitudes = mode(run)
    at = zeros(times, amplitudes)
    period = 2 * (at[-1] - at[0]) / (len(at) - 1)
    last = np.abs(amplitudes[times > at[-2]]).max()
    return {"period_error": float(period * run.parameters["omega"] / (2 * np.pi) - 1),
            "height_error": float(last / abs(amplitudes[0]) - 1)}


def rayleigh_taylor(run):
    """growth_error: the mode grows as V cosh(sigma t); sigma by its amplitude at the end, over theory, less 1."""
    times, amplitudes = mode(run)
    return {"growth_error": float(np.arccosh(amplitudes[-1] / amplitudes[0]) / times[-1] / run.parameters["sigma"] - 1)}


def lock_exchange(run):
    """froude_error: the speed of the front of the brine from one depth to two depths behind the gate, over the
    1/2 sqrt(g' H) of Benjamin (1968), J. Fluid Mech. 31, 209, less 1; g' = g (1 - ratio) as the brine feels it."""
    depth, gate = run.parameters["H"], 0.5 * run.parameters["L"]
    front = run.curve("front", "front_m")
    between = (front.value > gate + depth) & (front.value < gate + 2 * depth)
    speed = np.polyfit(front.time[between], front.value[between], 1)[0]
    exact = 0.5 * np.sqrt(run.gravity * (1 - run.parameters["ratio"]) * depth)
    return {"froude_error": float(speed / exact - 1)}


FLOWS = {"layered-tank": layered_tank, "internal-wave": internal_wave, "rayleigh-taylor": rayleigh_taylor,
         "lock-exchange": lock_exchange}
