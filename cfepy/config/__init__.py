"""Configuration of a platform: limits and sizes of cFE (`platform`), releases (`versions`), and `cfe.config`.

This package has the numbers and names of NASA's configuration headers, and the functions with which an application
reads them. The properties of a board are in `cfepy.psp`. The central file is `cfepy/config/platform.py`.
"""
