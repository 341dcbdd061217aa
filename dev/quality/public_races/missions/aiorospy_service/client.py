"""Sends two requests through one proxy at once."""

import asyncio

import rospy
from aio.service import AsyncServiceProxy
from rospy_tutorials.srv import AddTwoInts

rospy.init_node("client")


async def main():
    proxy = AsyncServiceProxy("/add", AddTwoInts)
    await proxy.wait_for_service(log_period=1)
    answers = await asyncio.gather(*(proxy.send(number, 10) for number in range(3)))
    assert [each.sum for each in answers] == [10, 11, 12], answers


asyncio.get_event_loop().run_until_complete(main())
