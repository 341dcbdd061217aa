"""cfepy beside NASA's cFE: the same inputs to both, step by step, and everything that comes out compared.

`real` boots NASA's executable in namespaces of its own; `flight` flies the same computer in both, and says what
differs; `commands` makes random ground commands from a seed, `masks` says what may differ and why. `lives` and
`lives_flight` end applications and reset the processor, `apps_flight` flies NASA's flight applications, `memory_flight`
gives three of them memory to work on, `tables_flight` has applications with tables, `api` plays
scripts of calls. Without NASA's executable the tests use answers of it that were recorded (tests/twin/data).
`python -m dev.twin --help` compares with the real one.
"""
