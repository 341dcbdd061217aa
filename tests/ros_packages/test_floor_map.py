"""cfepy_plant: maps as map_server reads them, and the walls in them."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from tests.plant_modules import NODES, plant_module

floor = plant_module("floor_map")
YAML = "image: {}\nresolution: 0.5\norigin: [-1.0, 2.0, 0.0]\nnegate: {}\noccupied_thresh: 0.65\n"
ROOM = "#####\n#   #\n#   ##\n#####\n"  # 2.5 m by 2 m; the upper row first
GRAY = {"#": 0, " ": 254}


def written(folder: Path, image: str, data: bytes, negate: int = 0) -> str:
    (folder / image).write_bytes(data)
    path = folder / "map.yaml"
    path.write_text(YAML.format(image, negate), encoding="utf-8")
    return str(path)


def pixels(negate: int = 0) -> list[int]:
    rows = [line.ljust(6) for line in ROOM.splitlines()]
    return [255 - GRAY[each] if negate else GRAY[each] for row in rows for each in row]


def checked(path: str) -> None:
    """Check the room: its free part reaches from x -0.5 to 1 and from y 2.5 to 3.5."""
    room = floor.read_map(path)
    assert room.is_wall(-0.75, 2.25)
    assert not room.is_wall(0, 3)
    assert not room.is_wall(100, 100)
    angles = [0, math.pi / 2, math.pi, -math.pi / 2]
    cosines, sines = (np.array([function(each) for each in angles]) for function in (math.cos, math.sin))
    found = room.distances(0.0, 3.25, cosines, sines)
    assert found == pytest.approx([1.0, 0.25, 0.5, 0.75])
    assert room.clearance(0.0, 3.25) == pytest.approx(0.25)
    assert room.clearance(-0.75, 2.25) == 0


@pytest.mark.parametrize("negate", [0, 1])
def test_pgm_in_words_is_read(tmp_path: Path, negate: int) -> None:
    text = "P2\n# a comment\n6 4\n255\n" + " ".join(map(str, pixels(negate)))
    checked(written(tmp_path, "map.pgm", text.encode(), negate))


@pytest.mark.parametrize(("most", "kind"), [(255, "u1"), (65535, ">u2")])
def test_pgm_in_bytes_is_read(tmp_path: Path, most: int, kind: str) -> None:
    data = (np.array(pixels()) * (most // 255)).astype(kind).tobytes()
    checked(written(tmp_path, "map.pgm", f"P5 6 4 {most}\n".encode() + data))


def test_text_is_read(tmp_path: Path) -> None:
    checked(written(tmp_path, "map.txt", ROOM.encode()))


def test_ray_without_a_wall_is_infinite() -> None:
    one_cell = floor.FloorMap([[True]], 1.0)
    assert one_cell.distances(-2, 0.5, np.array([1.0, -1.0]), np.array([0.0, 0.0])).tolist() == [2.0, math.inf]


def test_shipped_room_has_the_walls_of_its_page() -> None:
    room = floor.read_map(str(NODES.parent / "maps" / "room.yaml"))
    found = room.distances(1.0, 0.6, np.array([1.0, 0.0, -1.0, 0.0]), np.array([0.0, 1.0, 0.0, -1.0]))
    assert found == pytest.approx([4.9, 3.3, 0.9, 0.5])
    assert room.distances(1.0, 2.0, np.array([1.0]), np.array([0.0])) == pytest.approx([1.2])  # the pillar


@pytest.mark.parametrize(
    ("image", "data", "text"),
    [
        ("map.pgm", b"P6 1 1 255\n...", "is not a PGM; expected P2 or P5"),
        ("map.pgm", b"P2 6", "the header of the PGM is cut off"),
        ("map.pgm", b"P5 6 4 255\n12", "map.yaml: cannot be read as a map"),
    ],
)
def test_broken_map_is_named(tmp_path: Path, image: str, data: bytes, text: str) -> None:
    with pytest.raises(floor.MapError) as caught:
        floor.read_map(written(tmp_path, image, data))
    assert text in str(caught.value)


def test_turned_map_is_refused(tmp_path: Path) -> None:
    path = written(tmp_path, "map.pgm", f"P5 6 4 255\n{'x' * 24}".encode())
    text = Path(path).read_text(encoding="utf-8").replace("2.0, 0.0]", "2.0, 0.5]")
    Path(path).write_text(text, encoding="utf-8")
    with pytest.raises(floor.MapError, match=r"origin: the yaw must be 0, not 0\.5"):
        floor.read_map(path)
