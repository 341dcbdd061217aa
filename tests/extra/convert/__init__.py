"""Tests of `cfepy.extra.convert`."""
