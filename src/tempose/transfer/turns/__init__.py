"""From the motion of the source to the rotations of the marks."""
