"""Images of nodes in C++ for computers that cfepy does not run on: their sizes, and runs in an emulator."""
