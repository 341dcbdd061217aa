"""Races of public software: how soon `cfepy explore` finds them in unmodified sources, before and after their fix.

The sources are not in this repository. `python -m dev.quality.public_races fetch FOLDER` gets them from GitHub.
"""
