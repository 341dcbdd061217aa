"""Workers find the costs of their parts; the first one adds them up, and should wait for all at the barrier before."""

import sys
import threading

import rospy

WORKERS = 3
costs = [0] * WORKERS
totals = []


def work(me: int) -> None:
    costs[me] = me + 1
    if me == 0:
        barrier.wait()
        totals.append(sum(costs))
    else:
        report(me)


def report(me: int) -> None:
    barrier.wait()
    rospy.logdebug("worker %d is over the barrier", me)
    costs[me] = 0


rospy.init_node("cluster")
barrier = threading.Barrier(WORKERS)
workers = [threading.Thread(target=work, args=(number,)) for number in (1, 2, 0)]
for worker in workers:
    worker.start()
for worker in workers:
    worker.join()
if totals != [6]:
    sys.exit(f"the total is {totals}")
