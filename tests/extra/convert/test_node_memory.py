"""Memory of a node in C++ from new and malloc, in each profile: aligned on request, null where allowed."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]

MANIFEST = """<package format="2"><name>taker</name><version>1.0.0</version><description>taker</description>
<maintainer email="a@b.c">a</maintainer><license>Apache-2.0</license><depend>roscpp</depend></package>
"""
NODE = """
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <new>

#include <ros/ros.h>

struct alignas(128) Wide
{
  char bytes[128];
};

static bool is_aligned(const void *at, std::size_t alignment)
{
  return at != nullptr && reinterpret_cast<std::uintptr_t>(at) % alignment == 0;
}

int main(int argc, char **argv)
{
  ros::init(argc, argv, "taker");
  ros::NodeHandle own("~");
  Wide *one = new Wide, *more = new Wide[3], *offered = new (std::nothrow) Wide;
  ROS_INFO("wide %d", is_aligned(one, 128) && is_aligned(more, 128) && is_aligned(offered, 128));
  delete one;
  delete[] more;
  delete offered;
  void *block = std::realloc(std::malloc(100), 5000);
  std::free(block);
  block = std::aligned_alloc(512, 1024);
  ROS_INFO("aligned_alloc %d", is_aligned(block, 512));
  std::free(block);
  const int status = posix_memalign(&block, 256, 100);
  ROS_INFO("posix_memalign %d", status == 0 && is_aligned(block, 256));
  std::free(block);
  char *text = strdup("a text");
  ROS_INFO("%s", text);
  std::free(text);
  volatile std::size_t size = SIZE_MAX / 2 + 8;
  ROS_INFO("none %d", ::operator new(size, std::nothrow) == nullptr && std::malloc(size) == nullptr);
  if (own.param("negative", false))
  {
    size = SIZE_MAX;
    double *numbers = new double[static_cast<long>(size)];
    ROS_INFO("got %p", static_cast<void *>(numbers));
  }
  ros::spinOnce();
  ROS_INFO("late %d", new (std::nothrow) char[50] != nullptr);
  return 0;
}
"""
LAUNCH = """<launch><node pkg="taker" type="taker" name="taker" output="screen">
<param name="negative" value="{negative}"/></node></launch>
"""
SAID = ["wide 1", "aligned_alloc 1", "posix_memalign 1", "a text", "none 1"]


def flown(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], profile: str, negative: bool
) -> tuple[int, list[str], str]:
    """Return the exit status of a launch of the node, its log, and the whole output."""
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    folder = tmp_path / "taker"
    folder.mkdir()
    (folder / "package.xml").write_text(MANIFEST, encoding="utf-8")
    (folder / "CMakeLists.txt").write_text("project(taker)\nadd_executable(taker taker.cpp)\n", encoding="utf-8")
    (folder / "taker.cpp").write_text(NODE, encoding="utf-8")
    (folder / "all.launch").write_text(LAUNCH.format(negative=str(negative).lower()), encoding="utf-8")
    status = main(["launch", str(folder / "all.launch"), "--for", "1", "--cpp-nodes", profile, "--console"])
    shown = capfd.readouterr().out
    said = [line.partition("]: ")[2] for line in shown.splitlines() if line.startswith("[/taker] [ INFO]")]
    return status, said, shown


@pytest.mark.parametrize(("profile", "late"), [("host", 1), ("pool", 1), ("strict", 0)])
def test_memory_is_aligned_or_null(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], profile: str, late: int
) -> None:
    status, said, _ = flown(tmp_path, monkeypatch, capfd, profile, negative=False)
    assert (status, said) == (0, [*SAID, f"late {late}"])


@pytest.mark.parametrize("profile", ["pool", "strict"])
def test_negative_count_ends_only_its_node(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], profile: str
) -> None:
    status, said, shown = flown(tmp_path, monkeypatch, capfd, profile, negative=True)
    assert (status, said) == (1, SAID)
    assert "TAKER: the arena has no room: a block is larger than any arena" in shown
    assert "processor was reset" not in shown
