"""The file of a journal: its content, and the handling of truncated, damaged and foreign ones."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from cfepy.attachment import Attachment
from cfepy.ground.link import GroundLink
from cfepy.journal import JournalRecorder, read_journal, record, replay
from cfepy.journal.journal import MARK, FrameWriter, JournalError, read_frames
from cfepy.mission import Mission
from cfepy.pilot.pilot import fly
from cfepy.pilot.results import Results
from cfepy.reading.resources import import_path
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.console import Console
from tests.journal.missions import paths, race
from tests.journal.replays import plan_for


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """The journal of a short run."""
    record(plan_for(race(tmp_path), 1, schedule="random:3"), tmp_path / "run.cfepy")
    return tmp_path / "run.cfepy"


def rewritten(path: Path, change: Callable[[str, dict[str, Any]], None]) -> Path:
    """Return a copy with changed frames."""
    writer = FrameWriter(path.with_suffix(".other"))
    for kind, body in read_frames(path):
        change(kind, body)
        writer.write(kind, body)
    writer.close()
    return path.with_suffix(".other")


def test_journal_has_plan_files_decisions_and_digests(tmp_path: Path) -> None:
    flown = record(plan_for(paths(tmp_path), 1, seed=4, schedule="random:3"), tmp_path.with_suffix(".cfepy"))
    journal = read_journal(tmp_path.with_suffix(".cfepy"))
    assert journal.plan.seed == 4
    assert {Path(path).name for path in journal.files} == {
        "startup.scr",
        "paths.py",
        "helper.py",
        "data.txt",
    }
    assert journal.files[str(tmp_path / "data.txt")].data == b"from disk"
    assert journal.header.versions["python"] == ".".join(map(str, sys.version_info[:3]))
    assert len(journal.mission_hash) == 64
    assert journal.end is not None
    assert (journal.end.trace, journal.end.now_ns) == (flown.trace, flown.mission.kernel.now)
    assert journal.checkpoints[-1].digest == flown.trace
    assert 0 < len(journal.decisions) < journal.decided


def test_journal_without_files_replays_from_the_host(tmp_path: Path) -> None:
    folder = tmp_path / "mission"
    folder.mkdir()
    plan = plan_for(race(folder), 1)
    with JournalRecorder(tmp_path / "run.cfepy", plan, carried=0) as recorder:
        flown = fly(plan, attachments=[recorder])
        recorder.end(flown)
    journal = read_journal(tmp_path / "run.cfepy")
    assert all(each.data is None for each in journal.files.values())
    assert replay(journal).verdict.same
    (folder / "race.py").write_text("print('another one')", encoding="utf-8")
    other = replay(journal).verdict
    assert not other.same
    assert other.difference is not None


def test_truncated_journal_is_replayed_up_to_its_end(run: Path) -> None:
    whole = run.read_bytes()
    journal = read_journal(run)
    first_frame = len(MARK) + 8 + int.from_bytes(whole[len(MARK) : len(MARK) + 4], "little")
    for size in range(len(whole) - 1, 0, -len(whole) // 12):
        run.write_bytes(whole[:size])
        if size < first_frame:
            with pytest.raises(JournalError, match=r"is truncated|is not a journal"):
                read_journal(run)
            continue
        cut = read_journal(run)
        assert cut.end is None
        assert cut.checkpoints == journal.checkpoints[: len(cut.checkpoints)]
        verdict = replay(cut).verdict
        assert verdict.same
        assert not verdict.whole


def test_journal_cut_during_shutdown_ends_at_its_time_limit(run: Path) -> None:
    whole = run.read_bytes()
    end_ns = read_journal(run).known_until_ns
    run.write_bytes(whole[:-40])
    cut = read_journal(run)
    assert cut.end is None
    assert cut.known_until_ns > end_ns
    for until_ns in (None, 3 * end_ns):
        replayed = replay(cut, until_ns=until_ns)
        assert replayed.verdict.same
        assert replayed.flown.results.virtual_s == 1


def test_truncated_journal_without_a_time_limit_ends_at_the_default_limit(tmp_path: Path) -> None:
    path = tmp_path / "run.cfepy"
    record(plan_for(race(tmp_path)), path)
    path.write_bytes(path.read_bytes()[:-40])
    cut = read_journal(path)
    assert cut.end is None
    assert replay(cut, until_ns=30 * NS_PER_S).flown.results.virtual_s == 10


def test_damaged_journal_is_reported_with_its_place(run: Path) -> None:
    data = bytearray(run.read_bytes())
    data[len(data) // 2] ^= 1
    run.write_bytes(data)
    with pytest.raises(JournalError, match=r"run\.cfepy: is damaged at byte \d+"):
        read_journal(run)


def test_impossible_frame_length_is_damage_and_not_a_truncation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    writer = FrameWriter(tmp_path / "frames")
    writer.write("a", {"b": 1})
    writer.close()
    size = (tmp_path / "frames").stat().st_size - len(MARK) - 8
    for largest, cut, frames in ((size, 0, [("a", {"b": 1})]), (size, 1, []), (size - 1, 1, None)):
        monkeypatch.setattr("cfepy.journal.journal.JOURNAL_FRAME_BYTES", largest)
        (tmp_path / "cut").write_bytes((tmp_path / "frames").read_bytes()[: len(MARK) + 8 + size - cut])
        if frames is not None:
            assert list(read_frames(tmp_path / "cut")) == frames
            continue
        with pytest.raises(JournalError, match="is damaged at byte"):
            list(read_frames(tmp_path / "cut"))


def test_other_files_and_other_formats_are_refused(run: Path, tmp_path: Path) -> None:
    (tmp_path / "text").write_text("CFE_APP, x", encoding="utf-8")
    with pytest.raises(JournalError, match="is not a journal"):
        read_journal(tmp_path / "text")
    with pytest.raises(JournalError, match="cannot be read: No such file"):
        read_journal(tmp_path / "nothing")

    def later(kind: str, body: dict[str, Any]) -> None:
        if kind == "header":
            body["format"] = 99

    with pytest.raises(JournalError, match="has format 99"):
        read_journal(rewritten(run, later))

    def without(kind: str, body: dict[str, Any]) -> None:
        body.pop("plan", None)

    with pytest.raises(JournalError, match="a frame 'header' has no 'plan'"):
        read_journal(rewritten(run, without))


def test_changed_seed_is_reported_with_the_first_difference(run: Path) -> None:
    def change(kind: str, body: dict[str, Any]) -> None:
        if kind == "header":
            body["plan"]["seed"] = 77

    other = replay(read_journal(rewritten(run, change)))
    assert not other.verdict.same
    difference = other.verdict.difference
    assert difference is not None
    assert difference.after.records < difference.before.records


def test_changed_results_alone_are_reported(run: Path) -> None:
    def change(kind: str, body: dict[str, Any]) -> None:
        if kind == "end":
            body["results"] = "0" * 32

    verdict = replay(read_journal(rewritten(run, change))).verdict
    assert verdict.difference is None
    assert verdict.other_results
    assert not verdict.same


def test_unknown_fields_of_later_versions_are_ignored(run: Path) -> None:
    def change(kind: str, body: dict[str, Any]) -> None:
        if kind == "header":
            body["surprise"] = 1
            body["plan"]["another"] = 2

    assert replay(read_journal(rewritten(run, change))).verdict.same


class Killer(Attachment):
    """Ends the process at a virtual time, as a crash would."""

    def __init__(self, at_ns: int) -> None:
        self._at_ns = at_ns

    def begin(self, mission: Any) -> None:
        def die() -> None:
            mission.kernel.delay(self._at_ns)
            os._exit(9)

        mission.kernel.spawn("KILLER", die)


@pytest.mark.slow
def test_killed_process_leaves_a_journal(tmp_path: Path) -> None:
    code = (
        "import sys\nfrom cfepy.journal import record\nfrom tests.journal.replays import plan_for\n"
        "from tests.journal.test_file import Killer\n"
        "record(plan_for('capture', 30), sys.argv[1], [Killer(2_000_000_000)])"
    )
    environment = {**os.environ, "PYTHONPATH": f"{import_path()}{os.pathsep}{Path(__file__).parents[2]}"}
    done = subprocess.run([sys.executable, "-c", code, str(tmp_path / "run.cfepy")], env=environment, check=False)
    assert done.returncode == 9
    journal = read_journal(tmp_path / "run.cfepy")
    assert journal.end is None
    assert 1_000_000_000 < journal.known_until_ns < 2_000_000_000


def test_input_is_written_before_the_run_continues(tmp_path: Path) -> None:
    plan = plan_for("lab", 3)
    with (
        JournalRecorder(tmp_path / "run.cfepy", plan) as recorder,
        Mission(plan.spec(), console=Console(quiet=True), attachments=[recorder]) as mission,
    ):
        mission.run_for(2)
        with GroundLink(mission) as ground:
            assert ground.send(b"first")
            assert ground.send(b"second")
        journal = read_journal(tmp_path / "run.cfepy")
    (pause,) = journal.pauses
    assert (pause.until_ns, [event.values[-1] for event in pause.events]) == (2_000_000_000, [b"first", b"second"])


def test_journal_that_cannot_be_written_is_reported_before_the_run(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be written"):
        record(plan_for("lab", 1), tmp_path / "nowhere" / "run.cfepy")


def test_secrets_are_not_recorded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AWS_SECRET_ACCESS_KEY", "do not tell")
    monkeypatch.setenv("ROBOT", "r2")
    paths(tmp_path)
    plan = plan_for(str(tmp_path / "paths.py"), 1, command="node")
    record(plan, tmp_path.with_suffix(".cfepy"), console=Console(quiet=True))
    environ = read_journal(tmp_path.with_suffix(".cfepy")).header.environ
    assert environ["ROBOT"] == "r2"
    assert b"do not tell" not in tmp_path.with_suffix(".cfepy").read_bytes()


def test_run_that_does_not_start_writes_no_results(tmp_path: Path) -> None:
    with pytest.raises(UsageError):
        record(plan_for("no such mission", 1), tmp_path / "run.cfepy")
    with pytest.raises(JournalError, match="truncated"):
        read_journal(tmp_path / "run.cfepy")


def test_digest_of_results_excludes_the_wall_clock(tmp_path: Path) -> None:
    from cfepy.journal.journal import digest_of

    plan = plan_for(race(tmp_path), 1)
    one, other = fly(plan).results, fly(plan).results
    assert isinstance(one, Results)
    assert digest_of(one) == digest_of(other)
