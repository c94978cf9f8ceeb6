"""Samples: a packing of the case's disks in the size of the sample, and the case of its test as text."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, cast, get_args

import tomli_w

from dembound.boundaries import SIDES
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import STRENGTH_KEYS
from dembound.casefile.reader import parsed
from dembound.casefile.tables import ParaView
from dembound.casefile.types import LAWS
from dembound.disks.scene import ground_of
from dembound.errors import CaseError
from dembound.kinds import loads
from dembound.packings.base import DensePacking, Packing
from dembound.results.recording import TestName
from dembound.studies.asked import USUAL_LOADING, Ends, Loading
from dembound.words import with_unit

LAW = "linearpbond"
"""The law of a sample whose case has one without strength."""

MOST_OWN = 20_000
"""Disks of a case above which the size of the sample must be given."""

LOW = {"ucs": 0.9, "biaxial": 0.9, "tension": 0.25, "brazilian": 0.4}
"""Peak over the smaller strength of the bonds, as low as it has been measured; of a Brazilian test with the larger
strain below its jaws."""

COHESIVE = 0.6
"""Power of `pb_coh` over `pb_ten` above 1 with which compressive strengths grow at least if `pb_mcf` = 0."""

HIGHEST = 8.0
"""Strain up to which a sample is loaded at most, over the one that `LOW` gives."""

QUASI_STATIC = 15.0
"""Travel times of a P wave through the height within which the peak is reached no sooner: inertia then adds nothing."""

SLOWER = 4.0
"""Travel times of tests over `QUASI_STATIC`: at 1.2 compressive strengths are 5 % higher."""

RISE = 5.0
"""Travel times during which platens gain their speed, so that they send no wave."""

JAW, LEAST_JAW = 1.0 / 7.0, 3.0
"""Width of the jaws of a Brazilian test over the diameter of the sample, an arc of 16°; at least, in mean disks."""

SNAPSHOTS = 75
"""Snapshots of a test that goes on for `HIGHEST`; most end after a third of it. Twice as many change E by 0.1 %."""

AT_REST = 3e-4
"""Unbalanced force at which a sample under pressure is at rest: an outer disk that comes off leaves up to 1e-4."""

PEAK_SHARE = 0.6
"""Share of its peak to which the force falls before a test ends."""

NARROW = 10.0
"""Mean disks in the width of a random sample below which a few bonds decide on its strength."""

LIKELY = (1e-5, 0.1)
"""Strains at the peak of brittle materials; others are of a wrong unit of the strengths."""

COUNTED = ("title", "packing", "material", "run")
"""Tables of a case that count for its sample, and one that every case must have."""


@dataclass(frozen=True)
class Sample:
    """A sample and how it is loaded.

    Attributes
    ----------
    case : whose packing and material it has. test : its name. width, height : m; of a Brazilian test both are the
    diameter.
    ends, damp : of the platens and of the run. given_rate : strain rate, 1/s; None: slow enough for `peak_strain`.
    """

    case: DiskCase
    test: TestName
    width: float
    height: float
    ends: Ends = Loading.ends
    damp: float = Loading.damp
    given_rate: float | None = None

    @property
    def packing(self) -> dict[str, Any]:
        """The table of its packing, one brick of its size."""
        own = self.case.packing
        kept = {key: value for key, value in own.given().items() if key not in ("bricks", "origin")}
        size = {"size": [self.width, self.height]}
        return kept | size | ({"brick": [self.width, self.height]} if isinstance(own, DensePacking) else {})

    @property
    def material(self) -> dict[str, Any]:
        """The table of its material, with a law whose bonds break."""
        own = self.case.material
        given = {key: value for key, value in own.given().items() if key != "quality_factor"}
        law = own.law if LAWS[own.law].has_history else LAW
        return given | {"law": law, "damp": self.damp}

    def seeded(self, by: int) -> dict[str, Any]:
        """The table of its packing with a seed larger by a number; raises CaseError for a packing without seeds."""
        if by == 0:
            return self.packing
        packing = self.case.packing.reseeded(by)
        if packing is None:
            raise CaseError(["--seeds: all samples of this pattern are the same; give --seeds 1, or pattern B or C"])
        return replace(self, case=replace(self.case, packing=packing)).packing

    @cached_property
    def elastic(self) -> tuple[float, float, float]:
        """Modulus E (Pa) along y and Poisson's ratio between free sides, and c_p along y (m/s), homogenised."""
        material = {key: value for key, value in self.material.items() if key != "locked_in"}  # needs [static]
        tables = tomli_w.dumps({"packing": self.packing, "material": material, "run": {"duration": 1.0}})
        case = loads(tables, self.case.folder, self.case.name)
        assert isinstance(case, DiskCase)
        ground = ground_of(case)
        tensor = ground.material_tensor
        c11, c22, c12 = tensor[0, 0], tensor[1, 1], 0.5 * (tensor[0, 1] + tensor[1, 0])
        return float(c22 - c12**2 / c11), float(c12 / c11), ground.wave_speeds(1)[0]

    @property
    def travel_time(self) -> float:
        """Time (s) that a P wave needs through its height."""
        return self.height / self.elastic[2]

    @property
    def peak_strain(self) -> float:
        """A strain at which the peak is not yet reached, from the strength of the bonds."""
        return LOW[self.test] * self._weakest * self._stronger / self.elastic[0]

    @property
    def _stronger(self) -> float:
        """How much larger compressive strengths are as not all of the moment counts in the stress of bonds, or less."""
        own = self.case.material
        if self.test not in ("ucs", "biaxial") or own.pb_ten is None or own.pb_coh is None:
            return 1.0
        return float(max(own.pb_coh / own.pb_ten, 1.0) ** (COHESIVE * (1.0 - own.pb_mcf)))

    @property
    def rate(self) -> float:
        """Strain rate at which the platens move, 1/s."""
        return self.given_rate or self.peak_strain / (SLOWER * QUASI_STATIC * self.travel_time)

    def rate_limit(self, peak_strain: float) -> float:
        """Strain rate (1/s) below which inertia adds nothing to a peak at this strain."""
        return peak_strain / (QUASI_STATIC * self.travel_time)

    def strain_at(self, time: float) -> float:
        """Strain between the platens at a time (s) of the run."""
        return self.rate * max(time - 0.5 * RISE * self.travel_time, 0.0)

    @property
    def duration(self) -> float:
        """Time (s) after which a test ends at the latest."""
        return HIGHEST * self.peak_strain / self.rate + RISE * self.travel_time

    @property
    def warnings(self) -> Iterator[str]:
        """What makes its numbers doubtful before any test: few disks, strengths that do not go with the moduli."""
        across = self.width / (2.0 * self.case.packing.radius)
        if across < NARROW and self.case.packing.reseeded(1) is not None:
            yield f"the sample is {across:.3g} diameters across, of which single bonds decide; take {NARROW:g} or more"
        if not LIKELY[0] < self.peak_strain < LIKELY[1]:
            yield (
                f"material: pb_ten and pb_coh of {with_unit(self._weakest, 'Pa')} go with a strain of "
                f"{self.peak_strain:.1g} at the peak, where rocks have 1e-4 to 1e-2; both are in Pa"
            )

    @property
    def _weakest(self) -> float:
        """The smaller strength of the bonds, Pa."""
        return min(value for key in STRENGTH_KEYS if (value := getattr(self.case.material, key)) is not None)

    @property
    def in_words(self) -> str:
        """Size, disks, ends, damping and rate in words."""
        diameter = 2.0 * self.case.packing.radius
        across, up = self.width / diameter, self.height / diameter
        width, height = with_unit(self.width, "m"), with_unit(self.height, "m")
        round_one = f"disk of {width}, {across:.3g} diameters"
        size = round_one if self.test == "brazilian" else f"{width} × {height}, {across:.3g} × {up:.3g} diameters"
        return f"{size}; {self.ends} ends, damp {self.damp:g}, strain rate {self.rate:.3g} 1/s"

    def text(self, by: int = 0, pressure: float = 0.0) -> str:
        """The case of the test with another seed, as TOML; pressure : Pa at the sides.

        Only that of the first seed has a file for ParaView.

        Raises CaseError as `seeded`.
        """
        loading = self._loading(pressure, "none" if by else "vtkhdf")
        tables = tomli_w.dumps({"packing": self.seeded(by), "material": self.material})
        return "\n".join([f'title = "{self._title(by, pressure)}"', "", tables, *loading, ""])

    def _title(self, by: int, pressure: float) -> str:
        words = {
            "ucs": "Uniaxial compression",
            "tension": "Direct tension",
            "brazilian": "Brazilian test",
            "biaxial": f"Compression under {with_unit(pressure, 'Pa')}",
        }[self.test]
        return f"{words}, seed {self.seeded(by).get('seed', 0)}"

    def _loading(self, pressure: float, paraview: ParaView) -> Iterator[str]:
        """Lines of the tables that load the sample; paraview : its files for ParaView."""
        packing = self.case.packing
        if self.test == "brazilian":
            half = f"{0.5 * self.width:.9g}"
            yield from ("[[hole]]  # the sample is round", 'type = "circle"', 'name = "sample"')
            yield from (f"centre = [{half}, {half}]", f"radius = {half}", 'keep = "inside"', "")
        if pressure > 0.0:
            yield from ("[[load]]  # a membrane, before the test and during it", 'name = "membrane"')
            yield from (f"pressure = {pressure:.6g}", f"sides = {list(SIDES)}".replace("'", '"'), "")
            yield from (
                "[static]  # at rest under this pressure",
                f"ratio = {AT_REST:g}  # as single disks may come off",
            )
            yield ""
        elif self.case.material.locked_in is not None:
            yield from ("[static]  # the packing's own stress comes to rest", "")
        jaw = 0.5 * max(JAW * self.width, LEAST_JAW * 2.0 * packing.radius)
        for side in ("bottom", "top"):
            yield from (f"[boundary.{side}]", 'type = "velocity"', f'wave_p = "{side}"')
            if self.ends == "smooth":
                yield 'hold = ["normal"]  # smooth platens; both components without this line'
            if self.test == "brazilian":
                yield f"within = [{0.5 * self.width - jaw:.9g}, {0.5 * self.width + jaw:.9g}]  # the jaw"
            yield ""
        sense = -1.0 if self.test == "tension" else 1.0
        speed = 0.5 * sense * self.rate * self.height
        for side, velocity in (("bottom", speed), ("top", -speed)):
            yield from (f"[wave.{side}]", 'type = "constant"', f"amplitude = {velocity:.6g}  # m/s")
            yield from (f"rise = {RISE * self.travel_time:.6g}  # s", "")
        yield from ("[run]", f"duration = {self.duration:.6g}  # s, at most")
        yield from ('until = "peak"', f"peak_share = {PEAK_SHARE}", "")
        yield from ("[output]", f"snapshots = {SNAPSHOTS}", f'paraview = "{paraview}"', "pictures = false")


def sample_of(case: DiskCase, test: str, loading: Loading = USUAL_LOADING) -> Sample:
    """A sample of the material of a case; test : a `TestName`. loading : with the size of the case's disks by default.

    A given width makes it twice as high; a Brazilian sample is round, of this width. Lengths of lattices are rounded to
    whole cells.

    Raises CaseError for a material without strength or moduli of its own, a case of too many disks without a width, and
    invalid numbers.
    """
    width, height, ends, damp, rate = loading.width, loading.height, loading.ends, loading.damp, loading.rate
    for option, word, words in (("test", test, get_args(TestName)), ("--ends", ends, get_args(Ends))):
        if word not in words:
            raise CaseError([f"{option}: is {word}, must be one of {', '.join(words)}"])
    for option, value in (("--width", width), ("--height", height), ("--rate", rate)):
        if value is not None and not 0.0 < value < math.inf:
            raise CaseError([f"{option}: is {value:g}, must be more than 0"])
    packing = case.packing
    if all(getattr(case.material, key) is None for key in STRENGTH_KEYS):
        raise CaseError(["material: has no strength, so no bond breaks; give pb_ten and pb_coh"], case.name)
    if lacking := [key for key in case.material.given() if key not in parsed(case.text).get("material", {})]:
        given = " ".join(f"--set material.{key}={getattr(case.material, key):g}" for key in lacking)
        raise CaseError([f"material: a sample has no layers; give what only layers have, such as {given}"], case.name)
    if width is None and packing.expected_disks > MOST_OWN:
        said = f"is missing, and the case has {packing.expected_disks:,.0f} disks; give the width of the sample (m)"
        raise CaseError([f"--width: {said}, such as --width {80.0 * packing.radius:.3g}, 40 diameters"], case.name)
    across = packing.extent[0] if width is None else width
    if test == "brazilian" and height is not None:
        raise CaseError(["--height: is not of a brazilian test, whose sample is round; give --width"])
    up = height or (packing.extent[1] if width is None else 2.0 * across)
    if test == "brazilian":
        up = across
    if not isinstance(packing, DensePacking):
        across, up = (_whole(packing, axis, length) for axis, length in enumerate((across, up)))
    return Sample(case, cast("TestName", test), across, up, ends, damp, rate)


def _whole(packing: Packing, axis: int, length: float) -> float:
    """The length (m) of whole bricks along an axis that is nearest to a length."""
    part = packing.brick_size[axis]
    return float(f"{max(round(length / part), 1) * part:.12g}")


def ignored(case: DiskCase) -> list[str]:
    """The tables of a case that do not count for its sample; [run], which every case has, goes without saying."""
    return [name for name in parsed(case.text) if name not in COUNTED]
