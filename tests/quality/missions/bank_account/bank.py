"""Pays in and out. Each access to the balance has the lock, but not the two of a payment together."""

import sys
import threading

import rospy


class Account:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.balance = 100

    def read(self) -> int:
        with self.lock:
            return self.balance

    def pay(self, amount: int) -> None:
        balance = self.read()
        with self.lock:
            self.balance = balance + amount


rospy.init_node("bank")
account = Account()
payments = [threading.Thread(target=account.pay, args=(amount,)) for amount in (50, -30)]
for payment in payments:
    payment.start()
for payment in payments:
    payment.join()
if account.balance != 120:
    sys.exit(f"the balance is {account.balance}")
