"""What all tests share: Hypothesis without a deadline in wall-clock time, so that a busy machine fails nothing."""

from __future__ import annotations

from hypothesis import settings

pytest_plugins = ["pytester", "cfepy.testing.plugin"]  # the latter has this name when it is installed, too

settings.register_profile("cfepy", settings.default, deadline=None)
settings.load_profile("cfepy")
