"""Pools of threads under the names of `multiprocessing`."""

from __future__ import annotations


def test_results_arrive_in_virtual_time(run):
    program = run("""
        import time
        from multiprocessing.pool import ThreadPool
        def slow(n):
            time.sleep(n)
            return n * n
        begin = time.time()
        with ThreadPool(3) as pool:
            print(pool.map(slow, [3, 1, 2]), round(time.time() - begin, 3))
            print(pool.apply(slow, (1,)), pool.starmap(pow, [(2, 3), (3, 2)]), list(pool.imap(slow, [1, 0])))
            print(sorted(pool.imap_unordered(slow, [2, 1])), pool.map(slow, []))
    """)
    assert program.lines == ["[9, 1, 4] 3.0", "1 [8, 9] [1, 0]", "[1, 4] []"]


def test_asynchronous_results(run):
    program = run("""
        import multiprocessing, time
        from multiprocessing.pool import ThreadPool
        pool = ThreadPool(2, print, ("begun",))
        late = pool.apply_async(time.sleep, (2,), callback=lambda value: print("callback", value))
        try:
            late.get(timeout=1)
        except multiprocessing.TimeoutError as error:
            print("late", late.ready())
        print(late.get(), late.successful())
        bad = pool.map_async(lambda n: 1 / n, [1, 0], error_callback=lambda error: print("error", error))
        bad.wait()
        try:
            bad.get()
        except ZeroDivisionError as error:
            print(bad.successful(), error)
        try:
            pool.join()
        except ValueError as error:
            print(error)
        pool.close()
        pool.join()
        try:
            pool.apply(print)
        except ValueError as error:
            print(error)
    """)
    assert program.lines == [
        "begun",
        "late False",
        "callback None",
        "None True",
        "begun",
        "error division by zero",
        "False division by zero",
        "Pool is still running",
        "Pool not running",
    ]


def test_dummy_processes_are_threads(run):
    program = run("""
        import time
        from multiprocessing.dummy import Pool, Process, Queue
        queue = Queue()
        worker = Process(target=lambda: (time.sleep(1), queue.put("done")))
        worker.start()
        print(worker.is_alive(), queue.get(), worker.join(), worker.is_alive())
        print(Pool(2).map(len, ["a", "bb"]))
    """)
    assert program.lines == ["True done None False", "[1, 2]"]
