"""One trace and one output, with any task context, hash seed and addresses of the process."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

NODE = """
import concurrent.futures, queue, random, secrets, threading, time, uuid
print(random.random(), random.Random().random(), uuid.uuid4(), uuid.uuid1(), secrets.token_hex(4))

class Sensor:
    def __init__(self, number):
        self.number = number

def work(name):
    time.sleep(0.01)
    print(name, time.monotonic())

names = {"alpha", "beta", "gamma", "delta", "epsilon"} | set("xyz")
for name in names:
    threading.Thread(target=work, args=(name,)).start()
for sensor in {Sensor(number) for number in range(8)}:
    threading.Thread(target=work, args=(sensor.number,)).start()
with concurrent.futures.ThreadPoolExecutor(3) as pool:
    print(list(pool.map(lambda x: (time.sleep(0.01), x)[1], range(5))))
"""

HOST = """
import sys
from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from cfepy.trace import Trace
with Kernel(context=sys.argv[2], trace=Trace()) as kernel:
    universe = Universe(kernel, name="node", script=sys.argv[1], seed=3, ordered_sets=True)
    universe.spawn()
    kernel.run()
    print(kernel.trace.digest(), kernel.now, universe.exit_status, *universe.output, sep="\\n")
"""


def test_trace_is_the_same_for_every_hash_seed_and_context(tmp_path):
    script = tmp_path / "node.py"
    script.write_text(NODE, encoding="utf-8")
    root = str(Path(__file__).parents[2])
    children = [
        subprocess.Popen(
            [sys.executable, "-c", HOST, str(script), context],
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": root},
            stdout=subprocess.PIPE,
            text=True,
        )
        for seed, context in (("0", "thread"), ("1", "greenlet"), ("random", "thread"))
    ]
    outputs = {child.communicate()[0] for child in children}
    assert len(outputs) == 1
    lines = outputs.pop().splitlines()
    assert lines[2] == "0"
    assert len(lines) == 3 + 1 + 1 + 8 + 8
