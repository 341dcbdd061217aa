"""Functions of cFE for C: each application has the same output here as on NASA's cFE."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.c.api import function_names
from dev.c.api.flights import MARK, NAMES, WITHOUT_DEPRECATED, expected, fly
from tests.extra.c.building import fly_c, needs_compiler

pytestmark = needs_compiler


@pytest.mark.parametrize("tasks", ["thread", pytest.param("greenlet", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", NAMES)
def test_application_prints_the_output_of_nasas_cfe(tmp_path: Path, name: str, tasks: str) -> None:
    assert fly(name, tmp_path, tasks) == expected(name)


def test_handles_of_tables_are_ids_without_deprecated_elements(tmp_path: Path) -> None:
    lines = fly("tables", tmp_path, flags=WITHOUT_DEPRECATED, more="compiled: {omit_deprecated: true}\n")
    assert own(lines) == own(expected("tables"))  # NASA's log has a handle that was never set then


@pytest.mark.slow
@pytest.mark.parametrize("name", [each for each in NAMES if each not in ("pools", "unregistered")])
def test_application_prints_the_same_under_the_guard(tmp_path: Path, name: str) -> None:
    """Two applications break the guard's rules: they read before the blocks of a pool, and send the memory behind a
    message buffer.
    """
    assert fly(name, tmp_path, more="compiled: {guard: true}\n") == expected(name)


def test_functions_of_extended_headers_are_undefined_as_in_nasas_default_build() -> None:
    names = ("EDSVersion", "Endian", "PlaybackFlag", "Subsystem", "System")
    assert not function_names() & {f"CFE_MSG_{verb}{name}" for verb in ("Get", "Set") for name in names}


def test_application_with_an_undefined_function_of_cfe_is_not_loaded(tmp_path: Path) -> None:
    console = fly_c(
        tmp_path, "int CFE_MSG_GetSystem(void *, void *);\nvoid TEST_Main(void) { CFE_MSG_GetSystem(0, 0); }"
    )
    assert "Error loading shared library: /cf/TEST.so: undefined symbol: CFE_MSG_GetSystem" in console
    assert "CFE_ES_LoadModule: Could not load file:/cf/TEST.so. EC = -1" in console


def own(lines: list[str]) -> list[str]:
    """Return the application's own output."""
    return [line for line in lines if line.startswith(MARK)]
