"""The documentation's commands, executed as a reader would."""
