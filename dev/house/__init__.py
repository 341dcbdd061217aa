"""Measure the architecture: which module imports which, the floors (layers), and the figures and pictures of both.

The modules here read the source text of a checkout without running it, so that you can compare two versions:
`python -m dev.house` prints the figures of this tree, `python -m dev.house FOLDER` those of another.
`tests/test_layers.py` checks the rules with the same functions.
"""
