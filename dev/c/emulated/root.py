"""Make the root folder of an emulated computer, without touching the packages of the host."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from zipfile import ZipFile

from dev.c.emulated.computer import PACKAGES

RELEASE, PYTHON = "bookworm", "3.11"
"""Of Debian, and the Python that it has."""
KEYS = "/usr/share/keyrings/debian-archive-keyring.gpg"
NEEDS = ("numpy", "msgpack", "pyyaml", "rich", "pyelftools", "greenlet", "pytest", "hypothesis")
PLATFORMS = ("manylinux2014_aarch64", "manylinux_2_24_aarch64", "manylinux_2_28_aarch64")
CONFIGURATION = """
Dir "{apt}";
Dir::State::status "{apt}/status";
APT::Architecture "arm64";
APT::Architectures {{ "arm64"; }};
APT::Install-Recommends "false";
APT::Sandbox::User "";
Acquire::Languages "none";
"""


def make_root(root: Path) -> None:
    """Fetch and unpack Debian's Python for arm64, and the packages that cfepy and its tests need.

    Args:
        root: the folder; it is created.

    Raises:
        subprocess.CalledProcessError: apt-get, dpkg-deb or pip failed; its output gives the reason.
    """
    apt = root / "apt"
    for each in ("etc/apt/preferences.d", "var/lib/apt/lists/partial", "var/cache/apt/archives/partial"):
        (apt / each).mkdir(parents=True, exist_ok=True)
    (apt / "status").touch()
    source = f"deb [arch=arm64 signed-by={KEYS}] http://deb.debian.org/debian {RELEASE} main\n"
    (apt / "etc/apt/sources.list").write_text(source, encoding="utf-8")
    configuration = apt / "apt.conf"
    configuration.write_text(CONFIGURATION.format(apt=apt.resolve()), encoding="utf-8")
    environment = {**os.environ, "APT_CONFIG": str(configuration)}
    subprocess.run(["apt-get", "update"], env=environment, check=True)
    wanted = (f"python{PYTHON}-dev", "libstdc++6")
    subprocess.run(["apt-get", "install", "--download-only", "-y", *wanted], env=environment, check=True)
    for package in sorted((apt / "var/cache/apt/archives").glob("*.deb")):
        subprocess.run(["dpkg-deb", "-x", str(package), str(root)], check=True)
    _add_packages(root)


def _add_packages(root: Path) -> None:
    wheels = root / "wheels"
    platforms = [f"--platform={each}" for each in PLATFORMS]
    options = ("--only-binary=:all:", f"--python-version={PYTHON}", *platforms, "--dest", str(wheels))
    subprocess.run([sys.executable, "-m", "pip", "download", *options, *NEEDS], check=True)
    for wheel in sorted(wheels.glob("*.whl")):
        with ZipFile(wheel) as archive:
            archive.extractall(root / PACKAGES)
