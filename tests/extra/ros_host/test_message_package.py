"""`cfepy export ros`: a package from which ROS's own generator makes the types of telemetry on connections."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest

from cfepy.cli.main import main
from cfepy.ground import dictionary_of
from cfepy.ground.shown_packets import type_of
from cfepy.mission import read_mission
from cfepy.msg import Telemetry

PYTHON, GENERATOR = "/usr/bin/python3", Path("/usr/lib/genpy/genmsg_py.py")  # Debian's python3-genpy
HEADER = "uint32 seq\ntime stamp\nstring frame_id\n"
ASK = """
import json, cfe_tlm.msg
print(json.dumps({name: each._md5sum for name, each in vars(cfe_tlm.msg).items() if hasattr(each, "_md5sum")}))
"""


def types_of(mission: str) -> dict[str, str]:
    """Return the md5sums of a mission's telemetry outside, by the types' names."""
    entries = dictionary_of(read_mission(mission)).telemetry.values()
    shown = [type_of(each.name, each.payload) for each in entries if isinstance(each, Telemetry) and each.payload.size]
    return {each.name: each.md5sum for each in shown}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    folder = tmp_path / "cfe_tlm"
    assert main(["export", "ros", "lab", "-o", str(folder)]) == 0
    return folder


def test_each_packet_has_a_type_and_is_built(capsys: pytest.CaptureFixture[str], package: Path) -> None:
    names = {path.stem for path in (package / "msg").iterdir()}
    wanted = {name.removeprefix("cfe_tlm/") for name in types_of("lab")}
    assert "CFE_ES_HK_TLM" in wanted <= names
    build = (package / "CMakeLists.txt").read_text(encoding="utf-8")
    assert {line.strip() for line in build.splitlines() if line.endswith(".msg")} == {f"{name}.msg" for name in names}
    manifest = ElementTree.parse(package / "package.xml").getroot()
    assert [each.text for each in manifest.findall("name")] == ["cfe_tlm"]
    assert f"{len(names)} message types of {len(wanted)} packets" in capsys.readouterr().out


def test_folder_that_cannot_be_created_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "taken").write_text("", encoding="utf-8")
    assert main(["export", "ros", "lab", "-o", str(tmp_path / "taken")]) == 2
    assert "--output: cannot be written" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.skipif(not GENERATOR.exists(), reason="Debian's python3-genpy is not installed")
def test_ros_generates_the_same_types_from_the_package(package: Path, tmp_path: Path) -> None:
    includes = tmp_path / "std_msgs"
    includes.mkdir()
    (includes / "Header.msg").write_text(HEADER, encoding="utf-8")
    made = tmp_path / "python" / "cfe_tlm" / "msg"
    options = ["-p", "cfe_tlm", "-o", str(made), f"-Icfe_tlm:{package / 'msg'}", f"-Istd_msgs:{includes}"]
    files = sorted((package / "msg").iterdir())
    for path in files:
        subprocess.run([PYTHON, str(GENERATOR), *options, str(path)], check=True, capture_output=True)
    subprocess.run([PYTHON, str(GENERATOR), *options, "--initpy"], check=True, capture_output=True)
    (made.parent / "__init__.py").write_text("", encoding="utf-8")
    done = subprocess.run(
        [PYTHON, "-c", ASK], env={"PYTHONPATH": str(made.parents[1])}, check=True, capture_output=True, text=True
    )
    found = json.loads(done.stdout)
    assert set(found) == {path.stem for path in files}
    assert {name: found[name.removeprefix("cfe_tlm/")] for name in types_of("lab")} == types_of("lab")
