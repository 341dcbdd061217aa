"""A publisher of joint states that gets the positions from two topics."""

import joint_state_publisher
import rospy

ROBOT = """<robot name="robot">
  <link name="base"/>
  <link name="rim"/>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="rim"/></joint>
</robot>"""
rospy.set_param("robot_description", ROBOT)
rospy.set_param("source_list", ["/left", "/right"])
rospy.init_node("joints")
joint_state_publisher.JointStatePublisher().loop()
