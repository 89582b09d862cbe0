"""The chest strap's file of a run of the simulated experience study."""

from __future__ import annotations

from pathlib import Path

from swaystride.ecg_recording import UNIX_EPOCH, make_ecg
from swaystride.io.polar_ecg_writer import write_ecg_logger
from swaystride.simulate.experience_beats import electrocardiogram_v
from swaystride.simulate.experience_parameters import STUDY, ExperienceCohort
from swaystride.simulate.experience_plans import PlannedRun, beats_of
from swaystride.simulate.seeds import generator


def write_strap(
    path: Path, planned: PlannedRun, cohort: ExperienceCohort, seed: int, *, start_unix_us: int
) -> None:
    """Write the electrocardiogram of a run as the application of the chest strap does.

    Parameters
    ----------
    path : Path
        File to write; its folder exists.
    planned : PlannedRun
        The run.
    cohort : ExperienceCohort
        Parameters.
    seed : int
        Seed of the cohort.
    start_unix_us : int
        First sample of the IMUs, with which the strap begins.
    """
    ecg_v = electrocardiogram_v(
        cohort.strap,
        beats_of(planned, cohort, seed),
        duration_s=cohort.protocol.duration_s,
        rng=generator(seed, STUDY, planned.name, "strap"),
    )
    ecg = make_ecg(
        ecg_v,
        rate_hz=cohort.strap.rate_hz,
        rate_source="simulation",
        start_ns=1000 * start_unix_us,
        clock_epoch=UNIX_EPOCH,
        device="simulated by swaystride, not a measurement",
    )
    write_ecg_logger(path, ecg)
