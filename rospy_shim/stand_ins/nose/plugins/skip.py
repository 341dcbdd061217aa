"""nose.plugins.skip: what a test raises that does not apply."""

from __future__ import annotations

from unittest import SkipTest

__all__ = ["SkipTest"]
