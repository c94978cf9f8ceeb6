"""Errors of bonded disks: by formulas, and by companions of larger disks."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from dembound.accuracy.cause import Causes, Truth
from dembound.accuracy.choice import Named
from dembound.accuracy.history import Motions
from dembound.accuracy.judge import Judge
from dembound.accuracy.moved_sides import Extended
from dembound.accuracy.of_disks.advice import advice_for_disks
from dembound.accuracy.of_disks.causes import causes_of_run, quick_causes
from dembound.accuracy.of_disks.chart_choices import disk_choices
from dembound.accuracy.of_disks.exact.continuum import ExactContinuum
from dembound.accuracy.of_disks.exact.layered_column import ExactLayeredColumn
from dembound.accuracy.of_disks.exact.plane_wave import ExactPlaneWave
from dembound.accuracy.of_disks.extended import extended_disks
from dembound.accuracy.of_disks.formulas import Formulas
from dembound.accuracy.of_disks.rest import causes_of_rest
from dembound.accuracy.of_disks.seeds import cause_of_packing
from dembound.accuracy.proposal import Advice, Receiver
from dembound.accuracy.reference import Exact
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS, require_linear
from dembound.disks.contacts.breaks import BREAK_TIME
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.kinds import with_changes

REALISATIONS = (
    "choices differ in their random packing, and every packing is another realisation of the rock: errors beside a run "
    "with one of them include the difference between realisations, which smaller disks do not remove"
)


class DiskJudge(Judge[DiskCase, DiskScene]):
    """Errors of bonded disks."""

    first_break = BREAK_TIME

    def causes(self, case: DiskCase, recorded: Motions, time_step: float, work: float, most: float) -> Causes:
        """Errors of sides, from companions; of dispersion, steps, continuum and walls, by formulas."""
        require_linear(case.material.law)
        return causes_of_run(case, recorded, time_step, work, most)

    def truth(self, case: DiskCase) -> Truth:
        """The default truth: "disks" where the packing is random or bonds may break, else "rock"."""
        is_grid = case.packing.is_lattice and not LAWS[case.material.law].has_history
        return "rock" if is_grid else "disks"

    def of_other_seeds(self, case: DiskCase, motions: Motions, seeds: int) -> Causes:
        """The scatter of runs with several seeds; see `Judge.of_other_seeds`."""
        return cause_of_packing(case, motions, seeds)

    def at_start(self, case: DiskCase, recorded: Motions, summary: Mapping[str, Any]) -> Causes:
        """Errors by what the static stage left out of balance."""
        static = summary["static"]
        return Causes([]) if static is None else causes_of_rest(build(case), recorded, static)

    def notes(self, case: DiskCase, summary: Mapping[str, Any]) -> Iterator[str]:
        """A line on the ratio of the motion to the limit of the elastic law; damped ground has no load factor."""
        if not LAWS[case.material.law].is_linear:
            return
        limit = summary.get("load_factor")
        if limit is None:
            found = "; output.load_factor = true finds up to which waves it holds" if _takes_load_factor(case) else ""
            yield f"the elastic law is taken as given{found}"
        elif limit["factor"] is None:
            yield "the elastic law holds under waves of any size"
        else:
            yield f"the elastic law holds up to {limit['factor']:.3g} times these waves, then {limit['limit']}"

    def advise(
        self,
        case: DiskCase,
        bounds: Sequence[float],
        of: Truth,
        kept: Sequence[str],
        longest: float | None,
        receiver: Receiver,
    ) -> Advice:
        """The cheapest disks, sides and boxes in a continuum."""
        require_linear(case.material.law)
        return advice_for_disks(case, bounds, of, kept, longest, receiver)

    def extended(self, case: DiskCase, most: int) -> Extended:
        """The scene with more bricks beyond its sides."""
        return extended_disks(case, most)

    def exact(self, case: DiskCase) -> Exact[DiskCase] | None:
        """Plane waves, or one of the problems of `exact`; raises CaseError if the loads match none of them."""
        if (plane := ExactPlaneWave.of(case) or ExactLayeredColumn.of(case)) is not None:
            return plane
        return ExactContinuum.of(case) if case.load or case.incident else None

    def chart_choices(self, case: DiskCase) -> Named:
        """Coarser disks, half the step, other sides and a box in the ground."""
        return disk_choices(case)

    def hides_sides(self, case: DiskCase) -> bool:
        """Whether the case has holes, whose walls consist of disks."""
        return bool(case.hole)

    def has_input_continuum(self, case: DiskCase) -> bool:
        """Whether waves enter through a continuum round disks that fill the scene."""
        return case.ground.size is None and any(case.side(side).waves for side in case.outside_sides)

    def cautions(self, cases: Sequence[DiskCase]) -> tuple[str, ...]:
        """A warning that packings differ at random, if bricks differ and some are random."""
        packings = [case.packing for case in cases]
        bricks = {repr(packing.with_copies(1, 1).model_copy(update={"origin": (0.0, 0.0)})) for packing in packings}
        if len(bricks) < 2 or all(packing.is_lattice for packing in packings):
            return ()
        return (REALISATIONS,)

    def of_reference(self, case: DiskCase, motions: Motions, time_step: float) -> Causes:
        """All causes known by formula: dispersion, steps, walls, disks near loads, sides that waves enter through."""
        plane = {
            name: replace(own, values={q: v[:, :2] for q, v in own.values.items()}) for name, own in motions.items()
        }
        return Causes(Formulas(build(case), time_step).causes(plane), motions=plane)

    def quick(self, scene: DiskScene) -> Causes:
        """The continuum and walls by formula."""
        return quick_causes(scene)


def _takes_load_factor(case: DiskCase) -> bool:
    """Whether a case may ask for its load factor."""
    try:
        with_changes(case, {"output.load_factor": True})
    except CaseError:
        return False
    return True
