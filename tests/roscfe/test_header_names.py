"""A node sees the names behind an #include that it sees with Debian's ROS, such as INT_MAX behind ros/ros.h."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.building import needs_cpp
from dev.roscfe.header_names import HEADERS, REASONS, lacking, listed, our_folders, seen


def test_list_has_all_headers() -> None:
    assert list(listed()) == HEADERS
    assert min(len(names) for names in listed().values()) > 50
    assert {name for names in listed().values() for name in names} >= set(REASONS)


@needs_cpp
@pytest.mark.slow
@pytest.mark.parametrize("header", HEADERS)
def test_header_brings_along_the_names_that_it_does_in_ros(header: str, tmp_path: Path) -> None:
    assert lacking(header, listed()[header], our_folders([header], tmp_path)) == []


@needs_cpp
@pytest.mark.slow
def test_name_that_a_header_does_not_give_is_not_seen(tmp_path: Path) -> None:
    found = seen("ros/time.h", our_folders(["ros/time.h"], tmp_path))
    assert "ros::Time" in found
    assert "ros::NodeHandle" not in found
