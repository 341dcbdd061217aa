"""The command `cfepy`: running, checking and starting missions. It stands on everything else, and nothing on it."""
