"""Threads of every kind that wait for each other, with random pauses, and a log with time stamps."""

import collections
import concurrent.futures
import logging
import queue
import random
import sched
import threading
import time

import rospy

logging.basicConfig(level=logging.DEBUG, format="%(asctime)s %(created).9f %(threadName)s %(process)d %(message)s")
log = logging.getLogger("workers")

jobs = queue.PriorityQueue(maxsize=3)
results = queue.Queue()
slots = threading.BoundedSemaphore(2)
barrier = threading.Barrier(3)
ready = threading.Condition(threading.RLock())
go = threading.Event()
mine = threading.local()
order = collections.deque(maxlen=50)


def produce(number):
    go.wait()
    for item in range(6):
        time.sleep(random.uniform(0, 0.01))
        jobs.put((random.randrange(3), number, item))
    barrier.wait()
    log.info("producer %d done", number)


def consume():
    mine.count = 0
    while True:
        try:
            priority, number, item = jobs.get(timeout=0.2)
        except queue.Empty:
            break
        with slots:
            mine.count += 1
            time.sleep(random.expovariate(500))
            order.append((priority, number, item))
        with ready:
            ready.notify()
        jobs.task_done()
    results.put((threading.current_thread().name, mine.count))


def watch():
    with ready:
        seen = 0
        while seen < 5 and ready.wait(timeout=0.05):
            seen += 1
    log.debug("watched %d", seen)


def call(number):
    time.sleep(random.random() / 100)
    if number == 4:
        raise ValueError(number)
    return number * number


rospy.init_node("workers")
threads = [threading.Thread(target=produce, args=(n,), name=f"producer-{n}") for n in range(3)]
threads += [threading.Thread(target=consume, name=f"consumer-{n}") for n in range(3)]
threads += [threading.Thread(target=watch), threading.Timer(0.01, go.set)]
for thread in threads:
    thread.start()
with concurrent.futures.ThreadPoolExecutor(3, thread_name_prefix="pool") as pool:
    futures = [pool.submit(call, number) for number in range(8)]
    done, rest = concurrent.futures.wait(futures, timeout=0.005)
    print(sorted(map(futures.index, done)), len(rest))
    for future in concurrent.futures.as_completed(futures):
        print(futures.index(future), future.exception() or future.result(), time.monotonic_ns())
    print(list(pool.map(call, range(3))))
for thread in threads:
    thread.join()
print(list(order))
while not results.empty():
    print(*results.get())
plan = sched.scheduler(time.monotonic, time.sleep)
for delay, name in ((0.02, "b"), (0.01, "a"), (0.02, "c")):
    plan.enter(delay, 1, print, (name, time.time()))
plan.run()
print(time.process_time() > 0, threading.active_count())
