"""Fields of a continuum at given displacements."""

import numpy as np

from dembound.outside.body import GridBody


def stress(body: GridBody, displacement: np.ndarray) -> np.ndarray:
    """Stress (n, 3) Pa of every node: σ_xx, σ_yy, σ_xy at displacements (2, n) m, tension positive.

    The mean of that of its elements, weighted by area; in layers without memories.
    """
    mesh = body.mesh
    derivative = mesh.rule.derivative
    u = displacement[:, mesh.nodes]  # (2, E, N, N) by row and column
    steeper_x, steeper_y = 2.0 / mesh.element_sizes.T[:, :, None, None]
    along_x = steeper_x * np.einsum("ik,cejk->ceji", derivative, u)
    along_y = steeper_y * np.einsum("jk,ceki->ceji", derivative, u)
    strain = np.stack([along_x[0], along_y[1], along_y[0] + along_x[1]])
    each = np.einsum("ab,beji->aeji", body.medium.matrix, strain)
    node, weights = mesh.nodes.ravel(), mesh.quadrature.ravel()
    return np.stack([np.bincount(node, weights * row.ravel(), mesh.count) / mesh.areas for row in each], axis=1)
