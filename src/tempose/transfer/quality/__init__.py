"""How good a transfer is: pose, distortion, volume, feet."""
