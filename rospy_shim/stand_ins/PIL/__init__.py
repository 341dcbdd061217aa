"""A stand-in for Pillow, with which rosbridge packs messages into PNG pictures; see `PIL.Image`."""
