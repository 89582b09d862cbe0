"""Where results came from: commit, configuration, seed, versions and the sums of all files.

No dates, no machine names and no absolute paths: the same inputs give the same provenance.
"""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from swaystride.checksums import file_sha256
from swaystride.errors import ConfigurationError, DesignError


def config_hash(config: Mapping[str, Any]) -> str:
    """SHA-256 of a configuration as canonical JSON: sorted keys, no spaces.

    Parameters
    ----------
    config : mapping
        Texts, finite numbers, true, false, null, lists and mappings.

    Raises
    ------
    ConfigurationError
        If the configuration holds something that JSON has no word for.

    Examples
    --------
    >>> config_hash({"a": 1, "b": 2}) == config_hash({"b": 2, "a": 1})
    True
    """
    try:
        text = json.dumps(
            config, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False
        )
    except (TypeError, ValueError) as error:
        raise ConfigurationError(
            f"configuration cannot be written as JSON: {error}",
            expected="texts, finite numbers, true, false, null, lists and mappings",
        ) from None
    return hashlib.sha256(text.encode("utf-8")).hexdigest()


def collect_provenance(
    *,
    commit: str,
    config: Mapping[str, Any],
    seed: int,
    packages: Sequence[str],
    inputs: Iterable[Path | str],
    outputs: Iterable[Path | str],
    root: Path | str = ".",
) -> dict[str, Any]:
    """Provenance of a set of results.

    Parameters
    ----------
    commit : str
        Commit of the code, as the caller knows it.
    config : mapping
        The configuration in force.
    seed : int
        Seed of the random numbers.
    packages : sequence of str
        Installed distributions that matter.
    inputs, outputs : iterable of path or str
        Files, absolute or relative to ``root``.
    root : path or str
        Folder to which the paths are made relative.

    Returns
    -------
    dict
        ``commit``, ``config_sha256``, ``seed``, ``versions``, ``inputs`` and ``outputs``; files
        are sorted by path, each with ``path``, ``sha256`` and ``bytes``.

    Raises
    ------
    ConfigurationError
        If a distribution is not installed.
    DesignError
        If a file does not exist or lies outside ``root``.

    Examples
    --------
    >>> found = collect_provenance(commit="abc", config={}, seed=1, packages=["numpy"],
    ...                            inputs=[], outputs=[])
    >>> sorted(found)
    ['commit', 'config_sha256', 'inputs', 'outputs', 'seed', 'versions']
    """
    base = Path(root).absolute()
    return {
        "commit": commit,
        "config_sha256": config_hash(config),
        "seed": seed,
        "versions": {"python": platform.python_version()}
        | {name: _version(name) for name in sorted(packages)},
        "inputs": _files(inputs, base),
        "outputs": _files(outputs, base),
    }


def write_json(data: Mapping[str, Any], path: Path | str) -> None:
    """Write JSON with sorted keys, two spaces and a line end, the same bytes every time.

    Parameters
    ----------
    data : mapping
        What is written.
    path : path or str
        The file; its folder is made if needed.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     write_json({"b": 1, "a": "é"}, f"{folder}/x.json")
    ...     print(Path(f"{folder}/x.json").read_text(encoding="utf-8"))
    {
      "a": "é",
      "b": 1
    }
    """
    text = json.dumps(data, sort_keys=True, indent=2, ensure_ascii=False, allow_nan=False)
    file = Path(path)
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text + "\n", encoding="utf-8", newline="")


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        raise ConfigurationError(
            "version of a package", expected="an installed distribution", found=name
        ) from None


def _files(paths: Iterable[Path | str], base: Path) -> list[dict[str, Any]]:
    relative: dict[str, Path] = {}
    for path in paths:
        file = base / path  # a link inside the repository counts as the file it stands for
        if not file.is_relative_to(base) or ".." in file.relative_to(base).parts:
            raise DesignError("file outside the repository", file=file.name)
        name = file.relative_to(base).as_posix()
        if not file.is_file():
            raise DesignError("no such file", file=name)
        relative[name] = file
    return [
        {"path": name, "sha256": file_sha256(file), "bytes": file.stat().st_size}
        for name, file in sorted(relative.items())
    ]
