"""Files of test results, and the runner that writes them (rosunit.core)."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Mapping
from typing import Any

from rosunit.xmlrunner import XMLTestRunner

XML_OUTPUT_FLAG = "--gtest_output=xml:"  # as gtest's own programs have it
_NOT_IN_FILE_NAMES = re.compile(r"""[ "'&$!`/\\]""")


def printlog(msg: str, *args: Any) -> None:
    """Tell something on standard output."""
    print(f"[ROSUNIT]{msg % args if args else msg}")


printlog_bold = printlog


def printerrlog(msg: str, *args: Any) -> None:
    """Tell something on standard error."""
    print(f"[ROSUNIT]{msg % args if args else msg}", file=sys.stderr)


def makedirs_with_parent_perms(p: str) -> None:
    """Make a folder and those above it."""
    os.makedirs(p, exist_ok=True)


def xml_results_file(
    test_pkg: str, test_name: str, is_rostest: bool = False, env: Mapping[str, str] | None = None
) -> str:
    """Return the file for the results of a test, and create its folder.

    Args:
        test_pkg: package of the test.
        test_name: its name.
        is_rostest: the results are rostest's own.
        env: environment to use instead of the node's.

    Raises:
        IOError: the folder cannot be made.
    """
    import rospkg

    folder = os.path.join(rospkg.get_test_results_dir(env=env), test_pkg)
    try:
        makedirs_with_parent_perms(folder)
    except OSError as error:
        raise OSError(f"cannot create test results directory [{folder}]: {error}") from error
    kind = "rostest" if is_rostest else "rosunit"
    return os.path.join(folder, f"{kind}-{_NOT_IN_FILE_NAMES.sub('_', test_name)}.xml")


def rostest_name_from_path(pkg_dir: str, test_file: str) -> str:
    """Return the name of a test file's results: its path in the package, with "_" for "/" and without its ending."""
    path = os.path.abspath(test_file)
    if path.startswith(pkg_dir):
        test_file = path[len(pkg_dir) :].lstrip(os.sep)
    return os.path.splitext(test_file.replace(os.sep, "_"))[0]


def create_xml_runner(
    test_pkg: str, test_name: str, results_file: str | None = None, is_rostest: bool = False
) -> XMLTestRunner:
    """Return a runner that writes its results to a file.

    Args:
        test_pkg: package of the test.
        test_name: its name.
        results_file: path of the file; None takes `xml_results_file`.
        is_rostest: the results are rostest's own.

    Raises:
        IOError: the file cannot be written.
    """
    file = os.path.abspath(results_file or xml_results_file(test_pkg, test_name, is_rostest))
    try:
        makedirs_with_parent_perms(os.path.dirname(file))
        stream = open(file, "w", encoding="utf-8")  # noqa: SIM115  # the runner closes it with the process
    except OSError as error:
        raise OSError(f"cannot create test results file [{file}]: {error}") from error
    stream.write('<?xml version="1.0" encoding="utf-8"?>\n')
    return XMLTestRunner(stream)
