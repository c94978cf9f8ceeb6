"""A plane of symmetry: the body goes on as its own mirror image."""

from typing import ClassVar, Literal

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves


class Symmetry(Boundary):
    """Every edge disk touches its own mirror image and is bonded to it.

    The mirror stands half a disk diameter outside the disk's centre. The image of (u_n, u_s, θ) is (−u_n, u_s, −θ):
    the elongation between the two is 2u_n, their bond bends by 2θ, and as both roll towards each other alike the
    contact does not shear. With k_n and k_b a contact's and bond's stiffness, the image pushes with −2k_n·u_n and
    −2k_b·θ. That is exact where the edge disks stand in one row, as in pattern A; elsewhere each disk has a mirror
    of its own.
    """

    is_mirror: ClassVar[bool] = True

    type: Literal["symmetry"]

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """A spring on the normal motion and one on the rotation of every edge particle."""
        normal, bending = medium.mirror_stiffness(edge.diameters)
        supports.add(edge.nodes, edge.axis, stiffness=2.0 * normal)
        supports.add(edge.nodes, 2, stiffness=2.0 * bending)
