"""Nodes as flight software links them: no larger than in the documentation, and flown on a bare Cortex-M7."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.extra.convert.build import library_folder
from dev.roscfe.images.flying import flown, lacking_emulator
from dev.roscfe.images.linking import COMPUTERS, FOLDER, Linker, Sizes, entry_of
from dev.roscfe.images.sizes import CORE, NODES, sizes_on

DOCUMENT = Path(__file__).parents[2] / "docs/reference/roscfe.md"
TABLE = re.compile(r"<!-- images -->\n(.*?)<!-- end of images -->", re.DOTALL)
TOLERANCE = 1.1
"""Other releases of a compiler make other code."""
MOST_TEXT, MOST_RAM, MOST_CORE = 64 << 10, 12 << 10, 16 << 10
BARE = COMPUTERS["Cortex-M7"]


def documented() -> dict[str, dict[str, Sizes]]:
    """Return the table of the documentation: sizes by computer and node."""
    found = TABLE.search(DOCUMENT.read_text(encoding="utf-8"))
    assert found is not None
    head, _, *rows = ([cell.strip() for cell in line.split("|")[1:-1]] for line in found[1].strip().splitlines())
    return {
        name: {row[0]: Sizes(*(int(each.replace(",", "")) for each in row[at].split("/"))) for row in rows}
        for at, name in enumerate(head)
        if at > 0
    }


def test_documented_sizes_keep_the_limits_of_a_small_board() -> None:
    sizes = documented()["Cortex-M7"]
    assert set(sizes) == {*NODES, CORE}
    assert all(sizes[name].text <= MOST_TEXT and sizes[name].ram <= MOST_RAM for name in NODES)
    assert sizes[CORE].text <= MOST_CORE


def test_core_has_few_lines_of_code() -> None:
    files = [each for each in sorted((library_folder() / "src/core").iterdir()) if each.suffix in (".cpp", ".h")]
    lines = (line.strip() for each in files for line in each.read_text(encoding="utf-8").splitlines())
    code = [line for line in lines if line and not line.startswith("//") and line not in ("{", "}", "};")]
    assert len(code) < 1000


def test_sources_without_an_operating_system_use_no_posix() -> None:
    posix = re.compile(
        r"#include <(unistd|sys/|pthread|signal|csignal|dlfcn|fcntl|poll)|\bsigaction\b|\bclock_gettime\b"
    )
    for source in sorted((library_folder() / "src").rglob("*.*")):
        if source.parent.name != "posix":
            assert posix.search(source.read_text(encoding="utf-8")) is None, source


@pytest.mark.slow
@pytest.mark.parametrize("name", COMPUTERS)
def test_nodes_are_no_larger_than_documented(name: str) -> None:
    computer = COMPUTERS[name]
    if computer.lacking is not None:
        pytest.skip(f"there is no {computer.lacking}")
    wanted = documented()[name]
    for node, sizes in sizes_on(computer).items():
        assert sizes.text <= wanted[node].text * TOLERANCE, (node, sizes)
        assert sizes.ram <= wanted[node].ram * TOLERANCE, (node, sizes)


@pytest.mark.slow
def test_two_nodes_fly_in_one_image_on_a_bare_computer(tmp_path: Path) -> None:
    lacking = BARE.lacking or lacking_emulator()
    if lacking is not None:
        pytest.skip(f"there is no {lacking}")
    nodes = [FOLDER / f"{name}.cpp" for name in ("talker", "listener")]
    linker = Linker(BARE, tmp_path, nodes, arena=4096)
    image = linker.image([linker.linked(each, entry_of(each.stem)) for each in nodes])
    lines = flown(image)
    heard = [line.partition("]: ")[2] for line in lines if "heard" in line]
    assert heard == [f"heard {number}" for number in range(1, 1001)]
    arenas = [line.partition(": ")[2] for line in lines if "of the arena are used" in line]
    assert sorted(re.sub(r"\d+ of", "N of", line) for line in arenas) == [
        f"/{name}: N of 4096 bytes of the arena are used" for name in ("listener", "talker")
    ]
    assert "1001 packets sent, 1008 received, 0 lost" in lines
