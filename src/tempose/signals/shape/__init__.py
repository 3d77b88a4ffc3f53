"""The shape signal h: a linear subspace of a shape space."""
