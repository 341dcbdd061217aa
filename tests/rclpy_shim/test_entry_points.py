"""Nodes of ament_python packages, started by their names in setup.py."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.cli.main import main

pytestmark = pytest.mark.slow
FILES = {
    "demo/package.xml": "<package format='3'><name>demo</name><version>1.0.0</version><description/>"
    "<maintainer email='a@b.c'>a</maintainer><license>MIT</license><exec_depend>rclpy</exec_depend></package>",
    "demo/setup.py": "from setuptools import setup\n"
    "setup(entry_points={'console_scripts': ['talker = demo.nodes.talker:main']})\n",
    "demo/demo/__init__.py": "",
    "demo/demo/nodes/__init__.py": "",
    "demo/demo/nodes/talker.py": "import sys\nimport rclpy\nfrom demo.names import NAME\n"
    "def main():\n    rclpy.init()\n    node = rclpy.create_node(NAME)\n"
    "    print(node.get_name(), sys.argv[0].rpartition('/')[2], sys.argv[1:2], __name__)\n    return 3\n",
    "demo/demo/names.py": "NAME = 'named'\n",
    "startup.scr": "CFE_APP, demo/setup.py, __main__, TALKER, 100, 65536, 0x0, 0;\n!\n",
    "mission.yaml": "nodes:\n  TALKER: {executable: talker, name: other}\n",
}


@pytest.fixture
def packages(tmp_path: Path) -> Path:
    """A folder with an ament_python package, and a mission that runs its node."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def test_node_command_runs_an_entry_point(
    packages: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(packages))
    monkeypatch.chdir(packages)
    assert main(["node", "demo", "talker", "--ros-args", "-r", "__ns:=/x"]) == 3
    assert capsys.readouterr().out == "named talker ['--ros-args'] demo.nodes.talker\n"


def test_mission_file_names_an_entry_point(packages: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["run", str(packages), "--for", "2"])
    assert "[other] other talker ['--ros-args'] demo.nodes.talker" in capsys.readouterr().out


def test_mission_names_a_wrong_entry_point(packages: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (packages / "mission.yaml").write_text("nodes:\n  TALKER: {executable: taker}\n", encoding="utf-8")
    main(["run", str(packages), "--for", "2"])
    shown = capsys.readouterr()
    assert "unknown executable 'taker' of the package; did you mean talker?" in shown.out + shown.err
