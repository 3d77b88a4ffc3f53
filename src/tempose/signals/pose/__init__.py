"""The pose signal g: from the plane of poses to shape coordinates; where the frames lie in that plane."""
