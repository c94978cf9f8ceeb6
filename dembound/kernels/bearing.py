"""Springs between supported nodes and the motion of the ground beyond them, which forces at rest do not follow."""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.law import is_tie
from dembound.kernels.tables import Bearings


@njit(**FAST)
def bearing_forces(bearing, u, v, force):
    """Add to force (k, 3) of the supported nodes −K(u − u_g − rest), and store it; u : (3, n) m, v is without effect.

    u_g is the displacement of the node's twin, or the weighted mean of all nodes that have none.
    """
    node, twin, line, weight = bearing.node, bearing.twin, bearing.line, bearing.weight
    stiffness, rest, own = bearing.stiffness, bearing.rest, bearing.force
    for c in range(2):
        mean = 0.0
        for q in range(node.size):
            mean += weight[q] * u[c, U(node[q])]
        for q in range(node.size):
            beyond = u[c, U(twin[q])] if twin[q] >= 0 else mean
            f = -stiffness[q, c] * (u[c, U(node[q])] - beyond - rest[q, c])
            force[line[q], c] += f
            own[line[q], c] = f


is_tie(Bearings, across=bearing_forces)
