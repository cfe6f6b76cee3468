"""The version of the package, with the native part and without."""

VERSION = "0.1.0"
