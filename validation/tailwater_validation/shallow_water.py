"""Dam breaks in the shallow-water limit: theory without friction (Ritter, Stoker), the shallow-water (Saint-Venant)
equations with the friction of a rough bed, and the errors of runs of cases/verification/{ritter,stoker}.toml against them.

Lengths over the depth h0 of the reservoir, speeds over sqrt(g h0), times over sqrt(h0/g).
"""

import math
from functools import lru_cache, partial

import numpy as np

from tailwater.errors import DataError
from tailwater.fields import list_frames, read_frame

from .profiles import profile_at, profile_table, rms

LATE = 3.0  # T = t sqrt(g/h0) from which a dam break is compared with shallow-water theory
TIP = 0.1  # of h0: depth whose place counts as the front; the tip itself is thinner than a particle
KARMAN = 0.41
DRY = 1e-7  # h0; less water than this does not move


# --------------------------------------------------------------------------------------------- without friction


def ritter(similarity):
    """Depth over h0 at x/(t sqrt(g h0)): Ritter's rarefaction onto a dry bed."""
    similarity = np.asarray(similarity, dtype=float)
    return np.where(similarity < -1, 1.0, np.where(similarity < 2, (2 - similarity) ** 2 / 9, 0.0))


def stoker_state(ahead, uneven=0.0):
    """(depth, speed of the water, speed of the bore) between rarefaction and bore, over h0 and sqrt(g h0), for a
    depth `ahead` (over h0, below 1). The bore conserves mass and momentum and dissipates energy. `uneven` is the
    excess of the momentum flux behind the bore over that of uniform flow, over g h0^2. By bisection."""
    low, high = ahead, 1.0
    for _ in range(60):
        depth = 0.5 * (low + high)
        bore = math.sqrt(depth * (0.5 * (depth + ahead) + uneven / (depth - ahead)) / ahead)
        if 2 * (1 - math.sqrt(depth)) > bore * (1 - ahead / depth):  # the rarefaction brings more than the bore takes
            low = depth
        else:
            high = depth
    return depth, 2 * (1 - math.sqrt(depth)), bore


def stoker(similarity, ahead):
    """Depth over h0 at x/(t sqrt(g h0)): Stoker's dam break onto still water of the depth `ahead`."""
    depth, speed, bore = stoker_state(ahead)
    similarity = np.asarray(similarity, dtype=float)
    return np.where(similarity > bore, ahead, np.where(similarity > speed - math.sqrt(depth), depth, ritter(similarity)))


# ------------------------------------------------------------------------ the shallow-water equations over a bed
# Finite volumes of second order (MUSCL-Hancock with HLL fluxes, Toro 2001), friction implicit.


class RoughBed:
    """A bed of roughness k_s (over h0) below growing layers: water starts with a layer of thickness k_s, which moves
    with it."""

    def __init__(self, roughness):
        self.roughness, self.y0 = roughness, roughness / 30

    def friction_velocity(self, depth, speed, layer):
        """u_tau of water that follows the logarithmic law of a rough bed up to `layer` and has a uniform velocity
        above it; `speed` is the mean over the depth."""
        layer = np.clip(layer, self.roughness, np.maximum(depth, self.roughness))
        logarithm = np.log1p(layer / self.y0)
        share = np.minimum(layer / np.maximum(depth, DRY), 1.0)
        return KARMAN * np.abs(speed) / (logarithm - share * (1 - self.y0 / layer * logarithm))

    def slow(self, depth, speed, layer, dt):
        """(speed, layer) after dt. A layer grows by kappa u_tau; its missing momentum is then the momentum lost to
        the bed."""
        u_tau = self.friction_velocity(depth, speed, layer)
        rate = u_tau**2 / np.maximum(np.abs(speed) * depth, DRY)
        return speed / (1 + dt * rate), np.minimum(layer + dt * KARMAN * u_tau, np.maximum(depth, self.roughness))


class EvenBed:
    """A bed with u_tau^2 = coefficient u^2 everywhere; layers have no effect."""

    roughness = 0.0

    def __init__(self, coefficient):
        self.coefficient = coefficient

    def slow(self, depth, speed, layer, dt):
        return speed / (1 + dt * self.coefficient * np.abs(speed) / np.maximum(depth, DRY)), layer


def fluxes(depth, speed):
    return np.array([depth * speed, depth * speed**2 + 0.5 * depth**2])


def hll(left, right):
    """Flux between the states (depth, speed) on both sides of each face; a rarefaction reaches into a dry side."""
    (hl, ul), (hr, ur) = left, right
    cl, cr = np.sqrt(hl), np.sqrt(hr)
    middle, c = 0.5 * (ul + ur) + cl - cr, np.maximum(0.5 * (cl + cr) + 0.25 * (ul - ur), 0.0)
    low = np.where(hl <= DRY, ur - 2 * cr, np.where(hr <= DRY, ul - cl, np.minimum(ul - cl, middle - c)))
    high = np.where(hr <= DRY, ul + 2 * cl, np.where(hl <= DRY, ur + cr, np.maximum(ur + cr, middle + c)))
    low, high = np.minimum(low, 0.0), np.maximum(high, 0.0)
    span = np.maximum(high - low, 1e-12)
    states = np.array([hr - hl, hr * ur - hl * ul])
    return (high * fluxes(hl, ul) - low * fluxes(hr, ur) + high * low * states) / span


def limited(values):
    """Half the slope of each cell, minmod, 0 at the ends."""
    steps = np.diff(values, axis=-1)
    slope = np.zeros_like(values)
    a, b = steps[..., :-1], steps[..., 1:]
    slope[..., 1:-1] = np.where(a * b > 0, np.sign(a) * np.minimum(np.abs(a), np.abs(b)), 0.0)
    return 0.5 * slope


def half_step(depth, speed, ratio):
    """States (depth, speed) on the left and the right side of each cell half a step later, with `ratio` = dt/dx: the
    MUSCL-Hancock method, in depth and discharge."""
    slope = limited(np.array([depth, speed]))
    sides = [np.maximum(np.array([depth, speed]) + sign * slope, [[0.0], [-np.inf]]) for sign in (-1, 1)]
    change = -0.5 * ratio * (fluxes(*sides[1]) - fluxes(*sides[0]))
    moved = []
    for h, u in sides:
        later = np.maximum(h + change[0], 0.0)
        moved.append((later, np.where(later > DRY, (h * u + change[1]) / np.maximum(later, DRY), 0.0)))
    return moved


def dam_break(ahead, bed, times, back, front, cells=2000):
    """[(x, depth, speed)] at increasing `times`: water of depth 1 over -back < x < 0 and of depth `ahead` over 0 < x
    < front, at rest at time 0, over the `bed`. The waves must not reach the ends."""
    x = (np.arange(cells) + 0.5) * (back + front) / cells - back
    dx = x[1] - x[0]
    depth, speed = np.where(x < 0, 1.0, ahead), np.zeros(cells)
    layer = np.full(cells, bed.roughness)
    now, states = 0.0, []
    for time in times:
        while now < time - 1e-12:
            dt = min(0.45 * dx / np.max(np.abs(speed) + np.sqrt(depth)), time - now)
            (hl, ul), (hr, ur) = half_step(depth, speed, dt / dx)
            flux = hll((hr[:-1], ur[:-1]), (hl[1:], ul[1:]))
            carried = flux[0] * np.where(flux[0] > 0, layer[:-1], layer[1:])
            discharge, layers, depth = depth * speed, depth * layer, depth.copy()
            for values, through in ((depth, flux[0]), (discharge, flux[1]), (layers, carried)):
                values[1:-1] -= dt / dx * np.diff(through)
            depth = np.maximum(depth, 0.0)
            wet = depth > DRY
            speed, layer = (np.where(wet, values / np.maximum(depth, DRY), dry)
                            for values, dry in ((discharge, 0.0), (layers, bed.roughness)))
            speed, layer = bed.slow(depth, speed, layer, dt)
            now += dt
        states.append((x, depth, speed))
    return states


# ----------------------------------------------------------------------------------------------- errors of runs


def time_unit(run):
    """sqrt(h0/g), s."""
    return math.sqrt(run.parameters["h0"] / run.gravity)


def late_profiles(run):
    """[(T, x/h0, depth/h0)] of a dam break from LATE on."""
    scale = time_unit(run)
    times = np.unique(profile_table(run, "surface")["time_s"])
    taken = [profile_at(run, "surface", time) for time in times]
    depth = run.parameters["h0"]
    return [(profile.time / scale, profile.x / depth, profile.connected / depth) for profile in taken
            if profile.time > (LATE - 0.01) * scale]


def slope(times, values):
    """Slope by least squares."""
    return float(np.polyfit(times, values, 1)[0])


def water_passed(run):
    """(T, water over h0^2 that has passed x = 0 since the start) from a run's frames. Particles are counted, because
    the depths of a profile include the air below the roller of a bore, and miss its spray."""
    depth, dx, scale = run.parameters["h0"], run.spacing, time_unit(run)
    frames = [read_frame(*entry) for entry in list_frames(run.path)]
    # Each is a cell that is dx wide.
    ahead = [np.clip(frame.position[:, 0] / dx + 0.5, 0.0, 1.0).sum() for frame in frames]
    return np.array([frame.time for frame in frames]) / scale, (np.array(ahead) - ahead[0]) * (dx / depth) ** 2


def late_discharge(run, since=LATE):
    """Discharge through x = 0, over sqrt(g) h0^1.5, from T = `since` on. Throws DataError for fewer than three
    frames."""
    T, passed = water_passed(run)
    late = T > since - 0.01
    if late.sum() < 3:
        raise DataError(f"{run.path}: has {late.sum()} frames from T = {since:g} on, too few for a slope")
    return slope(T[late], passed[late])


def last_place(x, depth, level):
    """The farthest x at which the depth is `level`, linear between samples."""
    above = np.flatnonzero(depth >= level)
    if above.size == 0 or above[-1] == len(x) - 1:
        raise DataError(f"the depth passes {level:.3g} h0 nowhere")
    k = above[-1]
    return x[k] + (depth[k] - level) / (depth[k] - depth[k + 1]) * (x[k + 1] - x[k])


def place_of_bore(x, depth, still, start):
    """Position of a bore onto water of the depth `still`, behind which the depth is uniform from x = `start` on. It
    is twice as far from there as the centre of the water that the bore has brought, which spray of the roller hardly
    moves."""
    above = np.where(x > start, depth - still, 0.0)
    return start + 2 * float((x - start) @ above) / float(above.sum())


def volume_ahead(x, depth, still):
    """Water that has passed x = 0 in theory, over h0^2, without the depth `still` that was there before. x are the
    middles of equal pieces."""
    return float(np.sum((depth - still)[x > 0]) * (x[1] - x[0]))


def shallow_dam_break(run, exact, discharge, front, speed):
    """Numbers common to both dam breaks; `speed` is that of the place front(x, depth). A real dam break becomes
    shallow only after the time sqrt(h0/g) and then lags behind theory by a constant length. Speeds and the discharge
    are therefore slopes over T, and the profile is the last one."""
    profiles = late_profiles(run)
    if len(profiles) < 3:
        raise DataError(f"{run.path}: has {len(profiles)} profiles from T = {LATE:g} on, too few for a slope")
    T, x, depth = profiles[-1]
    inside = (x > -1.2 * T) & (x < 2.0 * T)
    return {
        "discharge_error": late_discharge(run) / discharge - 1,
        "front_error": slope([T for T, _, _ in profiles], [front(x, depth) for _, x, depth in profiles]) / speed - 1,
        "profile_error": rms(depth[inside] - exact(x[inside] / T)),
    }


def ritter_dam_break(run):
    """discharge_error: of the discharge at the gate, 8/27 sqrt(g) h0^1.5, relative. gate_error: of the depth there, 4/9 h0,
    at the last profile. front_error: of the speed of the place where the depth is TIP, relative. profile_error: rms over
    h0 of the last profile."""
    _, x, depth = late_profiles(run)[-1]
    front = partial(last_place, level=TIP)
    return shallow_dam_break(run, ritter, 8 / 27, front, 2 - 3 * math.sqrt(TIP)) | {
        "gate_error": float(np.interp(0.0, x, depth)) / (4 / 9) - 1}


def stoker_dam_break(run):
    """discharge_error and profile_error as for Ritter's; front_error: of the speed of the bore, whose place is that of its
    mass; plateau_error: of the mean depth over the middle half between rarefaction and bore, at the last profile."""
    still = run.parameters["h1"] / run.parameters["h0"]
    level, speed, bore = stoker_state(still)
    T, x, depth = late_profiles(run)[-1]
    tail = speed - math.sqrt(level)
    middle = np.abs(x / T - 0.5 * (tail + bore)) < 0.25 * (bore - tail)
    front = partial(place_of_bore, still=still, start=max(tail, 0.0) * T)
    return shallow_dam_break(run, partial(stoker, ahead=still), speed * level, front, bore) | {
        "plateau_error": float(depth[middle].mean()) / level - 1}


def uneven_momentum(run, start, end):
    """Excess of momentum of the water from x = start T to end T, in h0, from LATE on: its flux of momentum over g h0^2
    beyond that of even flow of the same depth and discharge, the mean over the frames and over pieces of the water half
    as long as h0."""
    depth, scale = run.parameters["h0"], time_unit(run)
    excess = []
    for frame in (read_frame(*entry) for entry in list_frames(run.path)):
        T = frame.time / scale
        if T < LATE - 0.01:
            continue
        pieces = max(1, round(2 * (end - start) * T))
        place = np.floor((frame.position[:, 0] / (depth * T) - start) / (end - start) * pieces)
        speed = frame.fields["velocity"][:, 0].astype(float) * scale / depth
        for piece in range(pieces):
            inside = speed[place == piece]
            excess.append(inside.var() * inside.size * (run.spacing / depth) ** 2 * pieces / ((end - start) * T))
    return float(np.mean(excess))


def bore_speed_error(run):
    """Error of Stoker's bore: its speed over that from mass and momentum for the velocities behind it, less 1. The
    water between the reservoir's water and the bore has passed the roller, which makes its velocity uneven; the
    older half of this water is used."""
    still = run.parameters["h1"] / run.parameters["h0"]
    _, speed, bore = stoker_state(still)
    _, _, with_profile = stoker_state(still, uneven_momentum(run, speed, 0.5 * (speed + bore)))
    return (1 + stoker_dam_break(run)["front_error"]) * bore / with_profile - 1


# ------------------------------------------------------------------------------------------------ with friction


def front_of(x, depth):
    """The farthest place that is wet."""
    return float(x[np.flatnonzero(depth > 1e-4)[-1]])


@lru_cache(maxsize=None)
def rough_theory(ahead, roughness, times, back, front):
    """States of a dam break over a bed with this roughness, and over a frictionless bed if there is water ahead."""
    return (dam_break(ahead, RoughBed(roughness), times, back, front),
            dam_break(ahead, EvenBed(0.0), times, back, front) if ahead > 0 else None)


def rough_states(run, times):
    """rough_theory at the rising `times` of a run with a rough bed."""
    wall, depth = run.case["wall"][0], run.parameters["h0"]
    if not wall.get("roughness"):
        raise DataError(f"{run.path}: its bed is not rough; set wall.channel.slip=no-slip and wall.channel.roughness")
    return rough_theory(run.parameters.get("h1", 0.0) / depth, wall["roughness"] / depth, tuple(times),
                        run.parameters["back"] / depth, run.parameters["ahead"] / depth)


def front_history(run):
    """[(T, computed front, front in theory)] at the profiles of a run over a rough dry bed."""
    depth, scale = run.parameters["h0"], time_unit(run)
    times = [T for T, _, _ in late_profiles(run)]
    front = run.curve("front", "front_m")
    states, _ = rough_states(run, times)
    return [(T, float(np.interp(T * scale, front.time, front.value)) / depth, front_of(x, h))
            for T, (x, h, _) in zip(times, states)]


def rough_dry_bed(run):
    """Errors of the tip that friction slows. front_error: of its position at the last profile, relative.
    speed_error: of its mean speed over the last third, relative. profile_error: rms over h0 for the water ahead of
    the gate at the last profile."""
    history = front_history(run)
    T, found, exact = history[-1]
    late = [entry for entry in history if entry[0] > 2 / 3 * T]
    if len(late) < 2:
        raise DataError(f"{run.path}: has too few profiles from T = {2 / 3 * T:.3g} on for a speed")
    _, x, depth = late_profiles(run)[-1]
    theory_x, theory, _ = rough_states(run, [T for T, _, _ in history])[0][-1]
    ahead = (x > 0) & (x < max(found, exact))
    speed = [(late[-1][k] - late[0][k]) / (late[-1][0] - late[0][0]) for k in (1, 2)]
    return {"front_error": found / exact - 1, "speed_error": speed[0] / speed[1] - 1,
            "profile_error": rms((depth - np.interp(x, theory_x, theory))[ahead])}


def held_back(rough, free):
    """[(T, computed, in theory)]: water (h0^2) that has not passed the gate because of the friction of a wet bed,
    from two runs that differ only in friction. The lag of the start, which theory does not have, cancels."""
    still = rough.parameters["h1"] / rough.parameters["h0"]
    (times, passed), (free_times, free_passed) = water_passed(rough), water_passed(free)
    late = np.minimum(times[times > LATE - 0.01], free_times[-1])  # their last frames are a step apart
    states, free_states = rough_states(rough, late)
    return [(T, found, volume_ahead(*free_state[:2], still) - volume_ahead(*state[:2], still))
            for T, found, state, free_state in zip(
                late, np.interp(late, free_times, free_passed) - np.interp(late, times, passed), states, free_states)]


def held_back_error(rough, free):
    """Relative error of the water that the bed's friction has held back by the last frame."""
    _, found, exact = held_back(rough, free)[-1]
    return found / exact - 1


FLOWS = {"ritter": ritter_dam_break, "stoker": stoker_dam_break, "rough-dry-bed": rough_dry_bed}
