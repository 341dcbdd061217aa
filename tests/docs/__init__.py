"""The documentation's commands, given as its readers give them."""
