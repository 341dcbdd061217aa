"""What a platform is configured to: limits and sizes of cFE (`platform`), releases (`versions`), and `cfe.config`.

What belongs here are numbers and names that NASA's configuration headers have, and the functions by which an
application asks for them. What a board has is in `cfepy.psp`. The central file is `cfepy/config/platform.py`.
"""
