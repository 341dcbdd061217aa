"""The house measured: what imports what, which floors there are, and the figures and pictures that follow from it.

What belongs here reads the source text of a checkout and runs none of it, so that two versions can be compared:
`python -m dev.house` prints the figures of this tree, `python -m dev.house FOLDER` those of another.
`tests/test_layers.py` holds the rules with the same functions.
"""
