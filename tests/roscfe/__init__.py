"""The interface library for ROS nodes in C++ (roscfe), compiled and run here."""
