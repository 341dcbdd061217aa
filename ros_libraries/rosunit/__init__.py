"""rosunit: Python unit tests that write their results as JUnit XML for ROS's build tools.

Source: wiki.ros.org/rosunit. `unitrun` is the main routine of a test without a graph. `rostest.rosrun`, for tests
with one, uses the same runner.
"""

from __future__ import annotations

from rosunit import junitxml
from rosunit.baretest import print_runner_summary, print_unittest_summary
from rosunit.core import XML_OUTPUT_FLAG, create_xml_runner, rostest_name_from_path, xml_results_file
from rosunit.pyunit import unitrun
from rosunit.xmlrunner import XMLTestRunner

__all__ = [
    "XML_OUTPUT_FLAG",
    "XMLTestRunner",
    "create_xml_runner",
    "junitxml",
    "print_runner_summary",
    "print_unittest_summary",
    "rostest_name_from_path",
    "unitrun",
    "xml_results_file",
]
