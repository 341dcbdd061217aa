"""What a node sees of Python's standard library: the modules made for it, and what they stand on.

A module belongs here when it stands for one of the standard library, for numpy.random or psutil, which show the same
clock, entropy and process, or when it is an object that those modules share (locks, streams, the terminal, sockets).
`cfepy.nodes.stdlib.replacements` says which name is made by what. How modules are found and executed, and what a
process is, belongs to `cfepy.nodes`; what refuses its use is in `cfepy.nodes.refused_modules`.
"""
