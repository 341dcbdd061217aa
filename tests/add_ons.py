"""The add-ons that tests need. Tests of an add-on that was taken out of a copy of the checkout are not collected.

`tests/extra/NAME` needs the add-on NAME. The table has every other file and folder that needs one. The program
`python -m dev.take_out --tests` takes add-ons out and runs the rest, so a file that the table lacks fails there.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[1]
SHELF = "ros_libraries"

EVERY = "attach c convert debugger exploration procedures profiler reports ros_host viewers ros_libraries"
NEEDS = {
    "cli/test_board.py::test_a_report": "reports",
    "cli/test_build.py": "c",
    "cli/test_completion.py::test_all_commands": EVERY,
    "cli/test_cut_journals.py::test_report_of_a_journal_that_is_cut_off_warns": "reports",
    "cli/test_explore.py": "exploration",
    "cli/test_json_output.py::test_nothing_else_is_on_standard_output": "exploration reports",
    "cli/test_launch.py": "ros_libraries",
    "cli/test_log_command.py::test_performance_data_as_a_picture": "reports",
    "cli/test_look_commands.py": "reports",
    "cli/test_new_c.py": "c",
    "cli/test_node.py::test_where_the_master_serves_is_told_once": "ros_host",
    "cli/test_one_verdict.py": "ros_libraries",
    "cli/test_options_of_runs.py": "exploration reports",
    "cli/test_parser.py": "c convert exploration reports",
    "cli/test_plot.py": "reports",
    "cli/test_replay_stops.py": "debugger",
    "cli/test_ros_tools.py": "ros_libraries",
    "cli/test_rostest.py": "ros_libraries",
    "cli/test_rosservice.py": "ros_libraries",
    "cli/test_spellings.py": EVERY,
    "cli/test_stalls.py::test_commands_that_look_at_a_run_end_as_failed": "reports",
    "cli/test_sweep.py": "exploration reports",
    "cli/test_rostopic.py": "ros_libraries",
    "cli/test_trace_text.py": "reports",
    "cli/test_viewers.py": "viewers",
    "corpus": "ros_libraries",
    "docs": EVERY,
    "extra/convert": "c",
    "extra/convert/test_interface_library.py::test_linear_math_exists_for_python": "ros_libraries",
    "extra/procedures": "exploration",
    "extra/reports/test_board_fit.py": "c",
    "extra/viewers/rosbridge/test_applications.py": "ros_host",
    "extra/viewers/rosbridge/test_endurance.py": "ros_host",
    "extra/viewers/rosbridge/test_entering.py": "ros_host",
    "extra/viewers/rosbridge/test_session.py": "ros_host",
    "extra/viewers/rosbridge/test_strangers.py": "ros_host",
    "extra/viewers/test_bounds.py": "ros_host",
    "faults/test_explored_faults.py": "exploration",
    "flight/test_run.py::test_a_picture": "reports",
    "fuzz": "c convert debugger exploration reports ros_host viewers",
    "ground/test_play.py": "ros_libraries",
    "interpreter/test_faces.py": "c reports",
    "missions/test_rover.py": "ros_libraries",
    "mission/test_cpp_nodes.py": "c convert",
    "mission/test_determinism_nodes.py": "ros_libraries",
    "mission/test_leftovers.py": "exploration",
    "missions/test_pathfinder.py": "exploration",
    "nodes/files/test_closed_world.py": "exploration",
    "nodes/stdlib/test_lock_points.py": "exploration",
    "packaging/test_ci.py": "exploration",
    "packaging/test_take_out.py": EVERY,
    "packaging/test_wheel.py": "c",
    "pilot/test_idleness.py::test_synchronizer_that_never_calls_back_has_a_line": "ros_libraries",
    "pilot/test_idleness.py::test_synchronizer_without_callback_has_a_line": "ros_libraries",
    "pilot/mission_check/test_ros_files.py::test_a_launch_file_with_many_problems": "c convert",
    "pilot/mission_check/test_missing_imports.py::test_import_of_a_node": "ros_libraries",
    "pilot/test_never_judged.py": "exploration reports",
    "quality": "exploration reports",
    "ros_libraries": "ros_libraries",
    "roscfe": "c convert ros_libraries",
    "rospy_shim/client/test_logs.py": "ros_libraries",
    "rospy_shim/client/test_names_of_rospy.py": "ros_libraries",
    "rospy_shim/client/test_stages.py": "ros_libraries",
    "rospy_shim/client/test_star_imports.py::test_star_import_of_actionlib_has_its_imported_modules": "ros_libraries",
    "rospy_shim/client/test_stray_packets.py": "ros_host",
    "rospy_shim/master": "ros_libraries",
    "rospy_shim/test_private_names.py": "ros_libraries",
    "rospy_shim/test_foreign_code.py::test_catkin_finds_files_of_packages": "ros_libraries",
    "rospy_shim/types/msgs/test_hostile_counts.py": "convert",
    "schedules/test_exploring.py": "exploration",
    "schedules/test_exploring_numbers.py": "exploration",
    "security/test_terminal.py": "exploration reports",
    "security/test_tricks.py": "c convert debugger exploration reports ros_host viewers",
    "test_api_map.py": "c",
    "test_contracts.py": EVERY,
    "test_costs.py::test_each_line_names_an_existing_case": EVERY,
    "test_dev_programs.py": EVERY,
    "test_docs.py": EVERY,
    "test_layers.py::test_imports_go_down": EVERY,
    "test_layers.py::test_libraries_are_imported_only_as_code_of_nodes": "ros_libraries",
    "test_plugins.py": EVERY,
    "testing/test_explore.py": "exploration",
    "testing/test_plugin.py": "exploration",
}
"""By folder, file or test below `tests`: the add-ons that it needs, separated by blanks."""


MISSING = frozenset(
    each for each in EVERY.split() if not (ROOT / each if each == SHELF else ROOT / "cfepy" / "extra" / each).is_dir()
)
"""The add-ons that this checkout lacks."""


def needed(test: str) -> Iterator[str]:
    """Yield the add-ons that tests need.

    Args:
        test: path of a folder or a file below `tests`, with "::" and a function for one test.
    """
    file, _, function = test.partition("::")
    if function:
        yield from NEEDS.get(test, "").split()
    for each in (PurePosixPath(file), *PurePosixPath(file).parents):
        yield from NEEDS.get(str(each), "").split()
    match file.split("/"):
        case ["extra", name, *_]:
            yield name


def lacks_add_on(test: str) -> bool:
    """Return whether tests need an add-on that was taken out of this checkout; see `needed`."""
    return bool(MISSING) and not MISSING.isdisjoint(needed(test))
