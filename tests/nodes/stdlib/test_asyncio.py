"""The standard library's asyncio in virtual time."""

from __future__ import annotations

import gc
import sys


def test_sleep_gather_queue_and_timeout(run):
    program = run(
        """
        import asyncio, time
        log = []
        async def tick(name, period):
            for _ in range(3):
                await asyncio.sleep(period)
                log.append((name, time.monotonic()))
        async def main():
            queue = asyncio.Queue()
            asyncio.get_running_loop().call_later(5, queue.put_nowait, "late")
            await asyncio.gather(tick("a", 10), tick("b", 15))
            log.append(await queue.get())
            try:
                await asyncio.wait_for(asyncio.Event().wait(), 2.5)
            except asyncio.TimeoutError:
                log.append(("timeout", time.monotonic()))
        asyncio.run(main())
        """,
        call_cost_ns=0,
    )
    assert program.text == ""
    times = {("a", 10.0), ("b", 15.0), ("a", 20.0), ("a", 30.0), ("b", 30.0), ("b", 45.0), "late", ("timeout", 47.5)}
    assert set(program.global_("log")) == times


def test_threads_and_executors_wake_the_loop(run):
    program = run("""
        import asyncio, threading, time
        async def main():
            loop = asyncio.get_running_loop()
            done = asyncio.Event()
            threading.Timer(3, lambda: loop.call_soon_threadsafe(done.set)).start()
            print(await loop.run_in_executor(None, lambda: (time.sleep(1), "slept")[1]), round(time.monotonic(), 3))
            await done.wait()
            print(round(time.monotonic(), 3))
        asyncio.run(main())
    """)
    assert program.lines == ["slept 1.0", "3.0"]


def test_loop_of_a_daemon_thread_ends_without_a_word(run, monkeypatch):
    said = []
    monkeypatch.setattr(sys, "unraisablehook", lambda found: said.append(found.exc_value))
    program = run("""
        import asyncio, threading, time
        loop = asyncio.new_event_loop()
        threading.Thread(target=loop.run_forever, daemon=True).start()
        time.sleep(1)
    """)
    assert program.text == ""
    del program
    gc.collect()
    assert said == []
