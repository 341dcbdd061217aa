"""What all tests share: Hypothesis without a deadline in wall-clock time, so that a busy machine fails nothing."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("cfepy", settings.default, deadline=None)
settings.load_profile("cfepy")
