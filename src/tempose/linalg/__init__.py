"""Linear algebra that is factorised once and solved often."""

from tempose.linalg.cholesky import SparseCholesky
from tempose.linalg.dirichlet import harmonic_extension

__all__ = ["SparseCholesky", "harmonic_extension"]
