"""Installed distributions as a node sees them: rospy and its libraries with their versions, and the host's packages."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rospy_shim.missions import run_nodes


def test_importlib_metadata(tmp_path: Path) -> None:
    script = """
        import importlib.metadata
        from importlib import metadata
        print(metadata.version("rospy"), importlib.metadata.version("tf2_ros"), metadata.metadata("genpy")["Name"])
        print(sorted(each.metadata["Name"] for each in metadata.distributions()).count("rospy"))
        print(metadata.version("pytest") > "7")
        try:
            metadata.version("no_such_thing")
        except metadata.PackageNotFoundError as error:
            print(error)
    """
    lines = run_nodes(tmp_path, {"N": script}).printed["N"]
    assert lines == ["1.16.0 0.7.7 genpy", "1", "True", "No package metadata was found for no_such_thing"]


def test_pkg_resources(tmp_path: Path) -> None:
    pytest.importorskip("pkg_resources", reason="setuptools is not installed, or is one without it")
    script = """
        import pkg_resources
        print(pkg_resources.get_distribution("rospy").version, pkg_resources.get_distribution("pytest").key)
        print([each.project_name for each in pkg_resources.require("rospy>=1.11", "pytest")][0])
    """
    assert run_nodes(tmp_path, {"N": script}).printed["N"] == ["1.16.0 pytest", "rospy"]
