"""Tests of reading launch files."""
