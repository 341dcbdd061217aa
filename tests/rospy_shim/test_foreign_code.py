"""Sources of foreign code for a node: PYTHONPATH, packages on ROS_PACKAGE_PATH, stand-ins for missing packages."""

from __future__ import annotations

from pathlib import Path

from rospy_shim.types.config import NodeConfig
from tests.rospy_shim.missions import run_nodes

SETUP = """from distutils.core import setup
from catkin_pkg.python_setup import generate_distutils_setup
setup(**generate_distutils_setup(packages=['arm'], package_dir={'': 'python'}))
"""


def printed(folder: Path, script: str, **env: str) -> list[str]:
    """Return one node's output."""
    (folder / "mission").mkdir()
    config = NodeConfig("NODE", env=env)
    return run_nodes(folder / "mission", {"NODE": script}, nodes={"NODE": config}).printed["NODE"]


def test_folders_of_pythonpath_follow_the_folder_of_the_script(tmp_path: Path) -> None:
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "helper.py").write_text("import time\nwhere, now = 'one', time.time()", encoding="utf-8")
    script = "import helper, sys, time\nprint(helper.where, helper.now > 0, sys.path[1])"
    path = str(tmp_path / "one")
    assert printed(tmp_path, script, PYTHONPATH=path) == [f"one True {path}"]


def test_package_code_is_found_in_the_folder_of_its_setup(tmp_path: Path) -> None:
    package = tmp_path / "ws" / "arm"
    (package / "python" / "arm").mkdir(parents=True)
    (package / "python" / "arm" / "__init__.py").write_text("JOINTS = 6", encoding="utf-8")
    (package / "package.xml").write_text("<package><name>arm</name></package>", encoding="utf-8")
    (package / "setup.py").write_text(SETUP, encoding="utf-8")
    script = "from arm import JOINTS\nprint(JOINTS)"
    assert printed(tmp_path, script, ROS_PACKAGE_PATH=str(tmp_path / "ws")) == ["6"]


def test_stand_ins_are_used_when_no_package_is_found(tmp_path: Path) -> None:
    script = """
        from Cryptodome.Cipher import AES
        from Cryptodome.Random import get_random_bytes
        import gnupg
        print(len(get_random_bytes(4)))
        for use in (lambda: AES.new(b"key", AES.MODE_CBC), gnupg.GPG):
            try:
                use()
            except ImportError as error:
                print(error)
    """
    assert printed(tmp_path, script) == [
        "4",
        "encrypted bags need PyCryptodomex: pip install pycryptodomex",
        "encrypted bags need python-gnupg: pip install python-gnupg",
    ]


def test_module_of_the_node_is_preferred_to_a_stand_in(tmp_path: Path) -> None:
    (tmp_path / "own").mkdir()
    (tmp_path / "own" / "gnupg.py").write_text("GPG = 'mine'", encoding="utf-8")
    assert printed(tmp_path, "import gnupg\nprint(gnupg.GPG)", PYTHONPATH=str(tmp_path / "own")) == ["mine"]


def test_catkin_finds_files_of_packages(tmp_path: Path) -> None:
    package = tmp_path / "ws" / "arm"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>arm</name></package>", encoding="utf-8")
    script = """
        from catkin.find_in_workspaces import find_in_workspaces
        looked = []
        found = find_in_workspaces(["share"], project="arm", path="package.xml", considered_paths=looked)
        print(found == looked, found[0].rpartition("/ws/")[2])
        print(find_in_workspaces(project="none"), find_in_workspaces(project="arm", path="none"), find_in_workspaces())
    """
    assert printed(tmp_path, script, ROS_PACKAGE_PATH=str(tmp_path / "ws")) == ["True arm/package.xml", "[] [] []"]


def test_compiler_warnings_are_in_the_output_of_the_node(tmp_path: Path) -> None:
    source = 'kind = "a"\nif kind is not "b":\n    print("runs")\n'
    for folder in ("once", "again"):
        (tmp_path / folder).mkdir()
        lines = run_nodes(tmp_path / folder, {"DOUBTED": source}).printed["DOUBTED"]
        assert 'doubted.py:2: SyntaxWarning: "is not" with' in lines[0]
        assert lines[1:] == ['  if kind is not "b":', "runs"]
