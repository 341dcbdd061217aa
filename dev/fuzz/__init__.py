"""Inputs damaged at random, of every kind that cfepy reads: each is read or refused with an error of its own.

`kinds` has the kinds, `damage` the ways of damaging. `python -m dev.fuzz KIND --count 10000 --seed N` does many, each
bounded in time, all in memory; the tests do a few of each kind.
"""
