"""Numbers of a case file without the program: its expressions, and the height of its water at the start."""

import math
import tomllib

NAMES = {name: getattr(math, name) for name in ("pi", "sqrt", "sin", "cos", "tan", "tanh", "cosh", "sinh", "exp", "log", "atan",
                                                "asin", "acos")} | {"abs": abs, "min": min, "max": max}


def number(value, names):
    """A value of a case: a number, or an expression of named numbers. None if it cannot be evaluated."""
    if isinstance(value, (int, float)):
        return float(value)
    try:
        return float(eval(value.replace("^", "**"), {"__builtins__": {}}, names))  # of the case files of this tree
    except (NameError, SyntaxError, TypeError, ValueError, ZeroDivisionError):
        return None


def read_case(path, settings):
    """The case as tomllib reads it, with its settings (`key=value`) for parameters and scalar keys."""
    case = tomllib.loads(path.read_text(encoding="utf-8"))
    for setting in settings:
        key, _, value = setting.partition("=")
        *tables, name = key.split(".")
        if len(tables) == 1 and "[" not in key:
            try:
                value = tomllib.loads(f"value = {value}")["value"]
            except tomllib.TOMLDecodeError:
                pass  # words and expressions have no quotes in a setting
            case.setdefault(tables[0], {})[name] = value
    return case


def named_numbers(case, spacing):
    """Parameters, each after those that it uses, gravity, and the spacing."""
    gravity = case.get("physics", {}).get("gravity", [0, -9.81])
    names = NAMES | {"dx": spacing}
    if all(isinstance(one, (int, float)) for one in gravity):
        names["g"] = sum(one**2 for one in gravity) ** 0.5
    left = dict(case.get("parameters", {}))
    while left:
        found = {name: number(value, names) for name, value in left.items()}
        found = {name: value for name, value in found.items() if value is not None}
        if not found:
            break
        names |= found
        left = {name: value for name, value in left.items() if name not in found}
    return names


def height_of(fluid, names, floor):
    """Height of a block, m; None if it is unknown."""
    if fluid.get("shape") == "fill":
        ends = [floor, number(fluid.get("level"), names)]
    elif "points" in fluid:
        ends = [number(point[-1], names) for point in fluid["points"]]
    elif "min" in fluid:
        ends = [number(fluid[end][-1], names) for end in ("min", "max")]
    else:
        ends = [None]
    return None if None in ends else max(ends) - min(ends)


def water_height(path, settings, spacing):
    """Height of the highest initial block of water, m; None if the case file alone does not give it."""
    case = read_case(path, settings)
    names = named_numbers(case, spacing)
    corners = [number(point[-1], names) for wall in case.get("wall", []) for point in wall.get("points", [])]
    floor = min((corner for corner in corners if corner is not None), default=None)
    heights = [height_of(fluid, names, floor) for fluid in case.get("fluid", [])]
    return None if None in heights or not heights else max(heights)


def friction_of_walls(path, settings):
    """Friction of the walls of a case, in words."""
    case = read_case(path, settings)
    walls = case.get("wall", [])
    found = {wall.get("slip", "free") for wall in walls}
    found |= {"rough" for wall in walls if wall.get("roughness") or wall.get("manning")}
    changed = {setting.rpartition("=")[2] for setting in settings if setting.partition("=")[0].endswith(".slip")}
    return ", ".join(sorted(changed or found - ({"no-slip"} if "rough" in found else set()))) or "none"
