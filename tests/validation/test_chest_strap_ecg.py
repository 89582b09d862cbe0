"""Heart rate of a strap on a recording whose beats are known."""

from pathlib import Path

import numpy as np
import pytest

from swaystride.ecg_recording import UNIX_EPOCH, make_ecg
from swaystride.io.polar_ecg_writer import write_ecg_logger
from swaystride.validation import chest_strap_ecg
from swaystride.validation.figures import figure_heart_rate

RATE_HZ = 130.16


@pytest.fixture
def recording(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Three minutes with a beat every 0.75 s, which the strap reports."""
    time = np.arange(int(180 * RATE_HZ)) / RATE_HZ
    beats = np.arange(0.4, 180, 0.75)
    ecg = 1e-3 * np.exp(-((((time - 0.4 + 0.375) % 0.75 - 0.375) / 0.018) ** 2))
    made = make_ecg(
        ecg,
        rate_hz=RATE_HZ,
        rate_source="argument",
        start_ns=1_714_920_600_000_000_000,
        clock_epoch=UNIX_EPOCH,
        report_time_s=beats[1:],
        strap_rr_s=np.diff(beats),
        strap_hr_bpm=np.full(len(beats) - 1, 80.0),
    )
    write_ecg_logger(tmp_path / "ecg.csv", made)
    monkeypatch.setattr(chest_strap_ecg, "verified_files", lambda *_: [tmp_path / "ecg.csv"])
    return tmp_path


def test_minutes_agree_with_the_strap(recording: Path) -> None:
    minutes = chest_strap_ecg.heart_rate_table(recording)
    assert minutes["minute"].tolist() == [1, 2, 3]
    np.testing.assert_allclose(minutes["heart_rate_bpm"], 80.0, rtol=2e-3)
    np.testing.assert_allclose(minutes["strap_heart_rate_bpm"], 80.0, rtol=1e-9)
    assert abs(minutes["beats"] - minutes["strap_beats"]).max() <= 1
    assert len(figure_heart_rate(minutes).axes[0].lines) == 2


def test_the_verdicts(recording: Path) -> None:
    minutes = chest_strap_ecg.heart_rate_table(recording)
    checks = {c.quantity: c for c in chest_strap_ecg.heart_rate_checks(minutes, recording)}
    assert checks["mean heart rate, 1/min"].within == "yes"
    assert checks["lost packets"].within == "yes"
    assert checks["sampling rate, Hz"].within == "yes"
    assert checks["RR intervals"].within == "reported"
    assert checks["mean of the strap's RR, as read, ms"].value == pytest.approx(750.0)
