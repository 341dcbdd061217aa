"""asyncio: tasks, queues, locks, time-outs, work in threads; and what the collector and weak references do."""

import asyncio
import gc
import random
import threading
import time
import weakref

import rospy


class Thing:
    def __init__(self, number):
        self.number = number
        self.loop = self  # only the collector gets rid of it


async def producer(stream, number):
    for item in range(4):
        await asyncio.sleep(random.random() / 50)
        await stream.put((number, item))
    return number


async def consumer(stream, lock, seen):
    while True:
        item = await stream.get()
        async with lock:
            await asyncio.sleep(0.001)
            seen.append(item)
        stream.task_done()


async def main():
    stream, lock, seen = asyncio.Queue(2), asyncio.Lock(), []
    consumers = [asyncio.create_task(consumer(stream, lock, seen)) for _ in range(2)]
    made = await asyncio.gather(*(producer(stream, number) for number in range(3)))
    await stream.join()
    for task in consumers:
        task.cancel()
    await asyncio.gather(*consumers, return_exceptions=True)
    loop = asyncio.get_running_loop()
    event = asyncio.Event()
    threading.Timer(0.02, loop.call_soon_threadsafe, (event.set,)).start()
    await event.wait()
    try:
        await asyncio.wait_for(asyncio.sleep(9), 0.01)
    except TimeoutError:
        print("timed out", loop.time())
    slept = await asyncio.gather(*(loop.run_in_executor(None, time.sleep, pause / 100) for pause in range(3)))
    print(made, seen, slept, time.monotonic_ns())


rospy.init_node("loop")
asyncio.run(main())
gone = []
things = weakref.WeakSet(Thing(number) for number in range(5))
for thing in things:
    weakref.finalize(thing, gone.append, thing.number)
del thing
print(len(things), gc.collect() > 0, len(things), sorted(gone))
cycles = [weakref.ref(Thing(number), lambda ref: print("collected", rospy.get_time())) for number in range(3)]
rospy.sleep(21)
print([ref() for ref in cycles])
