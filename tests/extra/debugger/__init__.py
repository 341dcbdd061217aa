"""Stopping a run to look at it."""
