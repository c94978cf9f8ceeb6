"""Options of commands that test samples: their size, how they are loaded, and where they run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import Scheduler, require_one_place

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase
    from dembound.studies.laboratory.sample import Sample
    from dembound.studies.sweep.study import Options

SAMPLES = "Samples and loading"
"""Panel of the help."""


class EndsKind(StrEnum):
    """How platens hold the ends."""

    smooth = "smooth"
    grips = "grips"


@dataclass(frozen=True)
class LoadingOptions:
    """Samples, how they are loaded, and where they run."""

    width: Annotated[
        float | None,
        typer.Option(min=0.0, help="Width of the sample (m); by default the case's.", rich_help_panel=SAMPLES),
    ] = None
    height: Annotated[
        float | None,
        typer.Option(min=0.0, help="Height (m); twice a given width by default.", rich_help_panel=SAMPLES),
    ] = None
    ends: Annotated[
        EndsKind, typer.Option(help="Platens hold the normal motion only, or all.", rich_help_panel=SAMPLES)
    ] = EndsKind.smooth
    damp: Annotated[
        float, typer.Option(min=0.0, help="Local damping; strengths depend on it.", rich_help_panel=SAMPLES)
    ] = 0.7
    rate: Annotated[
        float | None,
        typer.Option(min=0.0, help="Strain rate (1/s); by default quasi-static.", rich_help_panel=SAMPLES),
    ] = None
    processes: Annotated[
        int | None, typer.Option("--processes", "-p", min=1, help="Samples at once; as many as cores by default.")
    ] = None
    scheduler: Scheduler = None

    def sample(self, case: DiskCase, test: str) -> Sample:
        """The sample of a test of the material of a case; raises CaseError as `sample_of`."""
        from dembound.studies.laboratory.sample import sample_of

        size = self.width, self.height
        return sample_of(case, test, *size, ends=self.ends.value, damp=self.damp, rate=self.rate)

    def options(self, *, anew: bool = False) -> Options:
        """Options of the sweep over seeds; raises CaseError for processes beside a scheduler."""
        from dembound.studies.sweep.study import Options

        require_one_place(self.scheduler, self.processes)
        return Options(processes=self.processes, scheduler=self.scheduler, anew=anew)

    @property
    def given(self) -> Iterator[str]:
        """Names of the options that differ from their defaults."""
        for field in fields(self):
            if getattr(self, field.name) != field.default:
                yield f"--{field.name}"
