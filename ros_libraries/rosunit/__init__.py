"""rosunit: Python unit tests that leave their results as JUnit XML, as ROS's build tools want them.

Source: wiki.ros.org/rosunit. `unitrun` is the main routine of a test that needs no graph; `rostest.rosrun`, for tests
that do, stands on the same runner.
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
