"""Tests of `cfepy.convert`."""
