"""`cfepy rosbag`: info, recover and convert, and MCAP files where other commands take bags."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.ground.bag import BagReader

GOLDEN = Path(__file__).parents[1] / "data" / "bags" / "golden_api_none.bag"
Capture = pytest.CaptureFixture[str]


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to be in, with a bag of ROS's."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "drive.bag").write_bytes(GOLDEN.read_bytes())
    return tmp_path


def count(file: Path) -> int:
    with BagReader(str(file)) as reader:
        return sum(1 for _ in reader.messages())


def test_info(here: Path, capsys: Capture) -> None:
    assert main(["rosbag", "verify", "drive.bag", "--json", "info.json"]) == 0
    out = capsys.readouterr().out
    found = json.loads((here / "info.json").read_text(encoding="utf-8"))
    assert out.startswith(f"\ndrive.bag: bag, {GOLDEN.stat().st_size:,} bytes, {count(GOLDEN):,} messages, ")
    assert found["messages"] == count(GOLDEN)
    assert found["losses"] == []
    for each in found["topics"]:
        assert each["topic"] in out


def test_there_and_back(here: Path, capsys: Capture) -> None:
    assert main(["rosbag", "convert", "drive.bag", "--compression", "lz4"]) == 0
    assert f"drive.mcap: {count(GOLDEN):,} messages" in capsys.readouterr().out
    assert main(["rosbag", "convert", "drive.mcap", "-o", "back.bag"]) == 0
    assert count(here / "back.bag") == count(here / "drive.mcap") == count(GOLDEN)


def test_what_is_left_of_a_bag_that_is_cut_off(here: Path, capsys: Capture) -> None:
    (here / "cut.bag").write_bytes(GOLDEN.read_bytes()[:40_000])
    assert main(["rosbag", "verify", "cut.bag"]) == 1
    assert "cut.bag: the recording was not finished" in capsys.readouterr().err
    assert main(["rosbag", "convert", "cut.bag"]) == 2
    assert "cut.bag: is damaged: " in capsys.readouterr().err
    assert main(["rosbag", "recover", "cut.bag"]) == 1
    captured = capsys.readouterr()
    assert 0 < count(here / "cut.recovered.bag") < count(GOLDEN)
    assert "at byte " in captured.err
    assert sorted(each.name for each in here.iterdir()) == ["cut.bag", "cut.recovered.bag", "drive.bag"]


@pytest.mark.parametrize(
    ("words", "file", "why"),
    [
        ("convert drive.bag", "drive.mcap", "already exists; name another output file with -o"),
        ("recover drive.bag", "drive.recovered.bag", "already exists; name another output file with -o"),
        ("recover drive.bag -o drive.bag", "drive.bag", "must not be the damaged recording itself; give another name"),
    ],
)
def test_nothing_is_written_over_unasked(words: str, file: str, why: str, here: Path, capsys: Capture) -> None:
    if file != "drive.bag":
        (here / file).write_bytes(b"precious")
    before = (here / file).read_bytes()
    assert main(["rosbag", *words.split()]) == 2
    assert why in capsys.readouterr().err
    assert (here / file).read_bytes() == before


def test_what_is_named_is_written_over(here: Path) -> None:
    (here / "drive.mcap").write_bytes(b"old")
    assert main(["rosbag", "convert", "drive.bag", "-o", "drive.mcap"]) == 0
    assert count(here / "drive.mcap") == count(GOLDEN)
    assert main(["rosbag", "convert", "drive.bag", "-o", "drive.bag", "--compression", "lz4"]) == 0
    assert count(here / "drive.bag") == count(GOLDEN)


def test_other_commands_read_mcap_files_as_they_do_bags(here: Path, capsys: Capture) -> None:
    main(["rosbag", "convert", "drive.bag"])
    capsys.readouterr()
    said = []
    for file in ("drive.bag", "drive.mcap"):
        assert main(["rostopic", "list", file]) == 0
        said.append(capsys.readouterr().out)
        topic = said[-1].split()[0]
        assert main(["rostopic", "echo", file, topic, "-n", "1"]) == 0
        said[-1] += capsys.readouterr().out
        assert main(["export", "csv", file, topic, "-o", f"{file}.csv"]) == 0
        said[-1] += (here / f"{file}.csv").read_text(encoding="utf-8")
        capsys.readouterr()
    assert said[0] == said[1]


def test_rosbag_info_shows_mcap_files_too(here: Path, capsys: Capture) -> None:
    assert main(["rosbag", "convert", "drive.bag", "-o", "drive.mcap"]) == 0
    capsys.readouterr()
    assert main(["rosbag", "info", "drive.mcap"]) == 0
    shown = capsys.readouterr().out
    assert main(["rosbag", "verify", "drive.mcap"]) == 0
    assert shown == capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (["verify", "none.bag"], "none.bag: could not be read: No such file"),
        (["convert", "drive.txt"], "drive.txt: must end with .bag or .mcap"),
        (["convert", "drive.bag", "--compression", "bz2"], "--compression: unknown compression bz2 for a file .mcap"),
        (
            ["recover", "drive.bag", "-o", "no/such/folder.bag"],
            "no/such/folder.bag: --output: could not be written: No such",
        ),
    ],
)
def test_what_cannot_be(words: list[str], why: str, here: Path, capsys: Capture) -> None:
    assert main(["rosbag", *words]) == 2
    assert why in capsys.readouterr().err
