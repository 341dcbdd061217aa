"""What each test costs: the table that says which tests the quick loop leaves out, and what measures for it."""
