"""Development programs for cfepy. docs/reference/dev_programs.md lists them.

They are not part of the installed package.
"""
