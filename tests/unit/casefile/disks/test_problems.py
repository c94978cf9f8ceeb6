"""Mistakes that show only when tables are looked at together."""

import pytest
from small_cases import BODY, problems_of

WAVES = "".join(f'[wave.{name}]\ntype = "constant"\namplitude = 1.0\n' for name in ("push", "shake"))
RANDOM = 'pattern = "B"\nbrick = [10.0, 5.0]\nradius_ratio = 1.5'


def problems(*tables: str, base: str = BODY) -> list[str]:
    return problems_of("".join([base, *tables]))


def side(name: str, kind: str, more: str = "") -> str:
    return f'[boundary.{name}]\ntype = "{kind}"\n{more}\n'


def test_only_a_lattice_may_have_contacts_without_stiffness() -> None:
    for key, moduli in (
        ("contact_share", "p_wave_speed = 1000.0\ncontact_share = 0.0"),
        ("emod", "emod = 0.0\npb_emod = 1e9"),
    ):
        base = BODY.replace("p_wave_speed = 1000.0", moduli)
        said = f"material.{key}: is 0, but contacts hold pattern B under stress; must be greater than 0"
        assert problems(base=base) == []
        assert problems(base=base.replace('pattern = "A"', RANDOM)) == [said]
    (line,) = problems('[motion]\nheld = ["x", "y"]\n', base=BODY.replace("1000.0", '1000.0\nmatch = "assembly"'))
    assert line.startswith("material.match: ")  # it sends no P wave


def test_waves_must_be_defined_but_need_not_be_used() -> None:
    assert problems(WAVES) == []
    assert problems(WAVES, side("left", "velocity", 'wave_p = "push"\nwave_s = "shake"')) == []
    assert problems(WAVES, side("left", "velocity", 'wave_p = "shak"\nwave_s = "q"')) == [
        'boundary.left.wave_p: "shak" is not a wave of this case; defined: push, shake (did you mean shake?)',
        'boundary.left.wave_s: "q" is not a wave of this case; defined: push, shake',
    ]
    # an invalid one counts as defined
    (line,) = problems('[wave.push]\ntype = "constant"\n', side("top", "viscous_input", 'wave_p = "push"'))
    assert line.startswith("wave.push.amplitude: ")


def test_periodic_sides_come_in_pairs() -> None:
    for one, other in (("left", "right"), ("top", "bottom")):
        here = side(one, "periodic")
        line = f'boundary.{one}.type: is "periodic", so boundary.{other} must be periodic too'
        assert problems(here, side(other, "periodic")) == []
        assert problems(here) == problems(here, side(other, "fixed")) == [line]
        # what an invalid opposite side will be is not known yet
        assert len(problems(here, side(other, "viscous", "beta_p = -1"))) == 1


def test_a_held_direction_cannot_be_driven() -> None:
    for name, key in (("left", "p"), ("top", "s")):
        driven = WAVES + side(name, "viscous_input", f'wave_{key} = "push"')
        said = f"boundary.{name}.wave_{key}: drives x, which motion.held holds for every particle"
        assert problems(driven, '[motion]\nheld = ["y", "rotation"]\n') == []
        assert problems(driven, '[motion]\nheld = ["x"]\n') == [said]


def test_half_masses_are_for_regular_edges() -> None:
    said = "boundary.right.half_mass: needs a side of disks in one row; pattern B has none"
    edged = RANDOM.replace('"B"', '"C"') + "\nedge_radius = 0.26"
    for kind, more in (("viscous", ""), ("viscoelastic_input", 'distance = 1.0\nwave_p = "push"')):
        table = WAVES + side("right", kind, more)
        for pattern, mistakes in (('pattern = "A"', []), (edged, []), (RANDOM, [said])):
            base = BODY.replace('pattern = "A"', pattern)
            assert problems(table, "half_mass = true\n", base=base) == mistakes
            assert problems(table, base=base) == []


def test_a_free_field_is_for_left_and_right_and_its_column_has_two_ends() -> None:
    for name in ("bottom", "top"):
        said = '"free_field" is for left and right; its column is vertical and as high as the body'
        assert problems(side(name, "free_field")) == [f"boundary.{name}.type: {said}"]
    assert problems(side("left", "free_field", "beta_p = 0.9")) == []
    column = side("right", "free_field")
    assert problems(column, side("left", "viscous"), side("bottom", "fixed")) == []
    assert problems(column, side("bottom", "periodic"), side("top", "periodic")) == [
        f'boundary.{name}.type: is "periodic", but the column of boundary.right needs two ends'
        for name in ("bottom", "top")
    ]


def test_the_springs_that_let_a_wave_into_a_column_are_alike() -> None:
    column, wave, source = side("right", "free_field") + WAVES, 'wave_s = "shake"\n', "source = [5.0, 50.0]"
    assert problems(column, side("bottom", "viscoelastic_input", wave + "distance = 9.0")) == []
    assert problems(column, side("bottom", "viscoelastic", source)) == []
    assert problems(column, side("left", "viscoelastic_input", wave + source)) == []
    assert problems(column, side("bottom", "viscoelastic_input", wave + source)) == [
        "boundary.bottom.source: makes springs differ along the side, and those of the column at boundary.right differ "
        "from them; give distance"
    ]


def monitors(**places: str) -> str:
    return "".join(f'[[monitor]]\nname = "{name}"\nposition = {place}\n' for name, place in places.items())


def test_monitors_may_lie_in_a_continuum() -> None:
    left = side("left", "outside")
    assert problems(left, monitors(a="[-99.5, 5]")) == []
    assert problems(left, side("bottom", "outside"), monitors(a="[-99.5, -7]")) == []
    # neither above the free surface nor beyond other sides
    places, allowed = {"a": "[-2.0, 5.5]", "b": "[11.0, 1.0]", "c": "[-2.0, -1.0]"}, "x <= 10 and 0 <= y <= 5 (m)"
    assert problems(left, monitors(**places)) == [
        f"monitor[{number}, {name}].position: is {where}, must be in the scene or its continuum, {allowed}"
        for number, (name, where) in enumerate(places.items(), start=1)
    ]
    # a side with a mistake of its own has one line
    assert len(problems(side("left", "outsid"), monitors(a="[-2, 1]"))) == 1


def test_monitor_names_are_unique_and_not_those_of_twins() -> None:
    twice = monitors(a="[0, 0]", b="[1, 1]") + monitors(a="[2, 2]")
    assert problems(twice) == ['monitor[3].name: "a" is taken by monitor[1]']
    assert problems(monitors(**{"free_field": "[0, 0]", "a.free": "[0, 0]"})) == []
    assert problems(monitors(**{"a.free_field": "[0, 0]"})) == [
        'monitor[1, a.free_field].name: is "a.free_field", must not end in ".free_field", '
        "which is kept for a monitor's twin"
    ]


def test_intervals_fit_into_the_run() -> None:
    text = "time_step = {}\n[output]\nhistory_interval = {}\nenergy_interval = {}\n"
    assert problems(text.format(0.1, 0.1, 0.1)) == []
    given = {"run.time_step": 0.2, "output.history_interval": 0.3, "output.energy_interval": 0.4}
    lines = [f"{key}: is {value}, must be at most run.duration, 0.1 (s)" for key, value in given.items()]
    assert problems(text.format(*given.values())) == lines


def test_invalid_tables_silence_only_the_checks_that_need_them() -> None:
    wrong = BODY.replace("radius = 0.25", "radius = 0").replace("duration = 0.1", "duration = 0")
    more = side("left", "periodic") + monitors(a="[99, 99]") + monitors(a="[1, 1]")
    found = problems(more, "[motion]\nheld = [1]\n[output]\nhistory_interval = 7\n", base=wrong)
    places = ["packing.radius", "motion.held", "run.duration", "boundary.left.type", "monitor[2].name"]
    assert [line.split(": ")[0] for line in found] == places


ROUND = side("left", "periodic") + side("right", "periodic")
BELOW = side("bottom", "viscous_input", 'wave_s = "w"') + ROUND
PRESCRIBED = side("bottom", "velocity", 'wave_s = "w"') + ROUND
LOAD = '[[load]]\nname = "push"\nposition = [5.0, 2.5]\nforce = [1.0, 0.0]\nwave = "w"\n'
HOLE = '[[hole]]\ntype = "circle"\nname = "h"\ncentre = [5.0, 2.5]\nradius = 1.0\n'
SURFACE = "[ground]\nsurface = [[0.0, 5.0], [4.0, 5.0], [6.0, 3.0], [10.0, 3.0]]\n" + BELOW
TWICE = BELOW.replace('_s = "w"', '_s = "w"\nwave_p = "w"')


@pytest.mark.parametrize(
    ("motion", "sides", "message"),
    [
        *((motion, BELOW, "") for motion in ("incident", "outcrop", "within")),
        ("outcrop", PRESCRIBED, "but boundary.bottom prescribes the motion within the ground"),
        ("incident", LOAD, "is for waves of sides, but this one is the factor of load[1, push]; leave it out"),
        ("within", BELOW + side("top", "viscous"), "which needs a free surface at the top"),
        ("within", BELOW + HOLE, "which needs ground without holes"),
        ("within", SURFACE, "which needs level ground up to the top of the disks, without ground.surface"),
        ("within", BELOW.replace("periodic", "viscous"), "level ground: boundary.left and boundary.right take from"),
        ("within", TWICE, "every wave_p and wave_s to name a wave of its"),
        ("within", BELOW.replace('"viscous_', '"viscoelastic_').replace("wave_s", "distance = 9.0\nwave_s"), "springs"),
    ],
)
def test_an_absorbing_side_below_a_free_surface_takes_any_motion_and_others_are_refused(motion, sides, message) -> None:
    wave = f'[wave.w]\ntype = "cosine"\namplitude = 1.0\nperiod = 0.01\nmotion = "{motion}"\n'
    found = problems(wave, sides)
    assert [line.startswith("wave.w.motion: ") for line in found] == [True] * bool(message)
    assert all(message in line for line in found)
