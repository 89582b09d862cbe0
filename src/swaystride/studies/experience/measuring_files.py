"""From the files of an imported run to the tables of its measures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import pandas as pd

from swaystride.findings import FINDING_COLUMNS
from swaystride.gait.run_measures import STRIDE_MEASURES
from swaystride.gait.spatiotemporal import STRIDE_COLUMNS
from swaystride.studies.experience.design import RunFiles
from swaystride.studies.experience.equipment import Equipment
from swaystride.studies.experience.measuring import MetricRules, measured_run
from swaystride.studies.experience.plan import MEASURE_KEYS
from swaystride.studies.experience.signals_file import load_signals

#: Columns of the tables of a run; those of strides without what they have in common with measures.
STRIDE_TABLE: Final = tuple(dict.fromkeys((*STRIDE_COLUMNS, *STRIDE_MEASURES, "is_steady")))
WINDOW_TABLE: Final = ("run", "start_s", "stop_s", "n_strides", *MEASURE_KEYS)
RUN_TABLE: Final = ("run", "participant", "n_strides", "n_rejected", *MEASURE_KEYS)


@dataclass(frozen=True)
class RunInputs:
    """What the import left of a run.

    Parameters
    ----------
    recordings, heart_rate, spans : Path
        Signals (netCDF), beats and events (Parquet).
    summary : mapping
        Whether the run is left out, its length, missing sensors.
    """

    recordings: Path
    heart_rate: Path
    spans: Path
    summary: Mapping[str, Any]


def measured_files(
    run: RunFiles, inputs: RunInputs, *, mass_kg: float, equipment: Equipment, rules: MetricRules
) -> tuple[dict[str, pd.DataFrame], pd.DataFrame]:
    """Measure a run; one that is left out has tables without rows.

    Parameters
    ----------
    run : RunFiles
    inputs : RunInputs
    mass_kg : float
        Of the runner.
    equipment : Equipment
    rules : MetricRules

    Returns
    -------
    tables : dict of str to DataFrame
        ``strides``, ``windows`` and ``runs``.
    findings : DataFrame
        ``run`` and the columns of a finding.
    """
    columns = {"strides": STRIDE_TABLE, "windows": WINDOW_TABLE, "runs": RUN_TABLE}
    if inputs.summary["excluded"]:
        nothing = {name: _without_rows(own) for name, own in columns.items()}
        return nothing, pd.DataFrame(columns=["run", *FINDING_COLUMNS])
    signals, rate_hz = load_signals(inputs.recordings)
    found = measured_run(
        signals,
        pd.read_parquet(inputs.heart_rate),
        pd.read_parquet(inputs.spans),
        rate_hz=rate_hz,
        mass_kg=mass_kg,
        equipment=equipment,
        rules=rules,
        file=run.files["imu"],
    )
    named = {"run": run.name, "participant": run.participant}
    tables = {
        "strides": found.strides,
        "windows": found.windows.assign(run=run.name),
        "runs": found.whole.assign(**named),
    }
    findings = pd.DataFrame([asdict(f) for f in found.findings], columns=list(FINDING_COLUMNS))
    findings.insert(0, "run", run.name)
    return {name: table[list(columns[name])] for name, table in tables.items()}, findings


def _without_rows(columns: tuple[str, ...]) -> pd.DataFrame:
    """Table without rows whose columns have the types that rows would give them."""
    texts, flags = {"run", "participant", "side"}, {"is_valid", "is_steady"}
    kinds = {name: str if name in texts else bool if name in flags else float for name in columns}
    return pd.DataFrame({name: pd.Series(dtype=kind) for name, kind in kinds.items()})
