"""Randomly damaged inputs of every kind that cfepy reads. Each must be read or refused with an error of cfepy's.

`kinds` has the kinds, `damage` the ways of damaging. `python -m dev.fuzz KIND --count 10000 --seed N` runs many, each
with a time limit, all in memory. The tests run a few of each kind.
"""
