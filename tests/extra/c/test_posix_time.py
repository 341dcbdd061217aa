"""The clocks and waits of POSIX in compiled applications, in virtual time."""

from __future__ import annotations

from pathlib import Path

from tests.extra.c.building import compile_cpp, console_of, fly, fly_c, needs_compiler, needs_cpp, said, write_mission

pytestmark = needs_compiler

SOURCE = r"""
    #define _GNU_SOURCE
    #include <errno.h>
    #include <sys/time.h>
    #include <time.h>
    #include <unistd.h>
    #define SAY(...) CFE_ES_WriteToSysLog("> " __VA_ARGS__)
    #define AFTER(name, call)                                    \
        do {                                                     \
            long status = call;                                  \
            SAY(name " %ld %ld\n", status, passed(&start));      \
        } while (0)
    static long passed(const struct timespec *since)
    {
        struct timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        return ((now.tv_sec - since->tv_sec) * 1000000000L + now.tv_nsec - since->tv_nsec) / 1000000;
    }
    void TEST_Main(void)
    {
        struct timespec start, date, part = {0, 5000000}, wrong = {0, 1000000000};
        struct timeval day;
        time_t stored = 0, seconds = time(&stored);
        clock_gettime(CLOCK_REALTIME, &date);
        gettimeofday(&day, NULL);
        SAY("date %d %d %d\n", seconds == stored, seconds == date.tv_sec, day.tv_sec == date.tv_sec);
        SAY("year %d\n", gmtime(&seconds)->tm_year + 1900);
        clock_gettime(CLOCK_MONOTONIC, &start);
        AFTER("sleep", sleep(1));
        AFTER("usleep", usleep(20000));
        AFTER("nanosleep", nanosleep(&part, NULL));
        start.tv_sec += 2;
        AFTER("until", clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &start, NULL));
        int status = nanosleep(&wrong, NULL);
        SAY("wrong %d %d\n", status, errno == EINVAL);
        status = clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &part);
        SAY("cpu %d %d\n", status, errno == EINVAL);
        status = clock_getres(CLOCK_REALTIME, &part);
        SAY("resolution %d %ld\n", status, part.tv_nsec);
        SAY("utc %d\n", timespec_get(&part, TIME_UTC));
    }
"""


def test_clocks_and_waits_are_in_virtual_time(tmp_path: Path) -> None:
    found = said(fly_c(tmp_path, SOURCE, seconds=4))
    assert found == [
        "date 1 1 1",
        "year 1980",
        "sleep 0 1000",
        "usleep 0 1020",
        "nanosleep 0 1025",
        "until 0 0",
        "wrong -1 1",
        "cpu -1 1",
        "resolution 0 1",
        "utc 1",
    ]


@needs_cpp
def test_chrono_is_in_virtual_time(tmp_path: Path) -> None:
    source = r"""
        #include <chrono>
        #include <thread>
        using namespace std::chrono;
        extern "C" void TEST_Main(void)
        {
            auto start = steady_clock::now();
            std::this_thread::sleep_for(milliseconds(30));
            long passed = duration_cast<milliseconds>(steady_clock::now() - start).count();
            long years = duration_cast<hours>(system_clock::now().time_since_epoch()).count() / 24 / 365;
            CFE_ES_WriteToSysLog("> %ld %ld\n", passed, years);
        }
    """
    compile_cpp(tmp_path, "TEST", source)
    assert said(console_of(fly(write_mission(tmp_path, "TEST"), 1))) == ["30 10"]
