"""An inspector comes before the work is done; only nobody told the workers to wait."""

import threading

import rospy

lock = threading.Lock()
inspected = threading.Event()
done = 0


def work(amount: int) -> None:
    global done
    with lock:
        done += amount


def inspect() -> None:
    with lock:
        if done >= 3:
            raise ValueError(f"{done} pieces before the inspection")
    inspected.set()


rospy.init_node("shift")
threading.Thread(target=inspect).start()
for amount in (1, 2):
    threading.Thread(target=work, args=(amount,)).start()
