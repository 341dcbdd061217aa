"""Pipes: making and deleting them, their options, names and number (sb_pipe_mang_test.c)."""

from __future__ import annotations

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.mission import Mission
from cfepy.sb import PIPEOPTS_IGNOREMINE
from cfepy.status import (
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_SB_BAD_ARGUMENT,
    CFE_SB_MAX_PIPES_MET,
    CFE_SB_PIPE_CR_ERR,
    CFE_SUCCESS,
)
from tests.functional.harness import status_of

DEPTH, NAME = 10, "Test Pipe"


def test_pipe_create(cfe: Cfe, mission: Mission) -> None:
    sb = cfe.sb
    pipe = sb.create_pipe(DEPTH, NAME)
    assert status_of(sb.create_pipe, DEPTH, NAME) == CFE_SB_PIPE_CR_ERR, "the name is taken"
    sb.delete_pipe(pipe)
    assert status_of(sb.delete_pipe, pipe) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.delete_pipe, UNDEFINED) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.create_pipe, mission.config.os_queue_max_depth + 5, NAME) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.create_pipe, 0, NAME) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.create_pipe, DEPTH, "") == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.create_pipe, DEPTH, "N" * 20) == CFE_SB_PIPE_CR_ERR


def test_pipe_create_max_limit(cfe: Cfe, mission: Mission) -> None:
    pipes: list[int] = []

    def create() -> None:
        pipes.append(cfe.sb.create_pipe(DEPTH, f"TestPipe{len(pipes)}"))

    while (status := status_of(create)) == CFE_SUCCESS:
        assert len(pipes) <= mission.config.sb_max_pipes
    assert status == CFE_SB_MAX_PIPES_MET
    assert 0 < len(pipes) < mission.config.sb_max_pipes, "the core has pipes too"
    assert {status_of(cfe.sb.delete_pipe, pipe) for pipe in pipes} == {CFE_SUCCESS}


def test_pipe_index(cfe: Cfe, mission: Mission) -> None:
    pipe = cfe.sb.create_pipe(DEPTH, NAME)
    assert 0 <= cfe.sb.pipe_id_to_index(pipe) < mission.config.sb_max_pipes
    assert status_of(cfe.sb.pipe_id_to_index, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    cfe.sb.delete_pipe(pipe)


def test_pipe_options(cfe: Cfe) -> None:
    sb = cfe.sb
    pipe = sb.create_pipe(DEPTH, NAME)
    assert sb.get_pipe_opts(pipe) == 0
    for options in (2, PIPEOPTS_IGNOREMINE, 0):
        sb.set_pipe_opts(pipe, options)
        assert sb.get_pipe_opts(pipe) == options
    assert status_of(sb.set_pipe_opts, UNDEFINED, 2) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.get_pipe_opts, UNDEFINED) == CFE_SB_BAD_ARGUMENT
    sb.delete_pipe(pipe)


def test_pipe_name(cfe: Cfe) -> None:
    sb = cfe.sb
    pipe = sb.create_pipe(DEPTH, NAME)
    assert sb.get_pipe_name(pipe) == NAME
    assert sb.get_pipe_id_by_name(NAME) == pipe
    assert status_of(sb.get_pipe_name, UNDEFINED) == CFE_SB_BAD_ARGUMENT
    assert status_of(sb.get_pipe_id_by_name, "Invalid Pipe") == CFE_SB_BAD_ARGUMENT
    sb.delete_pipe(pipe)
    assert status_of(sb.get_pipe_id_by_name, NAME) == CFE_SB_BAD_ARGUMENT
