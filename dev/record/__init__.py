"""Programs that record the behaviour of real ROS."""
