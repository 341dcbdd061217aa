"""Two accounts, two transfers, each of which locks its source first."""

import threading

import rospy


class Account:
    def __init__(self, number: int) -> None:
        self.number = number
        self.lock = threading.Lock()
        self.balance = 100


def transfer(source: Account, target: Account) -> None:
    with source.lock, target.lock:
        source.balance -= 10
        target.balance += 10


rospy.init_node("transfer")
here, there = Account(1), Account(2)
threads = [threading.Thread(target=transfer, args=pair) for pair in ((here, there), (there, here))]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
