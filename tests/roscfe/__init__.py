"""The interface library for ROS nodes in C++ (flight/roscfe), compiled and run here."""
