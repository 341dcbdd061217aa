"""The part of nose.plugins that tests import."""
