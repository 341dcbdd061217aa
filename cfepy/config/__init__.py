"""Configuration of a platform: limits and sizes of cFE (`platform`), releases (`versions`), and `cfe.config`.

Numbers and names of NASA's configuration headers belong here, and the functions with which an application reads them.
The properties of a board are in `cfepy.psp`. The central file is `cfepy/config/platform.py`.
"""
