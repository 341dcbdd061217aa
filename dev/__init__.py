"""Programs for those who work on cfepy; docs/reference/dev_programs.md lists them.

Nothing here is part of the package.
"""
