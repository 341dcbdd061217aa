"""tf2_geometry_msgs and tf2/utils.h in C++ give the same results as the real ones: recorded, or run if installed."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from cfepy.extra.convert.message_headers import Profile, write_headers
from rospy_shim.types.msgs import shipped
from tests.roscfe.compiling import BOOST, HEADERS, STRICT, compiled
from tests.roscfe.test_linear_math import answers, inputs

HERE = Path(__file__).parent
SOURCE = HERE / "geometry.cpp"
RECORDED = HERE / "geometry.txt"
REAL = Path("/usr/include/tf2_geometry_msgs"), Path("/usr/include/kdl"), Path("/usr/include/eigen3")
NAMES = "PoseWithCovariance", "Point", "Quaternion", "Vector3", "Wrench", "Transform", "Pose"
CASES = 1000
ON_RECORD = 4


def ours(folder: Path, *options: str) -> Path:
    messages = folder / "messages"
    write_headers([f"geometry_msgs/{name}Stamped" for name in NAMES], messages, Profile.HOST, shipped())
    sources = [SOURCE, HERE / "stubs.cpp"]
    return compiled(folder, sources, *options, "-O2", name="ours", headers=(messages, HEADERS, BOOST))


def words(line: str) -> list[str | float]:
    """Return the words of a line, with numbers to 12 digits, because libraries differ in the last digits of sines."""
    return [pytest.approx(float.fromhex(word), rel=1e-12, abs=1e-12) if "0x" in word else word for word in line.split()]


@pytest.mark.slow
@pytest.mark.parametrize("options", [STRICT, ["-Wall", "-Wextra", "-Werror"]])
def test_results_equal_the_recorded_ones(options: list[str], tmp_path: Path) -> None:
    found = answers(ours(tmp_path, *options), inputs(ON_RECORD))
    wanted = RECORDED.read_text(encoding="utf-8").splitlines()
    assert len(found) == len(wanted) == 46 * ON_RECORD
    for line, other in zip(found, wanted, strict=True):
        assert [float.fromhex(word) if "0x" in word else word for word in line.split()] == words(other)


@pytest.mark.slow
def test_results_equal_a_real_ros(tmp_path: Path) -> None:
    if not all(path.is_dir() for path in REAL):
        pytest.skip("there is no libtf2-geometry-msgs-dev on this computer; the record has to do")
    libraries = ["-ltf2", "-lrostime", "-lorocos-kdl", "-lboost_thread", "-lboost_system"]
    real = tmp_path / "real"
    command = ["g++", "-std=c++17", "-w", "-O2", "-I/usr/include/eigen3", str(SOURCE), *libraries, "-o", str(real)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    cases = inputs(CASES)
    assert answers(ours(tmp_path, *STRICT), cases) == answers(real, cases)


@pytest.mark.slow
def test_cloud_of_points_is_transformed(tmp_path: Path) -> None:
    messages = tmp_path / "messages"
    write_headers(["sensor_msgs/PointCloud2", "geometry_msgs/TransformStamped"], messages, Profile.HOST, shipped())
    sources = [HERE / "clouds.cpp", HERE / "stubs.cpp"]
    made = compiled(tmp_path, sources, *STRICT, name="clouds", headers=(messages, HEADERS, BOOST))
    said = subprocess.run([str(made)], capture_output=True, text=True, check=True).stdout
    assert said == "to 9.5000 1.0000 -2.0000 7.0 9.5000 2.0000 -2.0000 7.0\n"
