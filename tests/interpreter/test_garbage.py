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


def test_it_comes_back_with_the_outermost() -> None:
    with no_collection:
        with no_collection:
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_it_stays_off_when_it_was() -> None:
    gc.disable()
    with no_collection:
        pass
    assert not gc.isenabled()


def test_a_thread_that_ends_first_does_not_bring_it_back_into_another() -> None:
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


def test_a_forked_process_does_not_wait_for_threads_that_stayed_behind() -> None:
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
