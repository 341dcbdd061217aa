"""Times without a collection of garbage, over all threads and forked processes."""

from __future__ import annotations

import gc
import os
import threading
from collections.abc import Iterator

import pytest

from cfepy.interpreter.garbage import no_collection


@pytest.fixture(autouse=True)
def collecting() -> Iterator[None]:
    gc.enable()
    yield
    gc.enable()


def test_garbage_collection_is_enabled_again_by_the_outermost_block() -> None:
    with no_collection:
        with no_collection:
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_garbage_collection_stays_disabled_if_it_was() -> None:
    gc.disable()
    with no_collection:
        pass
    assert not gc.isenabled()


def test_ending_thread_does_not_enable_garbage_collection_for_another() -> None:
    inside, leave = threading.Event(), threading.Event()

    def other() -> None:
        with no_collection:
            inside.set()
            leave.wait()

    thread = threading.Thread(target=other)
    with no_collection:
        thread.start()
        inside.wait()
        leave.set()
        thread.join()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_forked_process_does_not_wait_for_threads_of_its_parent() -> None:
    inside, leave = threading.Event(), threading.Event()

    def other() -> None:
        with no_collection:
            inside.set()
            leave.wait()

    thread = threading.Thread(target=other)
    thread.start()
    inside.wait()
    child = os.fork()
    if not child:
        os._exit(0 if gc.isenabled() else 1)
    leave.set()
    thread.join()
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
