"""Public races: the list, the tool with a small package of our own, and the page with the recorded results."""

from __future__ import annotations

import subprocess
from pathlib import Path
from textwrap import dedent

import pytest

from cfepy.extra.exploration.verdict import ENDED
from cfepy.status import UsageError
from dev.quality.public_races.races import AFTER, BEFORE, MISSIONS, PublicRace, PublicRaces, read_races
from dev.quality.public_races.report import PAGE, page, read_results, write_results
from dev.quality.public_races.trial import FIFO, LEAST_MENDED, MOST, Found, Result, found_of, policy_of, try_race

HASH = 40
STARTUP = "CFE_APP, counting.py, __main__, COUNTING, 100, 16384, 0x0, 0;\n!\n"
NODE = """
    import sys
    import threading

    import rospy
    from tally import Tally

    rospy.init_node("counting")
    tally = Tally()
    threads = [threading.Thread(target=tally.add) for _ in range(2)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    if tally.count != 2:
        sys.exit(f"two calls were counted as {tally.count}")
"""
TALLY = """
    import rospy
    import threading

    class Tally:
        def __init__(self):
            self.count = 0
            self.lock = threading.Lock()

        def add(self):
            count = self.count
            rospy.get_param("/step", 1)
            self.count = count + 1
"""
MENDED = TALLY.replace("add(self):", "add(self):\n          with self.lock:")


def git(folder: Path, *words: str) -> str:
    options = ["-c", "user.name=n", "-c", "user.email=e@example.org"]
    done = subprocess.run(["git", "-C", str(folder), *options, *words], check=True, capture_output=True, text=True)
    return done.stdout.strip()


def committed(repository: Path, text: str) -> str:
    """Commit a form of the package. Returns the commit's hash."""
    file = repository / "src/tally/__init__.py"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(dedent(text), encoding="utf-8")
    git(repository, "add", ".")
    git(repository, "commit", "--quiet", "-m", "form")
    return git(repository, "rev-parse", "HEAD")


def fetched(tmp_path: Path) -> PublicRace:
    """Return a race of a package of our own, whose sources are fetched and whose mission is written."""
    repository = tmp_path / "mirrors/own+tally/repo"
    repository.mkdir(parents=True)
    git(repository, "init", "--quiet")
    before, after = committed(repository, TALLY), committed(repository, MENDED)
    mission = tmp_path / "missions/counting"
    mission.mkdir(parents=True)
    (mission / "startup.scr").write_text(STARTUP, encoding="utf-8")
    (mission / "counting.py").write_text(dedent(NODE), encoding="utf-8")
    race = PublicRace(
        "counting", "own/tally", "issue 1", "a count is lost", before, after, ("src/tally/__init__.py",), seconds=1
    )
    race = PublicRace(**{**{key: getattr(race, key) for key in race.__slots__}, "places": {"src/tally": "tally"}})
    races = PublicRaces({"counting": race}, {"own/tally": "MIT"})
    assert races.fetch(tmp_path / "sources", tmp_path / "mirrors") == [f"own/tally {before}", f"own/tally {after}"]
    assert races.fetch(tmp_path / "sources", tmp_path / "mirrors") == []
    return race


def test_forms_of_a_race_are_laid_out_unmodified(tmp_path: Path) -> None:
    race = fetched(tmp_path)
    for form, text in ((BEFORE, TALLY), (AFTER, MENDED)):
        folder = race.lay_out(tmp_path / "sources", form, tmp_path / form, tmp_path / "missions")
        assert (folder / "tally/__init__.py").read_text(encoding="utf-8") == dedent(text)
        assert (folder / "startup.scr").read_text(encoding="utf-8") == STARTUP


def test_missing_sources_are_named(tmp_path: Path) -> None:
    race = fetched(tmp_path)
    with pytest.raises(UsageError, match="no sources of own/tally"):
        race.lay_out(tmp_path / "nowhere", BEFORE, tmp_path, tmp_path / "missions")


@pytest.mark.slow
def test_race_is_found_and_its_mended_form_passes(tmp_path: Path) -> None:
    result = try_race(fetched(tmp_path), tmp_path / "sources", most=40, missions=tmp_path / "missions")
    assert result.found is not None
    assert result.found.failure.startswith(f"{ENDED}: COUNTING: exit status 1")
    assert "Tally.count" in result.found.cause
    assert (result.mended, result.false_alarm) == (40, "")


def test_failure_under_fifo_needs_no_schedule() -> None:
    failure = {
        "under_fifo": True,
        "shrunk": None,
        "kind": "k",
        "who": "w",
        "text": "t",
        "cause": "",
        "first_schedule": "fifo",
    }
    assert found_of(failure, 7) == Found(0, FIFO, 0, 0, "k: w: t", "")


def test_policies_are_named_with_the_depth_of_pct() -> None:
    assert [policy_of(each) for each in ("random:0", "pct:10:3:479", "abreast:5")] == ["random", "pct 3", "abreast"]


def test_unknown_race_is_refused() -> None:
    with pytest.raises(UsageError, match="unknown race nothing"):
        read_races().chosen(["nothing"])


def test_list_is_complete() -> None:
    races = read_races()
    for race in races.races.values():
        assert len(race.before) == len(race.after) == HASH, race.name
        assert race.before != race.after, race.name
        assert race.repo in races.licences, race.name
        assert race.files, race.name
        assert race.flies or race.reason, race.name
        assert not race.flies or (MISSIONS / (race.mission or race.name) / "startup.scr").is_file(), race.name
    named = {race.mission or race.name for race in races.races.values()}
    assert {folder.name for folder in MISSIONS.iterdir()} <= named


def test_results_belong_to_the_list_and_are_kept(tmp_path: Path) -> None:
    races, results = read_races(), read_results()
    assert set(results) <= {race.name for race in races.races.values() if race.flies}
    for name, result in results.items():
        assert result.found or result.schedules >= LEAST_MENDED, name
        assert result.schedules <= MOST, name
        assert result.mended >= LEAST_MENDED or result.false_alarm, name
        assert result.found or races.races[name].reason, name
    write_results(races, results, tmp_path / "results.json")
    assert read_results(tmp_path / "results.json") == results


def test_page_matches_the_results() -> None:
    text = page(read_races(), read_results())
    assert PAGE.read_text(encoding="utf-8") == text, "run python -m dev.quality.public_races report"


def test_page_tells_missed_races_false_alarms_and_grounded_ones() -> None:
    race = PublicRace(
        "near", "own/near", "issue 1", "a text", "a" * HASH, "b" * HASH, ("x.py",), {"x": "y"}, reason="why"
    )
    grounded = PublicRace("far", "own/near", "issue 2", "another text", "a" * HASH, "b" * HASH, ("x.py",), reason="GUI")
    races = PublicRaces({"near": race, "far": grounded}, {"own/near": "MIT"})
    text = page(races, {"near": Result(None, 1000, None, 100, "exit: X: no")})
    assert "finds 0 of 1 races" in text
    assert "Of the mended forms, 1 failed" in text
    assert "- `near`: why" in text
    assert "- `near`: exit: X: no. why." in text
    assert "| own/near | issue 2 | another text | GUI |" in text
