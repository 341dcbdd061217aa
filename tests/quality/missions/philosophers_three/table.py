"""Philosophers at a round table. Each takes the fork on the left, then the one on the right."""

import threading

import rospy

SEATS = 3


def dine(seat: int) -> None:
    with forks[seat], forks[(seat + 1) % SEATS]:
        rospy.logdebug("philosopher %d eats", seat)


rospy.init_node("table")
forks = [threading.Lock() for _ in range(SEATS)]
philosophers = [threading.Thread(target=dine, args=(seat,)) for seat in range(SEATS)]
for philosopher in philosophers:
    philosopher.start()
for philosopher in philosophers:
    philosopher.join()
