"""Programs for the interface library: probes beside roscpp, messages to C++ and back."""
