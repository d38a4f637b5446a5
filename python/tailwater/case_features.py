"""Features of a case: they determine the limits of the method that apply to it, and the validated flow most like it."""

from .errors import DataError

__all__ = ["features_of", "limits_of", "nearest_flow"]

FRICTION_KEYS = ("friction", "roughness", "manning")
# Tables whose presence is a feature of a case.
TABLES = {"inlet": "inlet", "outlet": "outlet", "gate": "gate", "wave_maker": "wave maker", "body": "floating body",
          "porous": "porous layer", "damping": "damping zone", "refinement": "zone of refinement"}
# Types of probes, by the kind of quantity that they measure.
KINDS = {"depth": "level", "level-map": "level", "profile": "level", "run-up": "level", "wall-pressure": "pressure",
         "wall-pressure-mean": "pressure", "pressure": "pressure", "pressure-map": "pressure", "force": "force",
         "discharge": "discharge", "velocity": "velocity", "velocity-profile": "velocity", "front": "front",
         "motion": "motion"}
OF_EVERY_FLOW = {"2D", "3D"}


def is_set(value):
    """Whether a value of a case, a number or an expression, differs from zero and "none"."""
    if isinstance(value, list):
        return any(is_set(each) for each in value)
    return value not in (0, "", "0", "none", None, False)


def is_rough(wall):
    return wall.get("slip", "free") != "free" or any(is_set(wall.get(key)) for key in FRICTION_KEYS)


def is_moving(wall):
    return any(is_set(wall.get(key)) for key in ("displacement", "rotation", "motion"))


def features_of(case: dict) -> set:
    """The features of a case. `case` is a case as tomllib reads it, effective or as its user wrote it."""
    walls, ends = case.get("wall", []), case.get("inlet", []) + case.get("outlet", [])
    found = {feature for table, feature in TABLES.items() if case.get(table)}
    found.add("3D" if dimension_of(case) == 3 else "2D")
    told = {"rough wall": any(map(is_rough, walls)),
            "moving wall": any(map(is_moving, walls)),
            "plate": any(wall.get("shape") == "plate" for wall in walls),
            "wall mesh": any(wall.get("shape") == "mesh" for wall in walls),
            "prescribed level": any(is_set(end.get("level")) for end in ends),
            "circulation": any(is_set(end.get("water_from")) for end in ends),
            "periodic": any(map(is_set, case.get("domain", {}).values())),
            "air pockets": is_set(case.get("air", {}).get("pockets")),
            "published formulation": case.get("scheme", {}).get("formulation") == "published",
            "no gravity": not is_set(case.get("physics", {}).get("gravity", 1)),
            "initial displacement": is_set(case.get("particles", {}).get("jitter"))}
    found |= {feature for feature, is_there in told.items() if is_there}
    if not found & {"inlet", "wave maker", "floating body", "periodic", "no gravity"}:
        found.add("released water")
    return found


def dimension_of(case):
    """2 or 3; if the case does not give it, the number of coordinates of its shapes."""
    if given := case.get("case", {}).get("dimension"):
        return given
    points = [table[key] for name in ("fluid", "wall") for table in case.get(name, []) for key in ("min", "seed")
              if isinstance(table.get(key), list)]
    return len(points[0]) if points else 2


# The page that describes the limit, the limit, and the features of the cases to which it applies (none: every case).
LIMITS = (
    ("docs/limits.md#robustness", "By default the two outermost particle rows and all walls sustain no tension: water that moves "
     "away from a wall separates from it, and a siphon drains at its crown.", set()),
    ("docs/limits.md#scope", "Surface tension is not simulated.", set()),
    ("docs/limits.md#accuracy", "Only walls generate turbulence: bores, jumps and plunging jets do not dissipate by "
     "turbulence in the bulk.", set()),
    ("docs/limits.md#accuracy", "The fewer particles there are over the governing depth, the larger the error; the interval of a "
     "study covers it, a single run does not show it.", set()),
    ("docs/limits.md#scope", "A two-dimensional case has no flow across the plane: no side walls, no oblique waves, no "
     "three-dimensional breaking.", {"2D"}),
    ("docs/limits.md#scope", "Air is not simulated: enclosed air neither cushions an impact nor holds water back.", {"no air"}),
    ("docs/theory/air.md", "The gas of a pocket has one pressure, no weight and no bubbles.", {"air pockets"}),
    ("docs/limits.md#accuracy", "The first contact of a thin front causes a pressure spike, whose impulse is right and whose "
     "height is not. Fronts a few millimetres thick are too fast.", {"released water", "gate"}),
    ("docs/theory/open_ends.md", "Open ends prescribe a level or a discharge and reflect part of what reaches them; the result "
     "holds only as long as they have the prescribed values.", {"inlet", "outlet"}),
    ("docs/limits.md#accuracy", "Travelling waves lose height, the more so the fewer particles resolve the height.",
     {"wave maker"}),
    ("docs/theory/floating_bodies.md", "No water flows through a gap under a body narrower than 0.75 spacings, and roll and heave "
     "of a light body are less accurate than those of a heavy one.", {"floating body"}),
    ("docs/theory/porous.md", "Stones of a porous layer do not move, and its surface takes part of the dynamic head that no "
     "resistance law contains.", {"porous layer"}),
    ("docs/limits.md#accuracy", "At curved walls the error grows with the time step where the radius is a few spacings.",
     {"wall mesh"}),
    ("docs/theory/geometry.md", "A slot of one particle row passes too little water, and a slot narrower than half a spacing is "
     "closed.", {"plate", "gate"}),
    ("docs/theory/friction.md", "Boundary layers count as turbulent from y u_tau/nu = 11.3 on; a layer that stays laminar "
     "for longer has less friction.", {"rough wall"}),
    ("docs/limits.md#robustness", "The published formulations are noisy, and one of them fails in long violent flows.",
     {"published formulation"}),
)


def limits_of(features) -> list:
    """[{"text", "page"}]: the limits of the method that apply to a case with these features."""
    given = set(features) | (set() if "air pockets" in features else {"no air"})
    return [{"text": text, "page": page} for page, text, needed in LIMITS if not needed or needed & given]


def likeness(features, other):
    """Similarity of two sets of features, from 0 to 1: common features over all features; the dimension counts half."""
    def weight(each):
        return sum(0.5 if feature in OF_EVERY_FLOW else 1.0 for feature in each)

    return weight(features & other) / max(weight(features | other), 0.5)


def nearest_flow(features, flows, kind=""):
    """The validated flow with the largest likeness to these features; a compared quantity of the kind `kind` (KINDS)
    adds 0.25 to it. `flows` are those of the table of evidence. Throws DataError if there are none."""
    if not flows:
        raise DataError("the table of evidence has no flows; remedy: scripts/evidence.py")
    features = set(features)

    def rank(flow):
        return likeness(features, set(flow["features"])) + (0.25 if kind and kind in flow["kinds"] else 0.0)

    best = max(flows, key=rank)
    own = set(best["features"])
    return best | {"shared": sorted(features & own), "only_here": sorted(features - own), "only_there": sorted(own - features)}
