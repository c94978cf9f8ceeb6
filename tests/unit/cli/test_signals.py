"""The command signals."""


def test_a_picture_and_its_table_are_written(dembound, small_run, spalled_run, tmp_path):
    for options, head in (
        (("--show", "fourier", "--quantity", "acceleration", "--component", "both"), "frequency (Hz),"),
        (("--show", "transfer", "--reference", "front"), "frequency (Hz) of small,"),
        (("--show", "response", "--component", "x"), "period (s),"),
        (("--show", "section"), "time (ms),"),
        (("--show", "hodograph", "--monitor", "front"), "velocity along x (m/s),"),
    ):
        answer = dembound("signals", small_run, *options)
        assert (answer.code, answer.out) == (0, "wrote signals.png\nwrote signals.csv\n")
        assert (tmp_path / "signals.png").stat().st_size > 0
        assert (tmp_path / "signals.csv").read_text().startswith(head)
    answer = dembound("signals", spalled_run, "--quantity", "stress", "-o", "bar.png")  # by default a spectrum
    assert (answer.code, answer.out) == (0, "wrote bar.png\nwrote bar.csv\n")
    assert "gauge, spalled: Fourier amplitude of the stress (MPa·s)" in (tmp_path / "bar.csv").read_text()


def test_options_without_effect_are_refused(dembound, small_run, tmp_path):
    for options, problem in (
        (("--reference", "front"), "--reference: goes with --show transfer"),
        (("--show", "response", "--quantity", "velocity"), "--quantity: is not allowed with --show response"),
        (("--show", "hodograph", "--component", "x"), "--component: is not allowed with --show hodograph"),
    ):
        answer = dembound("signals", small_run, *options)
        assert answer.code == 2
        assert answer.err.startswith(problem)
    assert not list(tmp_path.iterdir())
