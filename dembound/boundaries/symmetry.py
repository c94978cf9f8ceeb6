"""A plane of symmetry: the body continues beyond the side as its mirror image."""

from typing import ClassVar, Literal, Self

from dembound.boundaries.boundary import Boundary, Place
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves


class Symmetry(Boundary):
    """The body continues as its mirror image: each disk of the side is bonded to its own image.

    Notes
    -----
    The mirror plane is half a disk diameter outside the disk's centre, or half the distance of equal disks of the
    packing straight across the side (disks/material/constants.py). The image of (u_n, u_s, θ) is (−u_n, u_s, −θ):
    the elongation between the two is 2u_n, their bond bends by 2θ, and as both rotate by opposite angles the contact
    does not shear. With k_n and k_b the normal and bending stiffness of contact and bond, the force of the image is
    −2k_n·u_n and its moment −2k_b·θ. This is exact where the edge disks form one row, as in pattern A; elsewhere each
    disk has its own mirror plane. A disk that another side cuts in half has half a contact with its image.
    """

    is_mirror: ClassVar[bool] = True

    type: Literal["symmetry"]

    def equal_supports(self, own: Place, other: Place) -> Self:
        """The side itself, as its springs are those of the contacts."""
        return self

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """A spring on the normal motion and one on the rotation of every edge particle."""
        normal, bending = medium.mirror_stiffness(edge.diameters)
        supports.add(edge.nodes, edge.axis, stiffness=2.0 * edge.shares * normal)
        supports.add(edge.nodes, 2, stiffness=2.0 * edge.shares * bending)
