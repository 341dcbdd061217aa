"""Compile each of OSAL's tests into a shared object, with ut_assert and a driver in place of its main program."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

from cfepy.config.platform import PlatformConfig
from cfepy.extra.c.engine import compiler

DRIVER = Path(__file__).with_name("driver.c")
FLAGS = ("-shared", "-fPIC", "-g", "-O1", "-w", "-fno-builtin", "-D_LINUX_OS_", "-D_POSIX_OS_")
ASSERT = ("utassert.c", "utlist.c", "uttest.c", "uttools.c")
SETS = ("src/tests", "src/unit-tests")
LOADER_TEST = "osloader-test"
MODULE_SOURCE = "ut_module.c"
OBJECT = "osaltest.so"
"""The name of a test's shared object: names of tests are longer than OSAL lets a file's be."""
MODULES_MORE = 1
"""So many modules more than OSAL can load."""


class Builder:
    """Compiles tests.

    Args:
        sources: OSAL's sources, as in its repository.
        target: where shared objects and headers go.
    """

    def __init__(self, sources: Path, target: Path) -> None:
        self.sources = sources
        self.target = target
        self._values = self._settings()
        self._write_osconfig()

    def tests(self) -> list[Path]:
        """Return the folders of all tests."""
        return sorted(
            folder for each in SETS for folder in (self.sources / each).iterdir() if folder.name.endswith("-test")
        )

    def build(self, test: Path, folder: Path) -> Path:
        """Compile a test into a folder. Returns the shared object."""
        files = [each for each in sorted(test.glob("*.c")) if each.name != MODULE_SOURCE]
        files += [self.sources / "ut_assert" / "src" / name for name in ASSERT]
        made = folder / OBJECT
        self._compile(made, *files, DRIVER, includes=(test,))
        if test.name == LOADER_TEST:
            self._build_modules(test, folder)
        return made

    def _build_modules(self, test: Path, folder: Path) -> None:
        (folder / "utmod").mkdir()
        for number in range(int(self._values["OSAL_CONFIG_MAX_MODULES"]) + MODULES_MORE):
            made = folder / "utmod" / f"MODULE{number}.so"
            self._compile(made, test / MODULE_SOURCE, flags=(f"-DMODULE_NAME=module{number}",))

    def _compile(self, made: Path, *files: Path, includes: tuple[Path, ...] = (), flags: tuple[str, ...] = ()) -> None:
        folders = (
            *includes,
            self.target,
            self.sources / "src" / "os" / "inc",
            self.sources / "ut_assert" / "inc",
            self.sources / "ut_assert" / "src",
            self.sources / "src" / "unit-tests" / "inc",
        )
        command = [*compiler(), *FLAGS, *flags, *(f"-I{folder}" for folder in folders), *map(str, files)]
        done = subprocess.run([*command, "-o", str(made)], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"{made} cannot be compiled:\n{done.stderr}")

    def _settings(self) -> dict[str, str]:
        """Return OSAL's default build settings, with cfepy's limits."""
        text = (self.sources / "default_config.cmake").read_text(encoding="utf-8")
        values = dict(re.findall(r'^\s*set\((\w+)\s+"?([^\s")]*)"?', text, re.M))
        config = PlatformConfig()
        values.update(
            OSAL_CONFIG_MAX_TASKS=str(config.os_max_tasks),
            OSAL_CONFIG_MAX_QUEUES=str(config.os_max_queues),
            OSAL_CONFIG_MAX_COUNT_SEMAPHORES=str(config.os_max_count_semaphores),
            OSAL_CONFIG_MAX_BIN_SEMAPHORES=str(config.os_max_bin_semaphores),
            OSAL_CONFIG_MAX_MUTEXES=str(config.os_max_mutexes),
            OSAL_CONFIG_MAX_TIMERS=str(config.os_max_timers),
            OSAL_CONFIG_MAX_TIMEBASES=str(config.os_max_timebases),
            OSAL_CONFIG_QUEUE_MAX_DEPTH=str(config.os_queue_max_depth),
            OSAL_CONFIG_DEBUG_PERMISSIVE_MODE="TRUE",
            CMAKE_SHARED_LIBRARY_SUFFIX=".so",
        )
        return values

    def _write_osconfig(self) -> None:
        """Write osconfig.h from osconfig.h.in, as CMake does."""
        text = (self.sources / "osconfig.h.in").read_text(encoding="utf-8")
        values = self._values
        text = re.sub(
            r"#cmakedefine (\w+)",
            lambda found: f"#define {found[1]}" if values.get(found[1]) == "TRUE" else f"/* {found[1]} */",
            text,
        )
        text = re.sub(r"@(\w+)@", lambda found: values.get(found[1], ""), text)
        self.target.mkdir(parents=True, exist_ok=True)
        (self.target / "osconfig.h").write_text(text, encoding="utf-8")
