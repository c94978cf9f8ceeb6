"""Storage of compiled code: never of other sources than the present ones."""

import logging
import os
import shutil
from importlib.metadata import EntryPoint
from pathlib import Path

from dembound import kernels
from dembound.kernels import loop

FOLDER = Path(kernels.__file__).parent


def test_compiled_code_is_kept_apart_for_every_state_of_the_sources(tmp_path) -> None:
    assert kernels.sources_digest(FOLDER, FOLDER.parent / "laws") in loop._advance._cache.cache_path
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
    (tmp_path / "sandy" / "law.py").write_text("raise ImportError")  # is not imported
    monkeypatch.syspath_prepend(tmp_path)
    entries = [EntryPoint(name, f"{name}.law:Law", "dembound.laws") for name in ("sandy", "gone")]
    monkeypatch.setattr(kernels, "entry_points", lambda group: [each for each in entries if each.group == group])

    assert kernels.registered_laws() == [tmp_path / "sandy" / "law.py"]


def test_compiled_code_has_a_folder_where_neither_package_nor_home_can_be_written(
    tmp_path, monkeypatch, caplog
) -> None:
    (tmp_path / "file").touch()
    package, private = tmp_path / "file" / "__pycache__", tmp_path / "private"
    monkeypatch.setattr(kernels, "private_folder", lambda: private)
    monkeypatch.setattr(kernels, "user_cache", lambda: tmp_path / "home")
    monkeypatch.setattr(os, "environ", dict(os.environ))
    monkeypatch.setattr(kernels.numba.config, "reload_config", lambda: None)
    caplog.set_level(logging.INFO)
    assert kernels.kept_in("", tmp_path / "package") == tmp_path / "package"
    assert kernels.kept_in("", package) == tmp_path / "home" / "compiled"
    assert caplog.messages == []
    monkeypatch.setattr(kernels, "user_cache", lambda: None)
    assert kernels.kept_in("", package) == private
    assert str(private) in caplog.text
    assert os.environ["NUMBA_CACHE_DIR"] == str(private)
