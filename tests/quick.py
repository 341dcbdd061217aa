"""The quick loop: `python -m pytest -m quick`, some seconds of each package after a change, before the whole suite.

The rule: of each file the first cases of its first tests, which are those of what it is about. Left out are the folders
whose tests search, fly long sessions or look at other people's code, and files in which even the first tests take long.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Protocol, TypeVar

MARK = "quick"
TESTS_OF_A_FILE = 3
LONG_FOLDERS = {"corpus", "functional", "packaging", "peers", "property", "quality", "requirements", "ros_nodes"}
LONG_FILES = {
    "test_actionlib_goals", "test_actionlib_simple", "test_app_life", "test_bag", "test_campaign",
    "test_campaign_property", "test_capture_resets", "test_check_determinism", "test_collector", "test_command",
    "test_crews", "test_determinism", "test_determinism_nodes", "test_distributions", "test_documentation",
    "test_evs_apps", "test_evs_log", "test_example_package", "test_explore", "test_exploring_numbers",
    "test_faults_command", "test_fork_server", "test_forking_judge", "test_genpy_equal", "test_golden_files",
    "test_golden_telemetry", "test_host_network", "test_hypothesis", "test_isolation", "test_launch_files",
    "test_leftovers", "test_life", "test_link", "test_missions", "test_network", "test_new", "test_ordered_sets",
    "test_page_in_browser", "test_plan", "test_plugin", "test_processor_faults", "test_property", "test_psutil",
    "test_put_faults", "test_random_commands", "test_replay", "test_report", "test_ros_faults", "test_rows",
    "test_sch", "test_shipment", "test_shipped_missions", "test_shrink", "test_slave_api", "test_strategies",
    "test_stuck", "test_table_yaml", "test_tables", "test_tbl_properties", "test_text", "test_time_values",
    "test_uplink_fuzz", "test_xtce",
}  # fmt: skip


class Test(Protocol):
    """What is asked of a collected test: its file, its function and its case."""

    path: Path
    originalname: str


T = TypeVar("T", bound=Test)


def is_long(path: Path) -> bool:
    """Whether a file or folder of tests is left out of the quick loop."""
    return path.stem in LONG_FILES or not LONG_FOLDERS.isdisjoint(path.parts)


def quick_ones(tests: Iterable[T]) -> Iterator[T]:
    """The first cases of the first tests of each file."""
    seen: dict[Path, set[str]] = {}
    for test in tests:
        of_file = seen.setdefault(test.path, set())
        if test.originalname in of_file or len(of_file) == TESTS_OF_A_FILE or is_long(test.path):
            continue
        of_file.add(test.originalname)
        yield test
