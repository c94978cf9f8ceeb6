"""The command packing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from dembound.cli.app import MORE, PICTURE, Cases, PictureTitle, Settings, Side, app, load_disks
from dembound.cli.console import out
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.boundaries.support import Edge
    from dembound.disks.scene import DiskScene


@app.command("packing", rich_help_panel=MORE)
def packing(
    cases: Cases,
    output: Annotated[Path, PICTURE] = Path("packing.png"),
    title: PictureTitle = None,
    side: Annotated[Side, typer.Option(help="Side whose particles are marked.")] = Side.right,
    brick: Annotated[bool, typer.Option("--brick", help="Show the first case's whole brick with its seams.")] = False,
    changes: Settings = None,
) -> None:
    """Draw one side of the packing of each case, or one brick (PNG)."""
    from dembound.disks.scene import build
    from dembound.plot.packing import plot_brick, plot_patterns
    from dembound.plot.style import save

    loaded = [load_disks(path, changes) for path in cases]
    if brick:
        shown = build(loaded[0]).ground.brick
        figure = plot_brick(shown.positions, shown.radii, shown.edge_rows, shown.size, shown.pairs, shown.images)
    else:
        scenes = {case.name: build(case) for case in loaded}
        figure = plot_patterns(
            {
                name: (scene.assembly.positions, scene.assembly.radii, _edge_of(scene, side.value).nodes)
                for name, scene in scenes.items()
            }
        )
    save(figure, output, title)
    out.print(f"wrote {output}")


def _edge_of(scene: DiskScene, side: str) -> Edge:
    """A side of the scene; periodic sides have no particles."""
    if side not in scene.edges:
        raise CaseError([f"--side: is {side}, which is periodic in {scene.case.name}; here: {', '.join(scene.edges)}"])
    return scene.edges[side]
