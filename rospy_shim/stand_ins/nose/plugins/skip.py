"""nose.plugins.skip: the exception of a test that does not apply."""

from __future__ import annotations

from unittest import SkipTest

__all__ = ["SkipTest"]
