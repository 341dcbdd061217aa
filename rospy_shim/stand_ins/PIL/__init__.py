"""A stand-in for Pillow, which rosbridge packs messages into PNG pictures with; see `PIL.Image`."""
