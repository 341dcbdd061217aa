"""Stopping a run to look at it: breakpoints, steps, and Python's debugger in the task of an application."""
