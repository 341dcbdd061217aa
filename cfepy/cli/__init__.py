"""The command `cfepy`: it reads the command line, flies or reads what the user names, and shows the result.

What belongs here reads options, prints text, and chooses exit statuses, in rooms that follow the groups of `cfepy
--help`. What a program could use without a command line belongs to the package that it is about. The central file is
`cfepy/cli/main.py`.
"""
