"""Images of nodes in C++ for computers that cfepy does not run on: what they take of memory, and a run in an emulator."""
