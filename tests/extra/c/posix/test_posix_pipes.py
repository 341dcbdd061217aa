"""Pipes, SIGPIPE, mmap and freopen of compiled applications."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.extra.c.building import fly_c, needs_compiler, said
from tests.extra.c.posix.comparing import FORTIFIED, compare

pytestmark = needs_compiler


def test_program_prints_the_same_in_flight(tmp_path: Path) -> None:
    compare(tmp_path, "pipes")


@pytest.mark.slow
def test_fortified_program_prints_the_same_in_flight(tmp_path: Path) -> None:
    compare(tmp_path, "pipes", *FORTIFIED)


def test_reader_and_writer_of_a_pipe_wait_for_each_other(tmp_path: Path) -> None:
    source = r"""
        #include <unistd.h>
        static int ends[2];
        static void Writer(void)
        {
            OS_TaskDelay(100);
            write(ends[1], "late", 4);
            static char much[70000];
            SAY("wrote %d", (int)write(ends[1], much, sizeof much));
            close(ends[1]);
        }
        void TEST_Main(void)
        {
            static char data[20000];
            uint32_t child;
            long total = 0, count;
            pipe(ends);
            CFE_ES_CreateChildTask(&child, "W", Writer, NULL, 16384, 60, 0);
            SAY("read %d %.4s", (int)read(ends[0], data, 4), data);
            OS_TaskDelay(50);
            while ((count = read(ends[0], data, sizeof data)) > 0)
                total += count;
            SAY("read %ld, %ld", total, count);
            OS_TaskDelay(9000);
        }
    """
    flown = said(fly_c(tmp_path, source, 1, flags=("-w",)))
    assert flown[0] == "read 4 late"
    assert sorted(flown[1:]) == ["read 70000, 0", "wrote 70000"]


def test_write_without_a_reader_ends_the_process_by_sigpipe(tmp_path: Path) -> None:
    source = r"""
        #include <unistd.h>
        void TEST_Main(void)
        {
            int ends[2];
            pipe(ends);
            close(ends[0]);
            write(ends[1], "x", 1);
            SAY("not reached");
        }
    """
    console = fly_c(tmp_path, source, 1, flags=("-w",))
    assert "SIGPIPE: the pipe has no reader; signal(SIGPIPE, SIG_IGN) avoids the signal" in console
    assert said(console) == []


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        ("signal(SIGINT, handler)", "signal() with a handler is not available"),
        ("mmap((void *)4096, 4096, 3, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0)", "mmap() at a fixed address"),
        ("mmap(0, 4096, 7, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)", "mmap() of executable memory is not available"),
        ("munmap(mmap(0, 8192, 3, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0), 4096)", "munmap() of a part of a mapping"),
        ('freopen("/cf/x", "w", stdout)', "freopen() of a standard stream is not available"),
        ("*(char *)mmap(0, 4096, 1, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) = 1", "SIGSEGV"),
    ],
)
def test_use_that_is_not_available_is_a_fault(call: str, reason: str, tmp_path: Path) -> None:
    source = f"""
        #include <signal.h>
        #include <stdio.h>
        #include <sys/mman.h>
        void handler(int number) {{}}
        void TEST_Main(void)
        {{
            {call};
            SAY("not reached");
        }}
    """
    console = fly_c(tmp_path, source, 1, flags=("-w",))
    assert reason in console
    assert said(console) == []
