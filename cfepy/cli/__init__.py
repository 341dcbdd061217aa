"""The command `cfepy`: it reads the command line, flies or reads the files that the user names, and shows the result.

A module belongs here if it reads options, prints text or chooses exit statuses; subpackages follow the groups of `cfepy
--help`. Code that a program could use without a command line belongs to the package of its subject. The central file is
`cfepy/cli/main.py`.
"""
