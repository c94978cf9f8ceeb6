"""Storage of compiled code: never of other sources than the present ones."""

import shutil
from importlib.metadata import EntryPoint
from pathlib import Path

from dembound import kernels
from dembound.kernels import loop

FOLDER = Path(kernels.__file__).parent


def test_compiled_code_is_kept_apart_for_every_state_of_the_sources(tmp_path) -> None:
    assert kernels.sources_digest(*kernels.SOURCES) in loop._advance._cache.cache_path
    copy = shutil.copytree(FOLDER, tmp_path / "kernels", ignore=shutil.ignore_patterns("__pycache__"))
    digests = {kernels.sources_digest(copy)}
    assert digests == {kernels.sources_digest(FOLDER)}
    for changed in (copy / "step.py", copy / "tables" / "motion.py"):
        changed.write_text(changed.read_text() + "\n")
        digests.add(kernels.sources_digest(copy))
    assert len(digests) == 3


def test_laws_of_other_packages_count_as_sources(tmp_path, monkeypatch) -> None:
    (tmp_path / "sandy").mkdir()
    (tmp_path / "sandy" / "__init__.py").write_text("")
    (tmp_path / "sandy" / "law.py").write_text("raise ImportError  # is_pair_law: is read, not imported")
    monkeypatch.syspath_prepend(tmp_path)
    entries = [EntryPoint(name, f"{name}.law:Law", "dembound.laws") for name in ("sandy", "gone")]
    monkeypatch.setattr(kernels, "entry_points", lambda group: [each for each in entries if each.group == group])

    assert kernels.registered_laws() == [tmp_path / "sandy" / "law.py"]
