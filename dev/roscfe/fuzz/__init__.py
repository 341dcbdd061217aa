"""Damaged packets of everything that the interface library reads from the bus, under sanitizers.

    python -m dev.roscfe.fuzz                                  # a million packets of each area, in each profile
    python -m dev.roscfe.fuzz topics reports --packets 5000 --seed 7 --profile strict

A node takes over the packets in one process with a stand-in of cFE. They are valid packets of an area, most of them
with one fault or more, in an order that the seed decides. The library must neither read outside of its memory, nor end
the node, nor keep memory.
"""
