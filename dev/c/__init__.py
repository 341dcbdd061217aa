"""Programs about compiled applications: NASA's own tests, NASA's answers, another kind of processor."""
