"""How output is written: text without control characters, the console of the flight computer, HTML.

Code that makes text safe for a terminal or a page, or writes it to a stream, belongs here. The content of the output
belongs to the packages that have the data. The central file is `cfepy/writing/escapes.py`.
"""
