"""Opens and closes a hand; callers are served side by side, and the handler keeps its request in the object."""

import rospy
from std_srvs.srv import SetBool, SetBoolRequest, SetBoolResponse


class Gripper:
    def __init__(self) -> None:
        self.closed = False
        rospy.Service("grip", SetBool, self.on_grip)

    def on_grip(self, request: SetBoolRequest) -> SetBoolResponse:
        self.closed = request.data
        rospy.loginfo("moving")
        return SetBoolResponse(True, "closed" if self.closed else "open")


rospy.init_node("gripper")
Gripper()
rospy.spin()
