"""Dictionaries of C applications: their packets, commands and tables by name, from where they are declared first.

What reads and writes electronic data sheets, text files of COSMOS, XTCE and debug data belongs here. The ground tools
that use the names are in `cfepy.ground`. The central file is `cfepy/extra/dictionaries/packets.py`.
"""
