"""Files with any damage: every command that reads them ends with a status, and never with a traceback."""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.cli.main import main
from cfepy.ground.dictionary import dictionary_of
from cfepy.mission import read_mission
from cfepy.script.text import read_script
from cfepy.status import UsageError

ROOT = Path(__file__).parents[2]
DUMPS = sorted([*(ROOT / "tests/data").glob("*.log"), *(ROOT / "tests/data").glob("*.dat")])
TABLES = sorted([*(ROOT / "tests/data").glob("*.tbl"), *(ROOT / "missions").glob("*/*.tbl")])
STATUSES = (0, 1, 2)
WORDS = (
    b'-1 1e999 inf nan 99999999999999999999 0x [] {} null " : [ { &a *a !!binary | > \t \xff \0 2001-01-01 .5 0o9'
).split(b" ")


def damaged(data: bytes, random: Random) -> bytes:
    """Cut off, made longer, with flipped bits, or with other bytes in the headers."""
    found = bytearray(data)
    for _ in range(random.randint(1, 3)):
        kind, at = random.randrange(5), random.randrange(len(found))
        if kind == 0:
            del found[at + 1 :]
        elif kind == 1:
            found += random.randbytes(random.choice((1, 3, 100, 5000)))
        elif kind == 2:
            for _ in range(random.randint(1, 30)):
                found[random.randrange(len(found))] ^= 1 << random.randrange(8)
        elif kind == 3:
            found[at : at + random.randrange(20)] = random.randbytes(random.randrange(1, 20))
        else:
            at = min(at, random.randrange(130))
            found[at : at + 4] = random.choice(
                (b"\xff\xff\xff\xff", bytes(4), b"\x7f\xff\xff\xff", b"\xff\xff\xff\x7f")
            )
    return bytes(found)


def garbled(text: bytes, random: Random) -> bytes:
    """Return the text with words removed, inserted or moved, and lines doubled, indented or lost."""
    lines = text.split(b"\n")
    for _ in range(random.randint(1, 3)):
        at = random.randrange(len(lines))
        words = lines[at].split(b" ")
        kind, place = random.randrange(5), random.randrange(len(words))
        if kind == 0:
            words[place] = random.choice(WORDS)
        elif kind == 1:
            words.insert(place, random.choice(WORDS + words))
        elif kind == 2:
            del words[place]
        elif kind == 3:
            words.insert(0, b" ")
        lines[at : at + 1] = [b" ".join(words)] * (1 + (kind == 4))
    return b"\n".join(lines)


def command(*arguments: str) -> int:
    """Run the command as a process would, whose output must be UTF-8. Returns its exit status."""
    out, err = (io.TextIOWrapper(io.BytesIO(), encoding="utf-8") for _ in range(2))
    err.reconfigure(errors="backslashreplace")
    with redirect_stdout(out), redirect_stderr(err):
        status = main(arguments)
        out.flush()
    return status


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("damaged")


def write(path: Path, source: Path, seed: int, damage: Callable[[bytes, Random], bytes]) -> str:
    path.write_bytes(damage(source.read_bytes(), Random(seed)))
    return str(path)


SEEDS = st.integers(0, 2**32)


@settings(max_examples=50, deadline=None)
@given(st.sampled_from(DUMPS), SEEDS, st.booleans())
def test_dump_files(folder: Path, source: Path, seed: int, as_json: bool) -> None:
    name = write(folder / "dump.log", source, seed, damaged)
    assert command("log", *["--json", "-"] * as_json, name) in STATUSES


@settings(max_examples=5, deadline=None)
@given(
    st.sampled_from(TABLES),
    SEEDS,
    st.sampled_from((["show"], ["show", "--yaml", "-"], ["show", "--json", "-"], ["verify"])),
)
def test_table_files(folder: Path, source: Path, seed: int, action: list[str]) -> None:
    name = write(folder / "table.tbl", source, seed, damaged)
    assert command("tbl", *action, name) in STATUSES


@settings(max_examples=2, deadline=None)
@given(st.sampled_from(TABLES), SEEDS)
def test_table_yaml(folder: Path, source: Path, seed: int) -> None:
    yaml = folder / "table.yaml"
    assert command("tbl", "show", str(source), "--yaml", str(yaml)) == 0
    write(yaml, yaml, seed, garbled)
    assert command("tbl", "build", str(yaml), "-o", str(folder / "out.tbl")) in STATUSES


@pytest.mark.slow
@settings(max_examples=5, deadline=None)
@given(st.sampled_from(("mission.yaml", "startup.scr")), SEEDS)
def test_missions(folder: Path, name: str, seed: int) -> None:
    mission = folder / "mission"
    mission.mkdir(exist_ok=True)
    for source in (ROOT / "missions/capture").iterdir():
        if source.is_file():
            (mission / source.name).write_bytes(source.read_bytes())
    write(mission / name, mission / name, seed, garbled)
    assert command("check", str(mission)) in STATUSES


SPEC = read_mission("capture")
DICTIONARY = dictionary_of(SPEC)


@settings(max_examples=200, deadline=None)
@given(SEEDS)
def test_scripts(folder: Path, seed: int) -> None:
    name = write(folder / "script.txt", ROOT / "missions/capture/checks.txt", seed, garbled)
    said = name
    try:
        read_script(name, SPEC, DICTIONARY)
    except UsageError as error:
        said = str(error)
    assert name in said
