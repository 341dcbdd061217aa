"""Public missions and applications: build them with `cfepy build`, fly each application, and report the results.

The list is missions.json. Their code is fetched, and is no part of this repository.
"""
