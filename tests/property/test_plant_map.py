"""cfepy_plant: distances along rays and to the nearest wall, compared with analytic ones and with the cells."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tests.plant_modules import plant_module

floor = plant_module("floor_map")
ANGLES = st.floats(-math.pi, math.pi)
PARTS = st.floats(0.01, 0.99)


@given(st.integers(1, 30), st.integers(1, 30), st.sampled_from([0.05, 0.1, 1.0]), PARTS, PARTS, ANGLES)
def test_distance_in_an_empty_room_is_analytic(
    columns: int, rows: int, side: float, across: float, along: float, angle: float
) -> None:
    cells = np.ones((rows + 2, columns + 2), dtype=bool)
    cells[1:-1, 1:-1] = False
    width, height = columns * side, rows * side
    room = floor.FloorMap(cells, side, (-side, -side))
    x, y = across * width, along * height
    cosine, sine = math.cos(angle), math.sin(angle)
    to_sides = [((width if cosine > 0 else 0) - x) / cosine] if cosine else []
    to_ends = [((height if sine > 0 else 0) - y) / sine] if sine else []
    [distance] = room.distances(x, y, np.array([cosine]), np.array([sine]))
    assert math.isclose(distance, min([*to_sides, *to_ends]), rel_tol=1e-9, abs_tol=1e-9)
    assert math.isclose(room.clearance(x, y), min(x, width - x, y, height - y), abs_tol=1e-9)


GRIDS = st.lists(st.lists(st.booleans(), min_size=6, max_size=6), min_size=2, max_size=6)


@given(GRIDS, st.floats(-2, 8), st.floats(-2, 8), ANGLES)
def test_ray_ends_at_the_first_wall_of_any_grid(cells: list[list[bool]], x: float, y: float, angle: float) -> None:
    room = floor.FloorMap(cells, 1.0)
    cosine, sine = math.cos(angle), math.sin(angle)
    [distance] = room.distances(x, y, np.array([cosine]), np.array([sine]))
    was_wall = room.is_wall(x, y)
    for travel in np.arange(0.0, min(distance, 15.0) - 0.01, 0.02):
        # rays may graze a corner within the tolerance
        near = {room.is_wall(x + travel * cosine + dx, y + travel * sine + dy) for dx in (0, 1e-6) for dy in (0, 1e-6)}
        assert was_wall in near


@given(GRIDS, st.floats(-2, 8), st.floats(-2, 8))
def test_clearance_is_the_distance_to_the_nearest_cell(cells: list[list[bool]], x: float, y: float) -> None:
    room = floor.FloorMap(cells, 1.0)
    distances = [
        math.hypot(max(column - x, 0, x - column - 1), max(row - y, 0, y - row - 1))
        for row, line in enumerate(cells)
        for column, is_wall in enumerate(line)
        if is_wall
    ]
    assert math.isclose(room.clearance(x, y), min(distances, default=math.inf), abs_tol=1e-9)
