"""Two clerks count one stock. One takes the lock of the stock, the other the lock of the list of clerks."""

import sys
import threading

import rospy

stock_lock, clerks_lock = threading.Lock(), threading.Lock()
stock = 0


def receive() -> None:
    global stock
    with stock_lock:
        before = stock
        rospy.logdebug("before the delivery there were %d", before)
        stock = before + 1


def restock() -> None:
    global stock
    with clerks_lock:
        before = stock
        rospy.logdebug("before the return there were %d", before)
        stock = before + 1


rospy.init_node("stock")
clerks = [threading.Thread(target=work) for work in (receive, restock)]
for clerk in clerks:
    clerk.start()
for clerk in clerks:
    clerk.join()
if stock != 2:
    sys.exit(f"two boxes came, {stock} are there")
