"""Models of detail as small files."""
