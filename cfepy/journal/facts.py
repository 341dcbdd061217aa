"""What a mission can find out about the computer and the user: versions, environment, operating system.

May import cfepy.mission.
"""

from __future__ import annotations

import os
import platform
import re
import sys

import cfepy
from cfepy.mission.launch import KEPT_ENVIRONMENT
from cfepy.mission.spec import MissionSpec
from cfepy.versions import CFE_VERSION

_SECRET = re.compile(r"TOKEN|SECRET|PASSW|PASSPHRASE|CREDENTIAL|API_?KEY|PRIVATE|AUTH|COOKIE|SESSION", re.IGNORECASE)


def versions() -> dict[str, str]:
    """Of cfepy, cFE and Python."""
    return {"cfepy": cfepy.__version__, "cfe": CFE_VERSION, "python": platform.python_version()}


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
