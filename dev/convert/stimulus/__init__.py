"""Run public nodes that convert with a random stimulus, on cfepy and with Debian's roscpp."""
