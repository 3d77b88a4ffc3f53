"""Which places of the source move which places of the target."""
