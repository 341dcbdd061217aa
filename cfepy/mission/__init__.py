"""One mission on one simulated computer: reading its files, wiring it, running and resetting it.

The computer through all its resets belongs here, with the loader of its applications, the single entry point for
external input, and the record of the run. The ground's view of a mission is in `cfepy.ground`, rules for runs in
`cfepy.monitors`, and flying a run in `cfepy.pilot`. The central file is `cfepy/mission/mission.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.mission.app_sources import tree_of
    from cfepy.mission.compiled_code import find_compiled
    from cfepy.mission.cpp_nodes import (
        ARENA_BYTES,
        ARRAY,
        GROUND_SERVICE,
        MOST_ITEMS,
        PROFILES,
        TEXT,
        CppNodesConfig,
        CppNodesError,
        NodeGround,
    )
    from cfepy.mission.device_config import DeviceConfig
    from cfepy.mission.drawn_parameters import CHOICE, INTEGERS, ParameterDistribution
    from cfepy.mission.endless_wait import EndlessWait, EndlessWaits, WaitsAtEnds, endless_waits, note_waits
    from cfepy.mission.failed_code import FailedCode, RaisedError, TracebackReader
    from cfepy.mission.host_actions import CALL, FILE, PACKET, PARAM, PUBLISH, ROS, HostCall
    from cfepy.mission.launch import (
        COMPILED_STACK_BYTES,
        KEPT_ENVIRONMENT,
        TEST_RESULTS,
        NodeBuilder,
        built_programs,
        launch_file,
        lines_for,
        mission_environment,
        node_script,
        read_launch,
        sections_beside,
        spec_of,
        spec_of_node,
        spec_of_script,
    )
    from cfepy.mission.launch_names import (
        LAUNCH_FILES,
        STARTUP_SCRIPT,
        WITHOUT_LAUNCH,
        is_alone,
        is_mission_folder,
        mission_file_of,
    )
    from cfepy.mission.mission import Mission
    from cfepy.mission.mission_file import MissionSections, read_mission_file
    from cfepy.mission.mission_lookup import (
        LOCK_FILE,
        cpp_nodes_of,
        cpp_nodes_source,
        find_script,
        is_node,
        read_lock,
        read_mission,
        read_sections,
        shipped_missions,
    )
    from cfepy.mission.outside import Arrival, OutsideStream
    from cfepy.mission.packet_watch import HOST, PacketWatch, Seen, hearing, receivers
    from cfepy.mission.processor import CORE_APPS, Processor, make_ros2
    from cfepy.mission.python_code import find_code, find_declarations, find_node
    from cfepy.mission.record import DataRace, Overwrite, Reset, StackUse, Traffic
    from cfepy.mission.run_pieces import FIRST_PIECE_NS, PieceLength
    from cfepy.mission.settings import with_settings
    from cfepy.mission.spec import UNIX_AT_CFE_EPOCH, BuiltProgram, MissionSpec, SweepConfig
    from cfepy.mission.topic_watch import TopicMessage, TopicWatch, matches
    from cfepy.mission.tracebacks import app_traceback, described, reason

__all__ = [
    "ARENA_BYTES",
    "ARRAY",
    "CALL",
    "CHOICE",
    "COMPILED_STACK_BYTES",
    "CORE_APPS",
    "FILE",
    "FIRST_PIECE_NS",
    "GROUND_SERVICE",
    "HOST",
    "INTEGERS",
    "KEPT_ENVIRONMENT",
    "LAUNCH_FILES",
    "LOCK_FILE",
    "MOST_ITEMS",
    "PACKET",
    "PARAM",
    "PROFILES",
    "PUBLISH",
    "ROS",
    "STARTUP_SCRIPT",
    "TEST_RESULTS",
    "TEXT",
    "UNIX_AT_CFE_EPOCH",
    "WITHOUT_LAUNCH",
    "Arrival",
    "BuiltProgram",
    "CppNodesConfig",
    "CppNodesError",
    "DataRace",
    "DeviceConfig",
    "EndlessWait",
    "EndlessWaits",
    "FailedCode",
    "HostCall",
    "Mission",
    "MissionSections",
    "MissionSpec",
    "NodeBuilder",
    "NodeGround",
    "OutsideStream",
    "Overwrite",
    "PacketWatch",
    "ParameterDistribution",
    "PieceLength",
    "Processor",
    "RaisedError",
    "Reset",
    "Seen",
    "StackUse",
    "SweepConfig",
    "TopicMessage",
    "TopicWatch",
    "TracebackReader",
    "Traffic",
    "WaitsAtEnds",
    "app_traceback",
    "built_programs",
    "cpp_nodes_of",
    "cpp_nodes_source",
    "described",
    "endless_waits",
    "find_code",
    "find_compiled",
    "find_declarations",
    "find_node",
    "find_script",
    "hearing",
    "is_alone",
    "is_mission_folder",
    "is_node",
    "launch_file",
    "lines_for",
    "make_ros2",
    "matches",
    "mission_environment",
    "mission_file_of",
    "node_script",
    "note_waits",
    "read_launch",
    "read_lock",
    "read_mission",
    "read_mission_file",
    "read_sections",
    "reason",
    "receivers",
    "sections_beside",
    "shipped_missions",
    "spec_of",
    "spec_of_node",
    "spec_of_script",
    "tree_of",
    "with_settings",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".app_sources": ("tree_of",),
            ".host_actions": (
                "CALL",
                "FILE",
                "PACKET",
                "PARAM",
                "PUBLISH",
                "ROS",
                "HostCall",
            ),
            ".compiled_code": ("find_compiled",),
            ".device_config": ("DeviceConfig",),
            ".cpp_nodes": (
                "ARENA_BYTES",
                "ARRAY",
                "GROUND_SERVICE",
                "MOST_ITEMS",
                "PROFILES",
                "TEXT",
                "CppNodesConfig",
                "CppNodesError",
                "NodeGround",
            ),
            ".drawn_parameters": ("CHOICE", "INTEGERS", "ParameterDistribution"),
            ".endless_wait": (
                "EndlessWait",
                "EndlessWaits",
                "WaitsAtEnds",
                "endless_waits",
                "note_waits",
            ),
            ".failed_code": (
                "FailedCode",
                "RaisedError",
                "TracebackReader",
            ),
            ".mission_lookup": (
                "LOCK_FILE",
                "cpp_nodes_of",
                "cpp_nodes_source",
                "find_script",
                "is_node",
                "read_lock",
                "read_mission",
                "read_sections",
                "shipped_missions",
            ),
            ".launch": (
                "COMPILED_STACK_BYTES",
                "KEPT_ENVIRONMENT",
                "TEST_RESULTS",
                "NodeBuilder",
                "built_programs",
                "launch_file",
                "lines_for",
                "mission_environment",
                "node_script",
                "read_launch",
                "sections_beside",
                "spec_of",
                "spec_of_node",
                "spec_of_script",
            ),
            ".launch_names": (
                "LAUNCH_FILES",
                "STARTUP_SCRIPT",
                "WITHOUT_LAUNCH",
                "is_alone",
                "is_mission_folder",
                "mission_file_of",
            ),
            ".mission": ("Mission",),
            ".mission_file": (
                "MissionSections",
                "read_mission_file",
            ),
            ".outside": (
                "Arrival",
                "OutsideStream",
            ),
            ".packet_watch": (
                "HOST",
                "PacketWatch",
                "Seen",
                "hearing",
                "receivers",
            ),
            ".run_pieces": (
                "FIRST_PIECE_NS",
                "PieceLength",
            ),
            ".processor": (
                "CORE_APPS",
                "Processor",
                "make_ros2",
            ),
            ".python_code": (
                "find_code",
                "find_declarations",
                "find_node",
            ),
            ".record": (
                "DataRace",
                "Overwrite",
                "Reset",
                "StackUse",
                "Traffic",
            ),
            ".settings": ("with_settings",),
            ".spec": (
                "UNIX_AT_CFE_EPOCH",
                "BuiltProgram",
                "MissionSpec",
                "SweepConfig",
            ),
            ".topic_watch": (
                "TopicMessage",
                "TopicWatch",
                "matches",
            ),
            ".tracebacks": (
                "app_traceback",
                "described",
                "reason",
            ),
        },
    )
