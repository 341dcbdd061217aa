"""The map of a floor: walls from an occupancy grid, distances along rays, and the distance to the nearest wall.

A map is a YAML file as for map_server: image, resolution, origin, negate, occupied_thresh. The image is a PGM (P2 or
P5), or a text in which `#` is a wall. The walls are the edges of occupied cells, so distances are exact.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import yaml

WALL = "#"
CLOSE = 1e-9  # m; a ray to a corner hits one of its two edges


class MapError(ValueError):
    """A map that cannot be read; the text names the file."""


class FloorMap:
    """Walls of a floor.

    Args:
        occupied: a row of cells for each row of the grid, the lowest first; True is a wall.
        resolution: side of a cell in m.
        origin: x and y of the corner of the first cell in m.
    """

    def __init__(self, occupied: Any, resolution: float, origin: tuple[float, float] = (0.0, 0.0)) -> None:
        self._occupied = np.asarray(occupied, dtype=bool)
        self._resolution = resolution
        self._origin = origin
        self._upright = self._edges(self._occupied.T, origin[0], origin[1])
        self._level = self._edges(self._occupied, origin[1], origin[0])

    def _edges(self, lines: Any, across: float, along: float) -> Any:
        """Return (place, begin, end) of each edge between two neighbouring lines of cells."""
        found: list[tuple[float, float, float]] = []
        nothing = np.zeros_like(lines[:1])
        before = np.concatenate((nothing, lines))
        after = np.concatenate((lines, nothing))
        for number, edge in enumerate(before != after):
            turns = np.flatnonzero(np.diff(np.concatenate(([False], edge, [False])).astype(np.int8)))
            place = across + number * self._resolution
            found += [
                (place, along + begin * self._resolution, along + end * self._resolution)
                for begin, end in zip(turns[::2].tolist(), turns[1::2].tolist())
            ]
        return np.array(found, dtype=float).reshape(-1, 3).T

    def is_wall(self, x: float, y: float) -> bool:
        """Return whether a point lies in an occupied cell."""
        column = int((x - self._origin[0]) // self._resolution)
        row = int((y - self._origin[1]) // self._resolution)
        rows, columns = self._occupied.shape
        return 0 <= row < rows and 0 <= column < columns and bool(self._occupied[row, column])

    def distances(self, x: float, y: float, cosines: Any, sines: Any) -> Any:
        """Return the distance to the nearest wall along each ray from a point; infinite without one.

        Args:
            x: of the point in m.
            y: of the point in m.
            cosines: of the directions of the rays.
            sines: of the directions of the rays.
        """
        first = _hits(self._upright, x, y, cosines, sines)
        second = _hits(self._level, y, x, sines, cosines)
        return np.minimum(first, second)

    def clearance(self, x: float, y: float) -> float:
        """Return the distance from a point to the nearest wall in m; 0 inside of a wall."""
        if self.is_wall(x, y):
            return 0.0
        nearest = np.inf
        for edges, across, along in ((self._upright, x, y), (self._level, y, x)):
            place, begin, end = edges
            beside = np.maximum(0.0, np.maximum(begin - along, along - end))
            squares = (place - across) ** 2 + beside**2
            nearest = min(nearest, float(squares.min(initial=np.inf)))
        return float(np.sqrt(nearest))


def _hits(edges: Any, across: float, along: float, towards: Any, beside: Any) -> Any:
    """Return the distance to the nearest of some parallel edges for each ray."""
    place, begin, end = edges
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        distance = (place - across) / towards[:, None]
        met = along + distance * beside[:, None]
    is_hit = (distance >= 0) & (met >= begin - CLOSE) & (met <= end + CLOSE)
    return np.where(is_hit, distance, np.inf).min(axis=1, initial=np.inf)


# -- files -------------------------------------------------------------------------------------------------------------


def read_map(path: str) -> FloorMap:
    """Read a map.

    Args:
        path: of its YAML file.

    Raises:
        MapError: it cannot be read; the text names the file and the field.
    """
    try:
        with open(path, encoding="utf-8") as file:
            fields = yaml.safe_load(file)
        image = os.path.join(os.path.dirname(path), fields["image"])
        resolution, origin = float(fields["resolution"]), [float(each) for each in fields.get("origin", (0, 0, 0))]
        if image.endswith(".txt"):
            return FloorMap(_text_cells(image), resolution, (origin[0], origin[1]))
        shades = _pgm(image)
    except (OSError, KeyError, TypeError, ValueError, yaml.YAMLError) as error:
        raise MapError(f"{path}: cannot be read as a map: {error!r}") from None
    if len(origin) > 2 and origin[2]:
        raise MapError(f"{path}: origin: the yaw must be 0, not {origin[2]}")
    dark = shades if int(fields.get("negate", 0)) else 1 - shades
    return FloorMap(dark[::-1] > float(fields.get("occupied_thresh", 0.65)), resolution, (origin[0], origin[1]))


def _text_cells(path: str) -> Any:
    with open(path, encoding="utf-8") as file:
        lines = [line.rstrip("\n") for line in file]
    lines = [line for line in lines if line]
    width = max(map(len, lines))
    return np.array([[each == WALL for each in line.ljust(width)] for line in lines[::-1]])


def _pgm(path: str) -> Any:
    """Return the pixels of a PGM, 0 for black and 1 for white, the upper row first."""
    with open(path, "rb") as file:
        data = file.read()
    words, at = _header(data)
    kind, width, height, most = words[0], int(words[1]), int(words[2]), int(words[3])
    if kind == b"P2":
        pixels = np.array(data[at:].split(), dtype=float)
    elif kind == b"P5":
        pixels = np.frombuffer(data, ">u2" if most > 255 else "u1", width * height, at).astype(float)
    else:
        raise ValueError(f"{path} is not a PGM; expected P2 or P5")
    return pixels[: width * height].reshape(height, width) / most


def _header(data: bytes) -> tuple[list[bytes], int]:
    """Return the four words at the beginning of a PGM, and the place of the first pixel."""
    words, at = [], 0
    while len(words) < 4:
        end = at
        if data[at : at + 1] == b"#":
            at = data.index(b"\n", at) + 1
            continue
        while end < len(data) and not data[end : end + 1].isspace():
            end += 1
        if end > at:
            words.append(data[at:end])
        elif end >= len(data):
            raise ValueError("the header of the PGM is cut off")
        at = end + 1
    return words, at
