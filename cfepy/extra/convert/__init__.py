"""ROS nodes in C++ as cFE applications: the convertor, `cfepy convert`.

A node's source is compiled as it is, against the interface library in roscfe. Code that reads C++ packages
(`packages`), generates the other parts of a node, and calls the compiler belongs here. Generated parts are the headers
of its messages (`message_headers`), its entry point and its parameters. Running the built node does not belong here: to
a mission a shared object is a compiled application like any other. The central file is
`cfepy/extra/convert/conversion.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.convert.capacities import wrong_capacities
    from cfepy.extra.convert.cmake_answers import CMakeAnswers
    from cfepy.extra.convert.conversion import converted, task_of
    from cfepy.extra.convert.cpp_package import Program
    from cfepy.extra.convert.flight_build import build_for_flight
    from cfepy.extra.convert.message_headers import Profile
    from cfepy.extra.convert.node_check import RULES, CheckReport, Level, check_program, programs_of, sarif_of
    from cfepy.extra.convert.output import write_files
    from cfepy.extra.convert.project import project_files, report

__all__ = [
    "RULES",
    "CMakeAnswers",
    "CheckReport",
    "Level",
    "Profile",
    "Program",
    "build_for_flight",
    "check_program",
    "converted",
    "programs_of",
    "project_files",
    "report",
    "sarif_of",
    "task_of",
    "write_files",
    "wrong_capacities",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".capacities": ("wrong_capacities",),
            ".node_check": ("RULES", "CheckReport", "Level", "check_program", "programs_of", "sarif_of"),
            ".cmake_answers": ("CMakeAnswers",),
            ".conversion": ("converted", "task_of"),
            ".flight_build": ("build_for_flight",),
            ".message_headers": ("Profile",),
            ".output": ("write_files",),
            ".cpp_package": ("Program",),
            ".project": ("project_files", "report"),
        },
    )
