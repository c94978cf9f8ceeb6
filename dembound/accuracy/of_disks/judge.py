"""Errors of bonded disks: by formulas, and by companions of larger disks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, ClassVar

from dembound.accuracy.best import Best
from dembound.accuracy.cause import Causes
from dembound.accuracy.choice import Named
from dembound.accuracy.history import Motions
from dembound.accuracy.judge import Judge
from dembound.accuracy.moved_sides import Extended
from dembound.accuracy.of_disks.boxes import box_facts
from dembound.accuracy.of_disks.causes import causes_of_disks
from dembound.accuracy.of_disks.chart_choices import disk_choices
from dembound.accuracy.of_disks.exact.continuum import ExactContinuum
from dembound.accuracy.of_disks.exact.plane_wave import ExactPlaneWave
from dembound.accuracy.of_disks.extended import extended_disks
from dembound.accuracy.of_disks.search import best_of_disks
from dembound.accuracy.of_disks.seeds import cause_of_packing
from dembound.accuracy.reference import Exact
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS, require_linear
from dembound.disks.contacts.breaks import BREAK_TIME, BREAK_X, BREAK_Y
from dembound.disks.scene import DiskScene
from dembound.words import Entries

REALISATIONS = (
    "choices differ in their random packing, and every packing is another realisation of the rock: errors beside a run "
    "with one of them include the difference between realisations, which smaller disks do not remove"
)


class DiskJudge(Judge[DiskCase, DiskScene]):
    """Errors of bonded disks."""

    places: ClassVar[Mapping[str, int]] = {BREAK_X: 0, BREAK_Y: 1}
    first_break = BREAK_TIME

    def causes(self, case: DiskCase, recorded: Motions, time_step: float, work: float, most: float) -> Causes:
        """Sides, by companions; dispersion, steps, continuum and walls, by formulas."""
        require_linear(case.material.law)
        return causes_of_disks(case, recorded, time_step, work, most)

    def of_another_seed(self, case: DiskCase, recorded: Motions, work: float) -> Causes:
        """The difference from a run with the next seed; see `Judge.of_another_seed`."""
        return cause_of_packing(case, recorded, work)

    def notes(self, case: DiskCase, summary: Mapping[str, Any]) -> Iterator[str]:
        """How near the motion came to the limit of the elastic law."""
        if not LAWS[case.material.law].is_linear:
            return
        limit = summary.get("load_factor")
        if limit is None:
            yield "the elastic law is taken as given; output.load_factor = true finds up to which waves it holds"
        elif limit["factor"] is None:
            yield "the elastic law holds under waves of any size"
        else:
            yield f"the elastic law holds up to {limit['factor']:.3g} times these waves, then {limit['limit']}"

    def best(self, case: DiskCase, bound: float, kept: Sequence[str]) -> Best:
        """The cheapest disks, sides and boxes in a continuum."""
        require_linear(case.material.law)
        return best_of_disks(case, bound, kept)

    def extended(self, case: DiskCase, most: int) -> Extended:
        """The scene with more bricks beyond its sides."""
        return extended_disks(case, most)

    def exact(self, case: DiskCase) -> Exact[DiskCase] | None:
        """A plane wave, or one of the problems of `exact`; raises CaseError if loads are none of them."""
        if (plane := ExactPlaneWave.of(case)) is not None:
            return plane
        return ExactContinuum.of(case) if case.load or case.incident else None

    def chart_choices(self, case: DiskCase) -> Named:
        """Coarser disks, half the step, other sides and a box in the ground."""
        return disk_choices(case)

    def hides_sides(self, case: DiskCase) -> bool:
        """Whether it has holes, whose walls consist of disks."""
        return bool(case.hole)

    def has_input_continuum(self, case: DiskCase) -> bool:
        """Whether waves enter through a continuum round disks that fill the scene."""
        return case.ground.size is None and any(case.side(side).waves for side in case.outside_sides)

    def cautions(self, cases: Sequence[DiskCase]) -> tuple[str, ...]:
        """A warning that packings differ at random, if there are different bricks, and random ones among them."""
        packings = [case.packing for case in cases]
        bricks = {repr(packing.with_copies(1, 1).model_copy(update={"origin": (0.0, 0.0)})) for packing in packings}
        if len(bricks) < 2 or all(packing.is_lattice for packing in packings):
            return ()
        return (REALISATIONS,)

    def proposals(self, scene: DiskScene) -> Entries:
        """The smallest box of disks with a continuum round it, if it saves much."""
        return box_facts(scene) if scene.has_history or scene.ground.law.is_linear else iter(())
