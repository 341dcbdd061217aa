"""A node's replacements for modules of Python's standard library.

A module belongs here if it replaces one of the standard library, or numpy.random or psutil, which use the same clock,
entropy and process, or if those modules share it (locks, streams, the terminal, sockets).
`cfepy.nodes.stdlib.replacements` lists which function makes which name. Finding and executing modules, and processes,
belong to `cfepy.nodes`; refused modules are in `cfepy.nodes.refused_modules`.
"""
