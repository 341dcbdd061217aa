"""What a mission can find out about the computer and the user: versions, environment, operating system."""

from __future__ import annotations

import os
import platform
import re
import sys
from functools import cache
from hashlib import blake2b
from pathlib import Path

from cfepy import __version__
from cfepy.config.versions import RELEASES
from cfepy.mission import KEPT_ENVIRONMENT, MissionSpec
from cfepy.reading.resources import shipped

_SECRET = re.compile(r"TOKEN|SECRET|PASSW|PASSPHRASE|CREDENTIAL|API_?KEY|PRIVATE|AUTH|COOKIE|SESSION", re.IGNORECASE)


def versions() -> dict[str, str]:
    """Of cfepy, cFE and Python; `source` stands for cfepy's own files, which may change between two versions."""
    python = platform.python_version()
    return {"cfepy": __version__, "cfe": ", ".join(RELEASES), "python": python, "source": _source()}


def own_places() -> tuple[str, ...]:
    """The folders of cfepy's own files, shipped applications and boards among them."""
    package = Path(__file__).resolve().parents[1]
    beside = (package.parent / each for each in ("rospy_shim", "ros_libraries"))
    return tuple(map(str, (package, *beside, shipped("apps"), shipped("boards"))))


@cache
def _source() -> str:
    """A digest of names and sizes of cfepy's own files, made once a process; to read them all would take too long."""
    whole = blake2b(digest_size=8)
    for place in own_places():
        for folder, folders, names in os.walk(place):
            folders[:] = sorted(name for name in folders if name not in ("__pycache__", "share"))
            for name in sorted(names):
                path = os.path.join(folder, name)
                whole.update(f"{path.removeprefix(place)} {os.stat(path).st_size}\n".encode())
    return whole.hexdigest()


def host_facts() -> dict[str, str]:
    """Of the computer: what `os.uname` and `sys` tell a node."""
    return {
        "system": platform.system(),
        "release": platform.release(),
        "machine": platform.machine(),
        "implementation": sys.implementation.name,
    }


def environ_of(spec: MissionSpec) -> dict[str, str]:
    """The variables that a mission can see, but for those whose names sound like a secret.

    A mission with a startup script sees few; a launch file or a single node sees all.
    """
    sees_all = spec.startup is not None and spec.mission_file is None
    names = sorted(os.environ) if sees_all else KEPT_ENVIRONMENT
    return {name: os.environ[name] for name in names if name in os.environ and not _SECRET.search(name)}
