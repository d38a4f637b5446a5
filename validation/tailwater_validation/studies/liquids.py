"""Two liquids in one run against theory."""

from .exact import EXACTLY, flow_study, runs_by_rows


def layered_tank(plan):
    runs = runs_by_rows(plan, "liquids/layered_tank.toml", "H", (1.5, 25, 3.2),
                        plan.at((25,), (25, 50), (25, 50)))
    return flow_study(
        "layered-tank", "Layers at rest", "layered-tank",
        "Two liquids at rest in a tank, the heavy one, of twice the density, below, from particles displaced at random by up to 0.2 dx. "
        "Pressure and speed in the second half of the run, mixing at its end.",
        EXACTLY, runs, (("pressure_error", "pressure, rms error over that on the floor", "", 0.003),
                        ("speed", "rms speed over sqrt(g H)", "", None),
                        ("mixed_fraction", "volume mixed with the other liquid", "", None)), (0.0, 2.0))


def internal_wave(plan):
    runs = runs_by_rows(plan, "liquids/internal_wave.toml", "h", (6, 12, 3.2),
                        plan.at((6, 12), (6, 12, 24), (6, 12, 24)))
    return flow_study(
        "internal-wave", "Standing wave on an interface", "internal-wave",
        "Two layers of equal depth h between lids, density ratio 2, half a wavelength of 2 m; 6, 12 and 24 particles over each layer. "
        "Period and height of the mode of the vertical velocity over two periods.",
        "Linear theory leaves out terms of order (k a)^2 = 0.25 %.", runs,
        (("period_error", "period, relative error", "", 0.01),
         ("height_error", "height after two periods, relative error", "", None)), (0.0, 1.0), has_histories=False)


def rayleigh_taylor(plan):
    runs = runs_by_rows(plan, "liquids/rayleigh_taylor.toml", "h", (2, 24, 3.2),
                        plan.at((12, 24), (12, 24, 48), (12, 24, 48)))
    return flow_study(
        "rayleigh-taylor", "Rayleigh-Taylor instability", "rayleigh-taylor",
        "A liquid of twice the density over another between lids, disturbed by half a wavelength. Growth of the mode of the vertical "
        "velocity until two times the inverse of the growth rate.",
        "Linear theory; the displacement at the end is k a = 0.18.", runs,
        (("growth_error", "growth rate, relative error", "", 0.05),), (0.0, 0.6), has_histories=False)


def lock_exchange(plan):
    runs = runs_by_rows(plan, "liquids/lock_exchange.toml", "H", (5, 20, 3.2),
                        plan.at((10, 20), (10, 20), (10, 20, 40)))
    return flow_study(
        "lock-exchange", "Lock exchange", "lock-exchange",
        "Brine under fresh water in a flume 5 H long with smooth walls and a lid, density ratio 0.98. Speed of the front of the brine "
        "from one to two depths behind the gate.",
        "The theory of Benjamin (1968) is for a front without loss of energy.", runs,
        (("froude_error", "speed of the front, relative error", "", 0.05),), (0.0, 2.0, 4.0))
