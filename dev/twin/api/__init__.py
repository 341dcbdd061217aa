"""The API of cfepy beside NASA's: one script of calls, played by a C application on the real cFE and by its twin here.

`app/` is the C application. `script` makes random scripts. `twin` plays them on cfepy, and `real` on a real cFE that
was built with the application. `compare` finds the differences. `python -m dev.twin.api --help` runs all of it.
"""
