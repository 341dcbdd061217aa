"""The package of cv_bridge's extension module."""
