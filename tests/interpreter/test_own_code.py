"""Whether a file belongs to cfepy or to a mission."""

from __future__ import annotations

import os
import sysconfig
from pathlib import Path

import pytest

from cfepy.interpreter import own_code
from cfepy.interpreter.own_code import is_library, is_own_code, is_shown, is_standard, source_file

PACKAGE = Path(own_code.PACKAGE)
LIBRARIES = PACKAGE.parent / "ros_libraries"


@pytest.mark.parametrize(
    ("file", "shown", "own"),
    [
        (PACKAGE / "rtos" / "kernel.py", False, False),
        ("cfepy/rtos/kernel.py", False, False),  # as a compiled module names its source
        (PACKAGE.parent / "rospy_shim" / "runtime.py", False, False),
        (PACKAGE.parent / "rclpy_shim" / "seam" / "waiting.py", False, False),
        (PACKAGE.parent / "rclpy_shim" / "libraries" / "rclpy" / "executors.py", False, False),
        (PACKAGE.parent / "rclpy_shim" / "libraries" / "tf2_ros" / "buffer.py", True, False),
        ("<string>", False, False),
        (LIBRARIES / "tf2_ros" / "__init__.py", True, False),
        (os.__file__, True, False),
        (Path(sysconfig.get_paths()["purelib"]) / "numpy" / "__init__.py", True, False),
        ("/home/me/mission/arm.py", True, True),
        ("/home/me/cfepy/arm.py", True, True),
    ],
)
def test_files_are_classified_as_shown_and_as_own_code(file: Path | str, shown: bool, own: bool) -> None:
    assert (is_shown(str(file)), is_own_code(str(file))) == (shown, own)
    assert is_library(str(file)) == (shown and not own)


def test_standard_library_is_distinguished_from_installed_packages() -> None:
    assert is_standard(os.__file__)
    assert not is_standard(str(Path(sysconfig.get_paths()["purelib"]) / "numpy" / "__init__.py"))


def test_names_of_compiled_modules_become_full_paths() -> None:
    assert source_file("cfepy/rtos/kernel.py") == str(PACKAGE / "rtos" / "kernel.py")
    for other in ("/home/me/arm.py", "arm.py", "<string>", str(PACKAGE / "trace.py")):
        assert source_file(other) == other
