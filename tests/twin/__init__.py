"""cfepy beside NASA's cFE: the same inputs to both, step by step, and everything that comes out compared.

`real` boots NASA's executable in namespaces of its own; `simulated` flies the same computer in cfepy; `steps` makes
random ground commands from a seed; `compare` says what differs, `masks` what may and why. Without NASA's executable the
tests use answers of it that were recorded (tests/twin/data). `python -m tests.twin --help` compares with the real one.
"""
