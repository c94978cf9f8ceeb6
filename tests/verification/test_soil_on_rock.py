"""Damped soil on rock under a measured record has the response spectrum of equivalent-linear programs."""

import pytest
import soil_on_rock


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:monitor.surface. its velocity is")
def test_a_damped_column_has_the_spectrum_of_the_hysteretic_one(tmp_path) -> None:
    """DEEPSOIL's example 4 with 12 disks in a wave of 40 Hz; both moduli differ in phase, so histories differ more."""
    found = soil_on_rock.errors_of(1.0, True, tmp_path, 25.0)

    assert found.velocity < 6e-4
    assert found.spectrum < 4e-3
    assert found.hysteretic_spectrum < 0.03
