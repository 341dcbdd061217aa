"""Child tasks: permission to make them, their names and their ends (es_task_test.c)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.app import Cfe
from cfepy.ids import UNDEFINED
from cfepy.status import (
    CFE_ES_BAD_ARGUMENT,
    CFE_ES_ERR_CHILD_TASK_CREATE,
    CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK,
    CFE_ES_ERR_NAME_NOT_FOUND,
    CFE_ES_ERR_RESOURCEID_NOT_VALID,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
)
from tests.functional.harness import CHILD_PRIORITY, CHILD_STACK, call_in_child, call_outside, status_of

NAME = "CHILD_TASK_1"


def counter(cfe: Cfe, counts: list[int]) -> Callable[[], None]:
    """Return a task that counts every 100 ms."""

    def count() -> None:
        while True:
            counts.append(len(counts))
            cfe.os.task_delay(100)

    return count


def create(cfe: Cfe, entry: Any, name: str = NAME, stack_size: int = CHILD_STACK) -> int:
    return cfe.es.create_child_task(name, entry, stack_size, CHILD_PRIORITY)


def nothing() -> None:
    """A task that is over at once."""


def test_create_child(cfe: Cfe) -> None:
    counts: list[int] = []
    child = create(cfe, counter(cfe, counts))
    while len(counts) < 5:
        cfe.os.task_delay(10)
    assert len(counts) == 5
    assert status_of(create, cfe, nothing) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL, "the name is taken"
    cfe.es.delete_child_task(child)
    call_in_child(cfe, lambda: in_a_child_task(cfe))
    call_outside(cfe, lambda: in_no_application(cfe))
    assert status_of(create, cfe, None) == CFE_ES_BAD_ARGUMENT
    assert status_of(create, cfe, nothing, NAME, 0) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL
    assert status_of(create, cfe, nothing, "N" * 20) == CFE_STATUS_EXTERNAL_RESOURCE_FAIL


def in_a_child_task(cfe: Cfe) -> None:
    es = cfe.es
    assert status_of(create, cfe, nothing, "Test") == CFE_ES_ERR_CHILD_TASK_CREATE
    main_task = es.get_app_info(es.get_app_id()).main_task_id
    assert status_of(es.delete_child_task, main_task) == CFE_ES_ERR_CHILD_TASK_DELETE_MAIN_TASK
    es.exit_child_task()
    raise AssertionError("a child task that has exited goes on")


def in_no_application(cfe: Cfe) -> None:
    assert status_of(cfe.es.get_app_id) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(cfe.es.get_task_id) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(create, cfe, nothing, "TaskName") == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_child_task_name(cfe: Cfe) -> None:
    es = cfe.es
    child = create(cfe, counter(cfe, []))
    assert es.get_task_id_by_name(NAME) == child
    assert es.get_task_name(child) == NAME
    assert status_of(es.get_task_id_by_name, "INVALID_NAME") == CFE_ES_ERR_NAME_NOT_FOUND
    assert status_of(es.get_task_name, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    es.delete_child_task(child)
    assert status_of(es.get_task_name, child) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_child_tasks_delete(cfe: Cfe) -> None:
    counts: list[int] = []
    child = create(cfe, counter(cfe, counts))
    cfe.os.task_delay(500)
    before = len(counts)
    assert before == 5
    cfe.es.delete_child_task(child)
    cfe.os.task_delay(500)
    assert len(counts) == before
    assert status_of(cfe.es.delete_child_task, UNDEFINED) == CFE_ES_ERR_RESOURCEID_NOT_VALID
    assert status_of(cfe.es.delete_child_task, child) == CFE_ES_ERR_RESOURCEID_NOT_VALID


def test_exit_child(cfe: Cfe) -> None:
    counts: list[int] = []

    def count_once() -> None:
        while True:
            counts.append(1)
            cfe.es.exit_child_task()

    create(cfe, count_once)
    cfe.os.task_delay(500)
    assert counts == [1]
    cfe.es.exit_child_task()
    assert cfe.es.run_loop() is True, "a main task does not exit that way"


def test_child_with_custom_stack(cfe: Cfe) -> None:
    """The stack is always OSAL's; its size is the caller's."""
    sizes: list[int] = []
    es = cfe.es

    def look() -> None:
        sizes.append(es.get_task_info(es.get_task_id()).stack_size)
        es.exit_child_task()

    child = create(cfe, look, "CHILD_W_STACK", 8 * CHILD_STACK)
    cfe.os.task_delay(200)
    assert sizes == [8 * CHILD_STACK]
    assert status_of(es.get_task_name, child) == CFE_ES_ERR_RESOURCEID_NOT_VALID
