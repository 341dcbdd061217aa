"""A stand-in for PyCryptodomex, which rosbag's original source imports for encrypted bags."""
