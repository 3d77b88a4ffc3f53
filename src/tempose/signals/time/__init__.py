"""The time signal f: a curve through the pose plane, and the clock along it."""
