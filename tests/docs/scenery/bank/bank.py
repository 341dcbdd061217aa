"""Two payers, who pay three times each into one account, and no lock."""

import threading

import rospy
from std_msgs.msg import Int32


def pay():
    global balance
    for _ in range(3):
        before = balance
        rospy.get_time()
        balance = before + 1


def run(payers):
    for each in payers:
        each.start()
    for each in payers:
        each.join()
    total.publish(balance)


rospy.init_node("bank")
balance = 0
total = rospy.Publisher("total", Int32, queue_size=10, latch=True)
run([threading.Thread(target=pay) for _ in range(2)])
