"""The runner itself, with small test files of our own."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from cfepy.status import UsageError
from dev.corpus.sources import Sources
from dev.peers import report
from dev.peers.flight import Verdict, run
from dev.peers.peers import FILE, ROSTEST, UNIT, Peer, Peers, read_peers

UNIT_FILE = """
import unittest
import rospy
import sys
from os.path import dirname
sys.path.append(dirname(dirname(__file__)))
from helpers import twice

class Case(unittest.TestCase):
    def test_good(self):
        self.assertEqual(twice(2), 4)
    def test_bad(self):
        self.fail("on purpose")
    @unittest.skip("not here")
    def test_left_out(self):
        pass
    @unittest.expectedFailure
    def test_known(self):
        self.fail()
    def test_parts(self):
        for number in range(2):
            with self.subTest(number=number):
                self.assertEqual(number, 0)

class TestPlain:
    def setup_method(self):
        self.number = 3
    def test_number(self):
        assert self.number == 3

def test_alone():
    rospy.init_node("alone")
    rospy.sleep(100)
"""
HELPERS = "def twice(number):\n    return 2 * number\n"
LAUNCH = '<launch><test pkg="own" type="check.py" test-name="check"/></launch>'
CHECK = """#!/usr/bin/env python
import sys, unittest, rostest
class Check(unittest.TestCase):
    def test_good(self):
        pass
    def test_bad(self):
        self.fail("on purpose")
rostest.rosrun("own", "check", Check, sys.argv)
"""


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """Sources of one repository with a package of tests."""
    package = tmp_path / "sources" / "us+robots" / "own"
    (package / "test" / "unit").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>own</name></package>", encoding="utf-8")
    (package / "test" / "unit" / "__init__.py").write_text("", encoding="utf-8")
    (package / "test" / "unit" / "test_all.py").write_text(UNIT_FILE, encoding="utf-8")
    (package / "test" / "helpers.py").write_text(HELPERS, encoding="utf-8")
    (package / "test" / "unit" / "broken.py").write_text("import no_such_module\n", encoding="utf-8")
    (package / "test" / "check.py").write_text(CHECK, encoding="utf-8")
    (package / "test" / "check.test").write_text(LAUNCH, encoding="utf-8")
    return Sources(tmp_path / "sources")


def peer_of(path: str, kind: str, passed: int | None = None, **fields: object) -> Peer:
    """Return a file of that repository."""
    basis = Peer("own", "us/robots", path, kind, passed, passed, ("us/robots:own",))
    return replace(basis, **fields)  # type: ignore[arg-type]


@pytest.mark.slow
def test_tests_of_all_kinds_are_found_and_counted(sources: Sources) -> None:
    verdict = run(peer_of("own/test/unit/test_all.py", UNIT, 3), sources)
    assert verdict.reason == ""
    assert sorted(name for name, said in verdict.said.items() if said == "passed") == [
        "Case.test_good",
        "TestPlain.test_number",
        "test_alone",
    ]
    assert sorted(verdict.failing) == ["Case.test_bad", "Case.test_parts"]
    assert "AssertionError: on purpose" in verdict.failing["Case.test_bad"]
    assert verdict.passed == 3
    assert verdict.good


def test_file_that_cannot_be_imported_is_reported(sources: Sources) -> None:
    verdict = run(peer_of("own/test/unit/broken.py", UNIT), sources)
    assert "No module named 'no_such_module'" in verdict.failing["import"]
    assert not verdict.good


@pytest.mark.slow
def test_launch_files_run_as_by_rostest(sources: Sources) -> None:
    verdict = run(peer_of("own/test/check.test", ROSTEST, 1), sources)
    assert verdict.passed == 1
    assert list(verdict.failing) == ["own.check/__main__.Check/test_bad"]
    assert verdict.good


def test_missing_sources_are_reported(tmp_path: Path) -> None:
    verdict = run(peer_of("own/test/check.test", ROSTEST, 1), Sources(tmp_path))
    assert verdict.reason == "no sources of us/robots"
    assert not verdict.good


def test_verdict_is_good_with_at_most_a_twentieth_fewer_tests_than_on_ros() -> None:
    peer = peer_of("x", UNIT, 40)
    assert peer.enough(38)
    assert not peer.enough(37)
    assert replace(peer, aside={"a": "because", "b": "because"}).enough(37)


def test_list_of_peers_is_read_and_filtered() -> None:
    peers = read_peers()
    assert len(peers.files) == FILE.read_text(encoding="utf-8").count('"name": ')
    assert {peer.repo for peer in peers.files.values()} <= set(peers.commits)
    assert all(len(commit) == 40 for commit in peers.commits.values())
    assert {peer.name for peer in peers.chosen(["genmsg/"])} == {name for name in peers.files if "genmsg/" in name}
    with pytest.raises(UsageError, match="unknown test file nowhere"):
        peers.chosen(["nowhere"])


def test_page_names_failed_and_excluded_tests() -> None:
    peer = peer_of("own/test/x.py", UNIT, 2, aside={"Case.test_tcp": "no TCP"})
    verdict = Verdict(peer, {"Case.test_good": "passed", "Case.test_tcp": "boom"}, "", 1.0)
    peers = Peers({"own": peer}, {"us/robots": "a" * 40}, (("some files", "some reason"),))
    text = report.page(peers, [verdict])
    assert "| us/robots aaaaaaaa | 2 | 2 | 1 | ok | Case.test_tcp: no TCP |" in text
    assert "| some files | some reason |" in text
    assert '1 of these files are "ok"' in text
