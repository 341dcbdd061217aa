"""Lamport's bakery, where nobody tells that he is about to draw a number."""

import threading

import rospy

CUSTOMERS = 3


class Shop:
    def __init__(self) -> None:
        self.numbers = [0] * CUSTOMERS
        self.choosing = [False] * CUSTOMERS
        self.served = 0

    def draw(self, me: int) -> None:
        highest = max(self.numbers)
        self.numbers[me] = highest + 1

    def wait_for(self, other: int, me: int) -> None:
        while self.numbers[other] and (self.numbers[other], other) < (self.numbers[me], me):
            rospy.sleep(0.001)

    def buy(self, me: int) -> None:
        self.draw(me)
        for other in range(CUSTOMERS):
            self.wait_for(other, me)
        self.served += 1
        rospy.logdebug("customer %d", me)
        if self.served > 1:
            raise RuntimeError("two are served at once")
        self.served -= 1
        self.numbers[me] = 0


rospy.init_node("shop")
shop = Shop()
for number in range(CUSTOMERS):
    threading.Thread(target=shop.buy, args=(number,)).start()
