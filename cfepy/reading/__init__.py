"""How input is read: files of a bounded size, YAML and XML with the line of each field, and hints for what is misspelt.

What belongs here knows files and texts, and none of their meanings. What a mission file says does not: that is
`cfepy.mission`. The central file is `cfepy/reading/input_files.py`.
"""
