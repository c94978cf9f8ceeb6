"""The support table of a scene: sides, loads that follow a wave, continua, and the waves that enter through these."""

from dembound.boundaries.support import Incident, SupportBuilder, Supports, Waves
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.monitor import FREE_FIELD
from dembound.disks.beyond.ground_waves import GroundWaves, rising_waves
from dembound.disks.beyond.incident import let_in, let_in_below, power_through
from dembound.disks.beyond.layered_waves import LayeredWaves, rising_in_layers
from dembound.disks.beyond.surroundings import Surroundings
from dembound.disks.body import DiskBody
from dembound.disks.loads import drive
from dembound.disks.side_media import media_of
from dembound.disks.stepping.continuum_ties import disks_on_foot


def supports_of(scene: DiskBody, waves: Waves) -> Supports:
    """The support table: rows of all sides under these waves, of all loads that follow a wave, and of continua."""
    case, builder = scene.case, SupportBuilder(held=scene.ground.held)
    for side, table in case.boundary.items():
        builder.side = side
        for edge, medium in media_of(scene, side) if side in scene.edges else ():
            table.support(edge, medium, waves, builder)
    builder.side = ""
    drive(scene, builder)
    for each in scene.continua:
        each.support(builder)
    bottom = case.side("bottom")
    if bottom.is_outside and bottom.waves:
        names = bottom.waves_by_axis(1)
        x, y = (None if name is None else waves[name] for name in names)
        _let_in_below(scene, (x, y), builder)
    if scene.outside is not None and scene.ground_waves is not None:
        let_in(scene.outside, scene.ground_waves, scene.positions, builder)
    return builder.table()


def _rising(
    case: DiskCase, beneath: Surroundings, signals: tuple[Incident | None, Incident | None], grain: float
) -> GroundWaves | LayeredWaves:
    """The motion of the ground beneath a body under waves that run straight up, as if its layer there went on above.

    They have the given velocities at the lower side of the body; with layers below it, at the top of the lowest layer.
    """
    ground, height = beneath.body.ground, beneath.box[1]
    joints = tuple(joint for joint in ground.joints if joint < beneath.body.mesh.sides[2])
    relative = [None if each is None else each.relative_modulus for each in beneath.body.mechanisms[len(joints) :: -1]]
    if not joints and not any(relative):
        return rising_waves(ground.at(height), height, signals, grain)
    media, span = ground.media[len(joints) :: -1], (min(wave.start for wave in case.wave.values()), case.run.duration)
    at = joints[0] if joints else height
    return rising_in_layers(media, joints[::-1], None, signals, at, span, grain, relative)


def _let_in_below(scene: DiskBody, signals: tuple[Incident | None, Incident | None], builder: SupportBuilder) -> None:
    """Add the waves along x and y, None for none, that enter through the continuum below to the support table.

    Beside a free-field column they enter through its foot, and the body's disks that stand on the ground below have the
    forces of their twins.
    """
    beneath = scene.outside if scene.foot is None else scene.foot
    assert beneath is not None
    waves = _rising(scene.case, beneath, signals, scene.ground.brick.mean_diameter)
    disks = disks_on_foot(scene)
    twins = disks if scene.twin is None else scene.twin[disks]
    builder.side = "bottom"
    let_in_below(beneath, waves, scene.positions, builder, (twins, disks))
    side = "bottom" if scene.foot is None else f"bottom{FREE_FIELD}"
    builder.add_power(side, power_through("bottom", beneath.body.mesh.sides, waves, beneath.body.thickness))
