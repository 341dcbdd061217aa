"""rosunit and rostest in a node: results as XML, exit status, queries of the graph."""

from __future__ import annotations

import sys
from pathlib import Path
from xml.etree import ElementTree

from tests.rospy_shim.missions import run_nodes

UNIT = """
    import sys, unittest
    import rosunit

    class TestThings(unittest.TestCase):
        def test_good(self):
            print("seen")

        def test_bad(self):
            self.assertEqual(1, 2, "not <equal> \\x01")

        def test_broken(self):
            raise KeyError("k")

        @unittest.skip("not today")
        def test_skipped(self):
            pass

    rosunit.unitrun("pack", "things", TestThings, sysargs=["x", "--gtest_output=xml:out/results.xml"])
    print("not reached")
    """


COUNTED = 3 if sys.version_info[:3] == (3, 12, 1) else 4  # that Python alone does not count tests that are skipped


def test_results_are_written_as_junit_xml(tmp_path: Path) -> None:
    run = run_nodes(tmp_path, {"UNIT": UNIT})
    suite = ElementTree.parse(tmp_path / "out/results.xml").getroot()
    assert {name: suite.get(name) for name in ("tests", "errors", "failures")} == {
        "tests": str(COUNTED),
        "errors": "1",
        "failures": "1",
    }
    cases = {case.get("name"): case for case in suite.findall("testcase")}
    assert cases["test_good"].get("classname") == "__main__.TestThings"
    assert "not <equal> &#x0001;" in cases["test_bad"].findtext("failure", "")
    assert cases["test_broken"].find("error").get("type") == "KeyError"  # type: ignore[union-attr]
    assert list(cases["test_skipped"]) == []
    assert suite.findtext("system-out") == "seen\n"
    assert f" * TESTS: {COUNTED}" in run.printed["UNIT"]
    assert " * FAILURES: 1 [test_bad]" in run.printed["UNIT"]
    assert "not reached" not in run.printed["UNIT"]


def test_results_can_be_read_and_added_up(tmp_path: Path) -> None:
    source = """
        from rosunit import junitxml
        open("a.xml", "w").write(junitxml.test_failure_junit_xml("a", "it <broke>"))
        open("b.xml", "w").write(junitxml.test_success_junit_xml("b"))
        result = junitxml.read("a.xml", "pack.a")
        result.accumulate(junitxml.read("b.xml", "pack.b"))
        print(result.num_tests, result.num_errors, result.num_failures)
        for case in result.test_case_results:
            print(case.name, case.passed, [each.text for each in case.failures])
        open("c.xml", "w").write("no xml")
        print(junitxml.read("c.xml", "c").num_errors)
        """
    assert run_nodes(tmp_path, {"N": source}).printed["N"] == [
        "2 0 1",
        "pack.a.Results/test_ran False ['it <broke>']",
        "pack.b.Results/test_ran True []",
        "1",
    ]


def test_names_of_result_files(tmp_path: Path) -> None:
    source = """
        import rosunit
        print(rosunit.rostest_name_from_path("/ws/pack", "/ws/pack/test/sub/x.test"))
        print(rosunit.XML_OUTPUT_FLAG)
        """
    assert run_nodes(tmp_path, {"N": source}).printed["N"] == ["test_sub_x", "--gtest_output=xml:"]


def test_rostest_runs_a_node_and_queries_the_graph(tmp_path: Path) -> None:
    talker = """
        import rospy
        from std_msgs.msg import String
        rospy.init_node("talker")
        rospy.Publisher("chatter", String, queue_size=1)
        rospy.spin()
        """
    check = """
        import unittest
        import rospy, rostest
        from std_msgs.msg import String

        class TestGraph(unittest.TestCase):
            def test_members(self):
                rospy.init_node("check")
                rospy.Subscriber("/chatter", String)
                rospy.sleep(1)
                self.assertTrue(rostest.is_publisher("/chatter", "/talker"))
                self.assertFalse(rostest.is_publisher("/chatter", "/check"))
                self.assertTrue(rostest.is_subscriber("/chatter", "/check"))
                self.assertFalse(rostest.is_subscriber("/other", "/check"))

        rostest.rosrun("pack", "graph", TestGraph, ["x", "--text"])
        print("shut down", rospy.is_shutdown())
        """
    run = run_nodes(tmp_path, {"TALKER": talker, "CHECK": check})
    assert run.printed["check"][-1] == "shut down True"
    assert " * RESULT: SUCCESS" in run.printed["check"]
