"""Random lives of a buffer of transforms, as lines for frames.cpp: trees that change, times, mistakes."""

from __future__ import annotations

import math
import random

STEP = 1_000_000_000 // 512
"""Times are multiples of this many ns, which a float of seconds holds exactly: Python's tf2 takes times as floats."""


def rotation(chance: random.Random) -> list[float]:
    """Return a quaternion of length 1, also with few digits."""
    if chance.random() < 0.2:
        return chance.choice(([0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.6, 0.0, -0.8], [0.5, -0.5, 0.5, 0.5]))
    numbers = [chance.gauss(0, 1) for _ in range(4)]
    length = math.hypot(*numbers)
    return [number / length for number in numbers]


def scripts(seed: int, length: int = 150) -> list[str]:
    """One life.

    Args:
        seed: of the chance.
        length: how many lines.
    """
    chance = random.Random(seed)
    names = [f"frame_{at}" if at % 3 else f"f{at}" for at in range(chance.choice((3, 6, 10)))]
    parents = {name: chance.choice(names[:at] or ["map"]) for at, name in enumerate(names)}
    everlasting = {name for name in names if chance.random() < 0.25}
    now = 512 * 1000

    def moment() -> int:
        return 0 if chance.random() < 0.25 else (now - chance.randrange(-40, 900)) * STEP

    def name() -> str:
        return chance.choice([*names, *names, *names, "map", chance.choice(["nowhere", "-", "/slash", "map"])])

    def transform() -> str:
        child = chance.choice(names)
        parent = parents[child] if chance.random() < 0.97 else chance.choice(names)
        stamp = now - (chance.randrange(600) if chance.random() < 0.2 else 0)
        if chance.random() < 0.02:
            stamp -= 512 * 20
        numbers = [chance.choice((0.0, 1.5, chance.uniform(-9, 9))) for _ in range(3)] + rotation(chance)
        if chance.random() < 0.03:
            numbers[chance.randrange(7)] = chance.choice((math.nan, 3.0))
        if chance.random() < 0.03:
            child, parent = chance.choice((("-", parent), (child, "-"), (child, child), (f"/{child}", f"/{parent}")))
        kind = "static" if child in everlasting else "moving"
        values = " ".join("nan" if math.isnan(number) else float.hex(number) for number in numbers)
        return f"set {child} {parent} {stamp * STEP} {kind} author_{chance.randrange(3)} {values}"

    lines = []
    for _ in range(length):
        now += chance.choice((0, 1, 20, 60))
        kind = chance.choices(KINDS, WEIGHTS)[0]
        if kind == "set":
            lines += [transform() for _ in range(chance.randrange(1, 6))]
        elif kind in ("look", "can"):
            lines.append(f"{kind} {name()} {name()} {moment()}")
        elif kind in ("lookfull", "canfull"):
            lines.append(f"{kind} {name()} {moment()} {name()} {moment()} {name()}")
        elif kind == "common":
            lines.append(f"common {chance.choice(names)} {chance.choice(names)}")
        elif kind == "parent":
            lines.append(f"parent {chance.choice([*names, 'nowhere'])} {moment()}")
        elif kind == "chain":
            lines.append(f"chain {name()} {moment()} {name()} {moment()} {name()}")
        elif kind == "dot":
            lines.append(f"dot {chance.choice((0.0, now / 512 + 0.25))}")
        else:
            lines.append(kind)
    return lines


KINDS = "set", "look", "can", "lookfull", "canfull", "common", "parent", "chain", "string", "yaml 0", "dot", "clear"
WEIGHTS = 45, 25, 15, 8, 5, 5, 4, 4, 1, 1, 1, 0.2
