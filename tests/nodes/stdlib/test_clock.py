"""`time` and `datetime` of a node: virtual, in UTC, with any clock and time zone of the host."""

from __future__ import annotations

import time

EPOCH_NS = 1_700_000_000_000_000_000  # 2023-11-14 22:13:20 UTC


def test_time(run):
    program = run(
        """
        import time
        from time import sleep
        class Holder:
            now = time.time
        start = time.perf_counter()
        sleep(1.5)
        print(time.time(), time.time_ns(), time.monotonic(), time.perf_counter() - start, Holder().now())
        print(time.strftime("%Y-%m-%d %H:%M:%S"), time.localtime() == time.gmtime(), time.localtime().tm_hour)
        print(time.ctime(), time.asctime(), time.mktime(time.gmtime(5)), time.tzname, time.timezone)
        print(time.clock_gettime(time.CLOCK_MONOTONIC), time.strptime("2020", "%Y").tm_year, time.process_time())
        """,
        epoch_ns=EPOCH_NS,
        call_cost_ns=0,
    )
    assert program.lines == [
        "1700000001.5 1700000001500000000 1.5 1.5 1700000001.5",
        "2023-11-14 22:13:21 True 22",
        "Tue Nov 14 22:13:21 2023 Tue Nov 14 22:13:21 2023 5.0 ('UTC', 'UTC') 0",
        "1.5 2020 0.0",
    ]


def test_datetime(run, monkeypatch):
    monkeypatch.setenv("TZ", "America/New_York")
    time.tzset()
    try:
        program = run(
            """
            import copy, datetime, json, pickle
            now, utc = datetime.datetime.now(), datetime.timezone.utc
            print(now, datetime.datetime.utcnow() == now, datetime.datetime.today() == now, datetime.date.today())
            print(repr(now), now.timestamp(), datetime.datetime.now(utc).isoformat())
            print(datetime.datetime.fromtimestamp(0), now.astimezone().tzname(), isinstance(now, datetime.date))
            print(now - datetime.datetime(2023, 11, 14), type(now + datetime.timedelta(1)) is datetime.datetime)
            print(pickle.loads(pickle.dumps(now)) == copy.copy(now) == now, datetime.datetime.strptime("2020", "%Y"))
            """,
            epoch_ns=EPOCH_NS,
            call_cost_ns=0,
        )
    finally:
        monkeypatch.undo()
        time.tzset()
    assert program.lines == [
        "2023-11-14 22:13:20 True True 2023-11-14",
        "datetime.datetime(2023, 11, 14, 22, 13, 20) 1700000000.0 2023-11-14T22:13:20+00:00",
        "1970-01-01 00:00:00 UTC True",
        "22:13:20 True",
        "True 2020-01-01 00:00:00",
    ]


def test_calls_that_poll_take_virtual_time(run):
    program = run(
        """
        import time
        count = 0
        while time.time() < 0.01:
            count += 1
        """,
        call_cost_ns=1000,
    )
    assert program.global_("count") == 9_999


def test_short_sleeps_still_take_time(run):
    program = run(
        """
        import time
        time.sleep(1e-12)
        tiny = time.monotonic_ns()
        time.sleep(0.1); time.sleep(0.2)
        """,
        call_cost_ns=0,
    )
    assert program.global_("tiny") == 1
    assert program.kernel.now == 300_000_001


def test_logging_is_stamped_with_virtual_time(run):
    program = run(
        """
        import logging, time
        logging.basicConfig(format="%(asctime)s %(levelname)s %(threadName)s %(message)s", level=logging.INFO)
        time.sleep(2)
        logging.getLogger("nav").info("low fuel %d", 3)
        """,
        epoch_ns=EPOCH_NS,
        call_cost_ns=0,
    )
    assert program.lines == ["2023-11-14 22:13:22,000 INFO MainThread low fuel 3"]
