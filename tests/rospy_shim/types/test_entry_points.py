"""Entry points in setup.py and setup.cfg, read without executing the files."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.status import UsageError
from rospy_shim.types.entry_points import entry_of, entry_points

SETUP = """
from setuptools import setup
package_name = 'demo'
raise RuntimeError('executed')
setup(
    entry_points={
        'console_scripts': [
            'talker = demo.talker:main',
            f'listener = {package_name}.listener:main',
            'third = ' + package_name + '.third:run',
            'wrong = demo',
        ],
    },
)
"""


def test_setup_py_names_nodes(tmp_path: Path) -> None:
    (tmp_path / "setup.py").write_text(SETUP, encoding="utf-8")
    assert entry_points(tmp_path) == {
        "talker": ("demo.talker", "main"),
        "listener": ("demo.listener", "main"),
        "third": ("demo.third", "run"),
    }


def test_setup_cfg_names_nodes(tmp_path: Path) -> None:
    text = "[options.entry_points]\nconsole_scripts =\n    talker = demo.talker:main\n    other=demo:run\n"
    (tmp_path / "setup.cfg").write_text(text, encoding="utf-8")
    assert entry_points(tmp_path) == {"talker": ("demo.talker", "main"), "other": ("demo", "run")}


@pytest.mark.parametrize("text", ["", "def", "setup(entry_points={'console_scripts': names})", "\0"])
def test_files_without_names_have_no_nodes(tmp_path: Path, text: str) -> None:
    (tmp_path / "setup.py").write_text(text, encoding="utf-8")
    (tmp_path / "setup.cfg").write_text(f"[x\n{text}", encoding="utf-8")
    assert entry_points(tmp_path) == {}


def test_unknown_executable_is_refused_with_the_nearest_name(tmp_path: Path) -> None:
    (tmp_path / "setup.py").write_text(SETUP, encoding="utf-8")
    with pytest.raises(UsageError, match=r"unknown executable 'taker' of the package; did you mean talker\?"):
        entry_of(tmp_path / "setup.py", "taker")
