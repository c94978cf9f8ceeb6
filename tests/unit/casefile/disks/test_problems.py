"""Mistakes that show only when tables are looked at together."""

from small_cases import BODY, problems_of

WAVES = '[wave.push]\ntype = "constant"\namplitude = 1.0\n[wave.shake]\ntype = "constant"\namplitude = 1.0\n'


def problems(extra: str, base: str = BODY) -> list[str]:
    return problems_of(base + extra)


def side(name: str, kind: str, more: str = "") -> str:
    return f'[boundary.{name}]\ntype = "{kind}"\n{more}\n'


def test_only_a_lattice_may_have_contacts_without_stiffness() -> None:
    for key, moduli in (
        ("contact_share", "p_wave_speed = 1000.0\ncontact_share = 0.0"),
        ("emod", "emod = 0.0\npb_emod = 1e9"),
    ):
        base = BODY.replace("p_wave_speed = 1000.0", moduli)
        random = base.replace('pattern = "A"', 'pattern = "B"\nbrick = [10.0, 5.0]\nradius_ratio = 1.5')
        assert problems("", base) == []
        assert problems("", random) == [
            f"material.{key}: is 0, but contacts hold pattern B under stress; must be greater than 0"
        ]
    (line,) = problems('[motion]\nheld = ["x", "y"]\n', BODY.replace("1000.0", '1000.0\nmatch = "assembly"'))
    assert line.startswith("material.match: ")  # it sends no P wave


def test_waves_must_be_defined_but_need_not_be_used() -> None:
    assert problems(WAVES) == []
    assert problems(WAVES + side("left", "velocity", 'wave_p = "push"\nwave_s = "shake"')) == []
    assert problems(WAVES + side("left", "velocity", 'wave_p = "shak"\nwave_s = "q"')) == [
        'boundary.left.wave_p: "shak" is not a wave of this case; defined: push, shake (did you mean shake?)',
        'boundary.left.wave_s: "q" is not a wave of this case; defined: push, shake',
    ]
    entered = side("top", "viscous_input", 'wave_p = "push"')
    (line,) = problems('[wave.push]\ntype = "constant"\n' + entered)  # invalid, it counts as defined
    assert line.startswith("wave.push.amplitude: ")


def test_periodic_sides_come_in_pairs() -> None:
    for one, other in (("left", "right"), ("top", "bottom")):
        line = f'boundary.{one}.type: is "periodic", so boundary.{other} must be periodic too'
        assert problems(side(one, "periodic") + side(other, "periodic")) == []
        assert problems(side(one, "periodic")) == [line]
        assert problems(side(one, "periodic") + side(other, "fixed")) == [line]
        # what an invalid opposite side will be is not known yet
        assert len(problems(side(one, "periodic") + side(other, "viscous", "beta_p = -1"))) == 1


def test_a_held_direction_cannot_be_driven() -> None:
    for name, key, x in (("left", "p", "x"), ("top", "s", "x")):
        driven = WAVES + side(name, "viscous_input", f'wave_{key} = "push"')
        other = {"x": "y", "y": "x"}[x]
        assert problems(driven + f'[motion]\nheld = ["{other}", "rotation"]\n') == []
        assert problems(driven + f'[motion]\nheld = ["{x}"]\n') == [
            f"boundary.{name}.wave_{key}: drives {x}, which motion.held holds for every particle"
        ]


def test_half_masses_are_for_regular_edges() -> None:
    random = 'pattern = "B"\nradius_ratio = 1.5\nbrick = [5.0, 5.0]'
    edged = random.replace('"B"', '"C"') + "\nedge_radius = 0.26"
    for kind, more in (("viscous", ""), ("viscoelastic_input", 'distance = 1.0\nwave_p = "push"')):
        table = WAVES + side("right", kind, more)
        for pattern, mistakes in (
            ('pattern = "A"', []),
            (edged, []),
            (random, ["boundary.right.half_mass: needs a side of disks in one row; pattern B has none"]),
        ):
            text = BODY.replace('pattern = "A"', pattern)
            assert problems(table + "half_mass = true\n", text) == mistakes
            assert problems(table, text) == []


def test_a_free_field_is_for_left_and_right_and_its_column_has_two_ends() -> None:
    for name in ("bottom", "top"):
        assert problems(side(name, "free_field")) == [
            f'boundary.{name}.type: "free_field" is for left and right; its column is vertical and as high as the body'
        ]
    left = side("left", "free_field", "beta_p = 0.9")
    assert problems(left) == []
    around = side("bottom", "periodic") + side("top", "periodic")
    assert problems(side("right", "free_field") + side("left", "viscous") + side("bottom", "fixed")) == []
    assert problems(side("right", "free_field") + around) == [
        f'boundary.{name}.type: is "periodic", but the column of boundary.right needs two ends'
        for name in ("bottom", "top")
    ]


def test_the_springs_that_let_a_wave_into_a_column_are_alike() -> None:
    column = side("right", "free_field") + WAVES
    wave, source = 'wave_s = "shake"\n', "source = [5.0, 50.0]"

    assert problems(column + side("bottom", "viscoelastic_input", wave + "distance = 9.0")) == []
    assert problems(column + side("bottom", "viscoelastic", source)) == []
    assert problems(column + side("left", "viscoelastic_input", wave + source)) == []
    assert problems(column + side("bottom", "viscoelastic_input", wave + source)) == [
        "boundary.bottom.source: makes springs differ along the side, and those of the column at boundary.right differ "
        "from them; give distance"
    ]


def monitor(name: str, position: str) -> str:
    return f'[[monitor]]\nname = "{name}"\nposition = {position}\n'


def test_monitors_may_lie_in_a_continuum() -> None:
    left, base = '[boundary.left]\ntype = "outside"\n', '[boundary.bottom]\ntype = "outside"\n'

    assert problems(left + monitor("a", "[-99.5, 5]")) == []
    assert problems(left + base + monitor("a", "[-99.5, -7]")) == []
    # neither above the free surface nor beyond other sides
    allowed = "in the scene or its continuum, x <= 10 and 0 <= y <= 5 (m)"
    assert problems(left + monitor("a", "[-2, 5.5]") + monitor("b", "[11, 1]") + monitor("c", "[-2, -1]")) == [
        f"monitor[{place}].position: is {where}, must be {allowed}"
        for place, where in (("1, a", "[-2.0, 5.5]"), ("2, b", "[11.0, 1.0]"), ("3, c", "[-2.0, -1.0]"))
    ]
    # a side with a mistake of its own has one line
    assert len(problems('[boundary.left]\ntype = "outsid"\n' + monitor("a", "[-2, 1]"))) == 1


def test_monitor_names_are_unique_and_not_those_of_twins() -> None:
    assert problems(monitor("a", "[0, 0]") + monitor("b", "[1, 1]") + monitor("a", "[2, 2]")) == [
        'monitor[3].name: "a" is taken by monitor[1]'
    ]
    assert problems(monitor("free_field", "[0, 0]") + monitor("a.free", "[0, 0]")) == []
    assert problems(monitor("a.free_field", "[0, 0]")) == [
        'monitor[1, a.free_field].name: is "a.free_field", must not end in ".free_field", '
        "which is kept for a monitor's twin"
    ]


def test_intervals_fit_into_the_run() -> None:
    assert problems("time_step = 0.1\n[output]\nhistory_interval = 0.1\nenergy_interval = 0.1\n") == []
    assert problems("time_step = 0.2\n[output]\nhistory_interval = 0.3\nenergy_interval = 0.4\n") == [
        "run.time_step: is 0.2, must be at most run.duration, 0.1 (s)",
        "output.history_interval: is 0.3, must be at most run.duration, 0.1 (s)",
        "output.energy_interval: is 0.4, must be at most run.duration, 0.1 (s)",
    ]


def test_invalid_tables_silence_only_the_checks_that_need_them() -> None:
    wrong = BODY.replace("radius = 0.25", "radius = 0").replace("duration = 0.1", "duration = 0")
    more = side("left", "periodic") + monitor("a", "[99, 99]") + monitor("a", "[1, 1]")
    found = problems_of(wrong + more + "[motion]\nheld = [1]\n[output]\nhistory_interval = 7\n")
    assert [line.split(": ")[0] for line in found] == [
        "packing.radius",
        "motion.held",
        "run.duration",
        "boundary.left.type",
        "monitor[2].name",
    ]
