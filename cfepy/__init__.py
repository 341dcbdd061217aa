"""cfepy: NASA's core Flight Executive and ROS 1 nodes together on one simulated processor, in pure Python."""

__version__ = "0.1.0"
