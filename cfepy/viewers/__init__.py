"""Programs that look at a run while it goes on, and take part in it: viewers and their servers.

What belongs here listens on a real socket, shows what the mission's graph has, and lets what comes in enter through
the door that a journal has. ROS's own protocols between nodes are `cfepy.ros_host`; pictures of a run that is over,
`cfepy.reports`.
"""
