"""Import of one run with its files: signals, axes, beats, events; or the reason why it is left out."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from swaystride.findings import FINDING_COLUMNS
from swaystride.studies.experience.design import EVENT_COLUMNS, ExperienceDesign
from swaystride.studies.experience.plan import SENSORS
from swaystride.studies.experience.run_checks import UnusableRunError
from swaystride.studies.experience.run_import import (
    ImportedRun,
    ImportRules,
    alignment_table,
    import_run,
)
from swaystride.studies.experience.signals_file import save_signals

EXCLUSION_COLUMNS: Final = ("run", "file", "reason", "expected", "found")


@dataclass(frozen=True)
class RunOutputs:
    """Where the import of a run writes.

    Parameters
    ----------
    recordings : Path
        Signals in anatomical axes (netCDF).
    alignment, heart_rate, spans : Path
        Axes of the sensors, beats, events and clipping (Parquet).
    run_json : Path
        Length, rate, file and its hash, missing sensors; whether and why the run is left out.
    findings, exclusions : Path
        CSV.
    """

    recordings: Path
    alignment: Path
    heart_rate: Path
    spans: Path
    run_json: Path
    findings: Path
    exclusions: Path


def import_run_files(
    name: str, design: ExperienceDesign, folder: Path, rules: ImportRules, outputs: RunOutputs
) -> str:
    """Import one run and write what the next stages read.

    Parameters
    ----------
    name : str
        Of the run.
    design : ExperienceDesign
    folder : Path
        Where the study's files lie.
    rules : ImportRules
    outputs : RunOutputs

    Returns
    -------
    str
        One line for the person who watches.

    Raises
    ------
    DesignError, RecordingError
        If a file contradicts itself or its table; nothing is written then.
    """
    run = design.run(name)
    reason = {"file": run.files["imu"], "reason": run.exclude, "expected": "", "found": ""}
    imported: ImportedRun | None = None
    if not run.exclude:
        try:
            imported = import_run(run, folder, rules)
        except UnusableRunError as error:
            found = ": ".join(filter(None, (error.place, error.found)))
            reason = {
                "file": error.file or run.files["imu"],
                "reason": error.problem,
                "expected": error.expected or "",
                "found": found,
            }
    exclusions = [] if imported else [{"run": name, **reason}]
    pd.DataFrame(exclusions, columns=list(EXCLUSION_COLUMNS)).to_csv(
        outputs.exclusions, index=False, lineterminator="\n"
    )
    _write_tables(name, run.participant, imported, reason["reason"], outputs)
    if imported is None:
        save_signals(outputs.recordings, {}, 0.0, {})
        return f"{name}: left out: {reason['reason']}"
    save_signals(outputs.recordings, imported.signals, imported.rate_hz, imported.source)
    minutes = imported.duration_s / 60.0
    return f"{name}: {minutes:.1f} min, {len(imported.signals)} sensors, {len(imported.findings)} findings"


def _write_tables(
    name: str, participant: str, imported: ImportedRun | None, reason: str, outputs: RunOutputs
) -> None:
    """Everything but the signals; empty tables of a run that is left out."""
    findings = imported.findings if imported else []
    rows = pd.DataFrame([asdict(f) for f in findings], columns=list(FINDING_COLUMNS))
    rows.insert(0, "run", name)
    rows.to_csv(outputs.findings, index=False, lineterminator="\n")
    axes = imported.alignment if imported else alignment_table({})
    axes.to_parquet(outputs.alignment, index=False)
    end_s = imported.beats.end_s if imported else np.empty(0)
    interval_s = imported.beats.interval_s if imported else np.empty(0)
    pd.DataFrame(
        {"time_s": end_s, "interval_s": interval_s, "heart_rate_bpm": 60.0 / interval_s}
    ).to_parquet(outputs.heart_rate, index=False)
    empty = pd.DataFrame(columns=list(EVENT_COLUMNS))
    spans = (imported.spans if imported else empty).astype(
        {"start_s": float, "stop_s": float, "event": str, "sensor": str}
    )
    spans.to_parquet(outputs.spans, index=False)
    present = set(imported.signals) if imported else set()
    summary: dict[str, Any] = {
        "run": name,
        "participant": participant,
        "excluded": imported is None,
        "reason": "" if imported else reason,
        "duration_s": imported.duration_s if imported else 0.0,
        "rate_hz": imported.rate_hz if imported else 0.0,
        **(imported.source if imported else {"source_file": "", "source_sha256": ""}),
        "missing_sensors": [sensor for sensor in SENSORS if sensor not in present],
    }
    outputs.run_json.write_text(json.dumps(summary, indent=1) + "\n", encoding="utf-8")
