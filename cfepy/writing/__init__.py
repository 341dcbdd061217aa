"""How output is written: text without control characters, the console of the flight computer, HTML.

What belongs here makes text safe for a terminal or a page, or takes it to a stream. What is shown belongs to the
package that knows it. The central file is `cfepy/writing/escapes.py`.
"""
