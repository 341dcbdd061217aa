"""cfepy beside NASA's cFE: both get the same inputs, step by step, and all outputs are compared.

`real` boots NASA's executable in its own namespaces. `flight` flies the same computer in both, and reports the
differences. `commands` makes random ground commands from a seed. `masks` lists the fields that may differ, and why.
`lives` and `lives_flight` end applications and reset the processor. `apps_flight` flies NASA's flight applications.
`memory_flight` gives three of them memory to work on. `tables_flight` has applications with tables. `api` plays scripts
of calls. Without NASA's executable, the tests use its recorded answers (tests/twin/data).
`python -m dev.twin --help` compares with the real one.
"""
