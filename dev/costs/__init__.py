"""The cost of each test: the table of tests that the quick loop leaves out, and the programs that measure it."""
