"""Public nodes that convert, with random stimulus, on cfepy and with Debian's roscpp beside it."""
