"""How input is read: files of limited size, YAML and XML with the line of each field, and hints for misspelt names.

Code that handles files and texts without knowing their meaning belongs here. The meaning of a mission file, for
example, is in `cfepy.mission`. The central file is `cfepy/reading/input_files.py`.
"""
