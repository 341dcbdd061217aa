"""Add-ons: each folder here is one, and all the others fly without it.

What belongs here comes in through `cfepy.plugins`, with commands, options and tables of its own. What a mission needs
to fly does not. Nothing outside of this folder imports from it.
"""
