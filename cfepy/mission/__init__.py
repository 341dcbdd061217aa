"""A mission: reading, checking, wiring and running it, and its numbers at the end."""

from __future__ import annotations

from cfepy.mission.mission import Mission
from cfepy.mission.spec import MissionSpec, read_mission, shipped_missions

__all__ = ["Mission", "MissionSpec", "read_mission", "shipped_missions"]
