"""Measurements of cfepy: `python -m benchmarks`. Figures are for comparing within one run, on one machine."""
