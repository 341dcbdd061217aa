"""Exploring schedules: flying a mission under many, telling what failed, and making the failing one short.

May import everything to the left of cfepy.explore.
"""
