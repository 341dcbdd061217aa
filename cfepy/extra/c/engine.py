"""The engine: finds the C extension `cfepy.extra.c._engine`, or builds it when it is used for the first time.

A wheel may have it beside this file. Otherwise it is compiled into the user's cache folder, once for each version of
its sources and of Python. That needs a C compiler and Python's headers.
"""

from __future__ import annotations

import hashlib
import importlib.machinery
import importlib.util
import os
import platform
import subprocess
import sys
import sysconfig
import tempfile
from functools import cache
from pathlib import Path
from types import ModuleType

from cfepy.extra.c.build_cache import cache_folder, writing_cache
from cfepy.interpreter.host_system import is_absent
from cfepy.status import UsageError

SOURCES = Path(__file__).with_name("engine")
GDB_SYMBOLS = Path(__file__).with_name("symbols.gdb")
"""The script that gives gdb the symbols of objects as they are loaded."""
MACHINES = ("x86_64", "aarch64")
FLAGS = ("-O2", "-fPIC", "-shared", "-fvisibility=hidden", "-fno-strict-aliasing", "-pthread", "-std=gnu11")


@cache
def engine() -> ModuleType:
    """Return the engine, and build it first if necessary.

    Raises:
        UsageError: this computer cannot have it; the text names the missing part.
    """
    if sys.platform != "linux" or platform.machine() not in MACHINES:
        here = f"{sys.platform} on {platform.machine()}"
        raise UsageError(f"compiled applications require Linux on {' or '.join(MACHINES)}; this is {here}")
    name = "cfepy.extra.c._engine"
    beside = importlib.util.find_spec(name)
    path = Path(beside.origin) if beside is not None and beside.origin else built()
    loader = importlib.machinery.ExtensionFileLoader(name, str(path))
    spec = importlib.util.spec_from_file_location(name, path, loader=loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def built(folder: Path | None = None) -> Path:
    """Return the file of the extension in the cache, or in another folder, and compile it if it does not exist.

    Raises:
        UsageError: there is no compiler, or it failed.
    """
    sources = sorted([*SOURCES.glob("*.c"), SOURCES / f"switch_{platform.machine()}.S"])
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    digest = hashlib.sha256(repr((FLAGS, suffix)).encode())
    for source in [*sources, *sorted(SOURCES.glob("*.h"))]:
        digest.update(source.read_bytes())
    where = folder or cache_folder()
    target = where / (f"_engine{suffix}" if folder else f"_engine-{digest.hexdigest()[:16]}{suffix}")
    if folder or not target.exists():
        with writing_cache(where):
            where.mkdir(parents=True, exist_ok=True)
            _compile(sources, target)
    return target


def compiler() -> list[str]:
    """Return the command of the C compiler: CC in the environment, or the one that Python was built with."""
    return (os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc").split()


def _compile(sources: list[Path], target: Path) -> None:
    """Compile to a temporary file beside the target first, because two processes may do it at the same time."""
    command = compiler()
    include = f"-I{sysconfig.get_paths()['include']}"
    with tempfile.TemporaryDirectory(dir=target.parent) as folder:
        made = Path(folder) / target.name
        try:
            subprocess.run(
                [*command, *FLAGS, include, *map(str, sources), "-o", str(made), "-lm"],
                check=True,
                capture_output=True,
                text=True,
            )
        except OSError as error:
            if not is_absent(command[0], error):
                raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from None
            raise UsageError(
                f"compiled applications require a C compiler once, and {command[0]} is not installed; install "
                "one (on Debian `apt-get install gcc python3-dev`), or set CC to another compiler"
            ) from None
        except subprocess.CalledProcessError as error:
            hint = " (on Debian, Python's headers are in python3-dev)" if "Python.h" in error.stderr else ""
            raise UsageError(f"the engine for compiled applications cannot be built{hint}:\n{error.stderr}") from None
        os.replace(made, target)
