"""A token goes round: each station copies the number of the one before, the first one counts it up."""

import sys
import threading

import rospy

STATIONS = 4


def pass_on(station: int) -> None:
    with lock:
        number = numbers[station - 1]
        numbers[station] = number + 1 if station == 0 else number
    passed[station].set()


rospy.init_node("ring")
lock = threading.Lock()
numbers = [0] * STATIONS
passed = [threading.Event() for _ in range(STATIONS)]
stations = [threading.Thread(target=pass_on, args=(station,)) for station in range(STATIONS)]
for station in stations:
    station.start()
for station in stations:
    station.join()
if len(set(numbers)) > 1:
    sys.exit(f"the stations have {numbers}")
