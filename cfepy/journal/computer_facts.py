"""Facts about the computer and the user that a mission can see: versions, environment, operating system."""

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
from cfepy.interpreter.own_code import BESIDE
from cfepy.mission import KEPT_ENVIRONMENT, MissionSpec
from cfepy.reading.resources import shipped

_SECRET = re.compile(r"TOKEN|SECRET|PASSW|PASSPHRASE|CREDENTIAL|API_?KEY|PRIVATE|AUTH|COOKIE|SESSION", re.IGNORECASE)


def versions() -> dict[str, str]:
    """Return the versions of cfepy, cFE and Python; `source` identifies cfepy's own files, which may differ for one
    version.
    """
    python = platform.python_version()
    return {"cfepy": __version__, "cfe": ", ".join(RELEASES), "python": python, "source": _source()}


def own_places() -> tuple[str, ...]:
    """Return the folders of cfepy's own files, including its applications and boards."""
    package = Path(__file__).resolve().parents[1]
    beside = (package.parent / each for each in BESIDE)
    return tuple(map(str, (package, *beside, shipped("apps"), shipped("boards"))))


@cache
def _source() -> str:
    """Return a digest of names and sizes of cfepy's own files, computed once per process; reading them would take too
    long.
    """
    whole = blake2b(digest_size=8)
    for place in own_places():
        for folder, folders, names in os.walk(place):
            folders[:] = sorted(name for name in folders if name not in ("__pycache__", "share"))
            for name in sorted(names):
                path = os.path.join(folder, name)
                whole.update(f"{path.removeprefix(place)} {os.stat(path).st_size}\n".encode())
    return whole.hexdigest()


def host_facts() -> dict[str, str]:
    """Return the facts about the computer that `os.uname` and `sys` give a node."""
    return {
        "system": platform.system(),
        "release": platform.release(),
        "machine": platform.machine(),
        "implementation": sys.implementation.name,
    }


def environ_of(spec: MissionSpec) -> dict[str, str]:
    """Return the environment variables that a mission can see, without variables whose names suggest a secret.

    A mission with a startup script sees a few variables. A launch file or a single node sees all.
    """
    sees_all = spec.startup is not None and spec.mission_file is None
    names = sorted(os.environ) if sees_all else KEPT_ENVIRONMENT
    return {name: os.environ[name] for name in names if name in os.environ and not _SECRET.search(name)}
