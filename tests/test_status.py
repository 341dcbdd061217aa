"""Status codes and the error tree."""

from __future__ import annotations

import copy
import pickle

import pytest

from cfepy import status
from cfepy.status import CfeError, OsalError, UsageError


def test_numbers_are_signed_as_printed_by_nasas_cfe() -> None:
    assert status.CFE_SB_BAD_ARGUMENT == -905969661
    assert status.CFE_SUCCESS == status.OS_SUCCESS == 0
    assert status.CFE_ES_LIB_ALREADY_LOADED == 0x44000028


@pytest.mark.parametrize(
    ("value", "name"),
    [
        (0, "CFE_SUCCESS"),
        (-905969661, "CFE_SB_BAD_ARGUMENT"),
        (0xCA000003, "CFE_SB_BAD_ARGUMENT"),
        (-108, "OS_FS_ERR_PATH_INVALID"),
        (-1, "OS_ERROR"),
        (12345, "UNKNOWN_STATUS"),
    ],
)
def test_name_of(value: int, name: str) -> None:
    assert status.name_of(value) == name


def test_severity_and_service() -> None:
    assert status.severity_of(status.CFE_TBL_INFO_UPDATED) == status.CFE_SEVERITY_INFO
    assert status.severity_of(status.CFE_TBL_ERR_NO_ACCESS) == status.CFE_SEVERITY_ERROR
    assert status.severity_of(status.OS_ERR_INVALID_ID) == status.CFE_SEVERITY_ERROR
    assert [status.service_of(code) for code in (0xC2000001, 0xC4000001, 0xC6000001, 0xC8000002)] == [
        "EVS",
        "ES",
        "FS",
        "GENERIC",
    ]
    assert [status.service_of(code) for code in (0xCA000001, 0xCC000001, 0xCE000001, -16)] == [
        "SB",
        "TBL",
        "TIME",
        "OSAL",
    ]


def test_status_to_string() -> None:
    assert status.status_to_string(status.CFE_SB_BAD_ARGUMENT) == "0xca000003"
    assert status.status_to_string(0) == "0x00000000"


def test_cfe_error_has_name_number_and_text() -> None:
    error = CfeError(0xCA000003, "no such pipe")
    assert error.status == -905969661
    assert str(error) == "CFE_SB_BAD_ARGUMENT (0xCA000003): no such pipe"
    assert str(CfeError(status.CFE_SB_NO_MESSAGE)) == "CFE_SB_NO_MESSAGE (0xCA000002)"
    assert str(OsalError(status.OS_ERR_NO_FREE_IDS, "64 tasks")) == "OS_ERR_NO_FREE_IDS (-14): 64 tasks"
    assert isinstance(OsalError(-1), CfeError)


def test_errors_survive_copying() -> None:
    error = CfeError(status.CFE_ES_BAD_ARGUMENT, "text")
    assert str(copy.copy(error)) == str(pickle.loads(pickle.dumps(error))) == str(error)


def test_usage_error_has_file_line_and_field() -> None:
    assert str(UsageError("is wrong", file="a.yaml", line=3, field="limits.x")) == "a.yaml:3: limits.x: is wrong"
    assert str(UsageError("is wrong", file="a.yaml")) == "a.yaml: is wrong"
    assert str(UsageError("is wrong")) == "is wrong"
    assert isinstance(UsageError("x"), ValueError)
