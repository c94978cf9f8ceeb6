"""Where compiled code is kept: never code of other sources than there are."""

from pathlib import Path

from dembound import kernels
from dembound.kernels import loop

FOLDER = Path(kernels.__file__).parent


def test_compiled_code_is_kept_apart_for_every_state_of_the_sources() -> None:
    assert kernels.sources_digest(FOLDER) in loop.advance._cache.cache_path


def test_a_change_in_any_file_is_another_state(tmp_path) -> None:
    for path in FOLDER.glob("*.py"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    assert kernels.sources_digest(tmp_path) == kernels.sources_digest(FOLDER)

    changed = tmp_path / "step.py"
    changed.write_text(changed.read_text().replace("0.5", "0.6", 1))
    assert kernels.sources_digest(tmp_path) != kernels.sources_digest(FOLDER)
