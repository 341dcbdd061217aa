"""Programs for compiled applications: NASA's own tests, NASA's recorded answers, and an emulated processor."""
