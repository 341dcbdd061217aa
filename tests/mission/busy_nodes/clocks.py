"""All clocks, all random numbers, the process and its files."""

import datetime
import glob
import os
import pathlib
import random
import secrets
import string
import sys
import time
import uuid

import numpy as np
import rospy

rospy.init_node("clocks")
here = os.path.dirname(os.path.abspath(__file__))
for _ in range(3):
    rospy.sleep(random.random())
    print(time.time(), time.time_ns(), time.monotonic(), time.perf_counter_ns(), time.process_time_ns(), time.ctime())
    print(
        time.strftime("%c %Z"), time.localtime(), time.mktime(time.gmtime()), time.clock_gettime(time.CLOCK_MONOTONIC)
    )
    print(
        datetime.datetime.now(), datetime.datetime.utcnow(), datetime.date.today(), rospy.Time.now(), time.thread_time()
    )
print(
    random.getrandbits(80), random.sample(range(100), 5), random.choices(string.ascii_letters, k=5), random.gauss(0, 1)
)
print(random.Random().random(), random.SystemRandom().randint(0, 99), secrets.token_urlsafe(9), os.urandom(5).hex())
print(uuid.uuid1(), uuid.uuid4(), uuid.uuid5(uuid.NAMESPACE_DNS, "a"), uuid.getnode() > 0)
print(np.random.rand(2), np.random.normal(size=2), np.random.permutation(5), np.random.default_rng().integers(0, 99, 3))
generators = (np.random.RandomState(), np.random.Generator(np.random.PCG64()), np.random.default_rng(5))
print([generator.random() for generator in generators], np.random.SeedSequence().entropy)
random.seed(3)
np.random.seed(3)
print(random.random(), np.random.rand(), np.random.choice(["a", "b", "c"], 4), np.random.get_state()[2])
print(os.getpid(), os.getppid(), sorted(os.environ), os.getcwd() == here, os.uname().nodename, os.getloadavg())
print(os.listdir(here), [os.path.basename(name) for name in glob.glob(here + "/*.py")], next(os.walk(here))[2])
print([path.name for path in pathlib.Path(here).iterdir()], sys.argv[1:], [entry.name for entry in os.scandir(here)])
