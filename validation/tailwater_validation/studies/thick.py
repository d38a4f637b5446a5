"""Thick and yielding liquids against theory."""

from .exact import EXACTLY, flow_study, runs_by_rows


def thick_film(plan):
    runs = runs_by_rows(plan, "verification/thick_film.toml", "0.7", (3, 10, 3.5),
                        plan.at((5, 10), (5, 10, 20), (5, 10, 20)))
    return flow_study(
        "thick-film", "Film of a yielding liquid on a slope", "thick-film",
        "A Bingham liquid whose plug has 0.3 of its depth runs down a slope, from particles displaced at random by up to 0.1 dx, with "
        "5, 10 and 20 rows in the sheared layer. Speed of the particles at five times H^2/nu against the steady profile.",
        EXACTLY, runs, (("profile_error", "speed, rms error over that of the plug", "", 0.02),
                        ("discharge_error", "discharge, relative error", "", 0.02)), (1.0, 5.0), has_histories=False)


def viscous_dam_break(plan):
    runs = runs_by_rows(plan, "verification/viscous_dam_break.toml", "H", (30, 20, 3.3),
                        plan.at((10,), (10, 20), (10, 20, 40)))
    return flow_study(
        "viscous-dam-break", "Viscous dam break", "viscous-dam-break",
        "A block of syrup 0.2 m long and 0.1 m high, 0.1 m^2/s, spreads for 10 s behind a wall. Its front against the similarity "
        "solution of Huppert (1982).",
        "The solution is for a current without inertia that is long for its height; at the end it is nine times as long as high.", runs,
        (("front_error", "front after 10 s, relative error", "", 0.03),), (0.0, 2.0, 10.0))


def yielding_slump(plan):
    runs = runs_by_rows(plan, "verification/yielding_slump.toml", "H", (30, 20, 3.5),
                        plan.at((10,), (10, 20), (10, 20, 40)))
    return flow_study(
        "yielding-slump", "Slump of a yielding liquid", "yielding-slump",
        "A block of a Bingham liquid 0.2 m long and 0.1 m high slumps behind a wall until all of it is slower than 3 mm/s. Its reach and "
        "surface against plastic theory (Liu & Mei 1989, with the longitudinal stress).",
        "The solution is for a slump that is long for its height, without inertia; this one is eight times as long as high. It ends "
        "before the liquid is at rest, about 2 % short.", runs,
        (("reach_error", "reach, relative error", "", 0.05),
         ("surface_error", "surface up to 0.9 of the reach, rms error over the height at the wall", "", 0.05)), (0.0, 0.5, 1.5))
