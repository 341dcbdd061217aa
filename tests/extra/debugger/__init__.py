"""Stopping and inspecting a run."""
