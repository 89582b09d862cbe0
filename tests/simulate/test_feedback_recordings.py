"""Raw files: what a reader and the analysis find in them is what was put in."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from swaystride.io.reading import read_recording
from swaystride.io.study_tables import write_study_table
from swaystride.recording import findings_of
from swaystride.signals.gaps import missing_runs
from swaystride.simulate.feedback_cohort import design_tables
from swaystride.simulate.feedback_recordings import lost_trials, write_participant
from swaystride.sway.angles import trunk_angles

SEED = 20
SMALL_PROTOCOL = {"n_participants": 2, "n_short": 0, "baseline_trials": 2, "training_sets": 2}


@pytest.fixture(scope="module")
def small(cohort):
    """Two participants with 16 trials each, one of them lost, many with lost packets."""
    return replace(
        cohort,
        protocol=replace(cohort.protocol, **SMALL_PROTOCOL),
        radio=replace(cohort.radio, n_lost_trials=2, few_packets_share=0.4),
    )


def write(cohort, folder, participant="P01", tables=None, seed=SEED):
    participants, trials = tables or design_tables(cohort, seed)
    truth = write_participant(
        participant,
        participants=participants,
        trials=trials,
        cohort=cohort,
        seed=seed,
        folder=folder / "raw",
        truth_file=folder / "truth" / f"{participant}.tsv",
    )
    return truth, trials[trials["participant"] == participant]


@pytest.fixture(scope="module")
def written(small, tmp_path_factory):
    folder = tmp_path_factory.mktemp("feedback")
    parts = [write(small, folder, name) for name in ("P01", "P02")]
    truth, trials = (pd.concat(frames, ignore_index=True) for frames in zip(*parts, strict=True))
    return folder, truth, trials


def test_every_trial_has_its_file_that_says_simulated(written):
    folder, _, trials = written
    files = sorted(str(path.relative_to(folder / "raw")) for path in folder.rglob("*.txt"))
    assert files == sorted(trials["file"])
    for file in files:
        head = (folder / "raw" / file).read_text(encoding="utf-8")[:400]
        assert "// Comment: simulated by swaystride, not a measurement" in head
        assert "// Update Rate: 100.0Hz" in head


def test_lost_packets_are_where_the_truth_says(written):
    folder, truth, trials = written
    kinds = truth["radio"].value_counts()
    assert kinds["complete"] >= 5
    assert kinds["few packets"] >= 3
    assert kinds.reindex(["hole", "ends early"]).fillna(0).sum() == 2
    for row, file in zip(truth.itertuples(), trials["file"], strict=True):
        recording = read_recording(folder / "raw" / file)
        acc = recording["acc"].to_numpy()
        runs = missing_runs(acc)
        if row.radio == "ends early":
            assert acc.shape[2] == 3000 - row.n_lost_packets
            assert acc.shape[2] <= 2700
            assert runs.empty
            continue
        assert acc.shape[2] == 3000
        assert runs["length"].sum() == row.n_lost_packets
        if row.radio == "hole":
            assert len(runs) == 1
            assert 200 <= row.n_lost_packets <= 800
        if row.radio == "few packets":
            assert (runs["length"] == 1).all()
            assert 1 <= row.n_lost_packets <= 3
            assert "packet_loss" in {finding.check for finding in findings_of(recording)}
        if row.radio == "complete":
            assert row.n_lost_packets == 0


def test_the_analysis_finds_the_true_features(written, small):
    folder, truth, trials = written
    errors = []
    for row, file in zip(truth.itertuples(), trials["file"], strict=True):
        if row.radio != "complete":
            continue
        recording = read_recording(folder / "raw" / file)
        acc, gyr = recording["acc"].to_numpy()[0], recording["gyr"].to_numpy()[0]
        found = small.population.trial.true_measures(
            *trunk_angles(acc, gyr - gyr.mean(axis=1, keepdims=True), 100.0)
        )
        errors.append(
            [np.log(found[name] / getattr(row, f"true_{name}")) for name in ("phi_rms", "phi_mv")]
        )
    # What the sensor adds is small against the .23 and .16 between trials.
    assert np.abs(np.mean(errors, axis=0)).max() < 0.03
    assert np.std(errors, axis=0).max() < 0.08


def test_truth_is_complete_and_consistent(written):
    folder, truth, trials = written
    stored = pd.concat(
        [pd.read_csv(path, sep="\t") for path in sorted((folder / "truth").glob("*.tsv"))],
        ignore_index=True,
    )
    assert not stored.isna().any().any()
    pd.testing.assert_frame_equal(stored, truth, check_dtype=False, rtol=1e-8)
    assert stored["session_trial"].tolist() == trials["session_trial"].tolist()
    np.testing.assert_allclose(
        np.hypot(stored["true_ap_rms"], stored["true_ml_rms"]), stored["true_phi_rms"], rtol=1e-7
    )
    inside = stored["in_range"] == 1
    for name in ("ap_rms", "ml_rms", "phi_mv"):
        wanted = stored[f"expected_ln_{name}"] + stored[f"scatter_ln_{name}"]
        np.testing.assert_allclose(stored[f"attained_ln_{name}"][inside], wanted[inside], atol=1e-6)
        # The true feature scatters about what its inputs make it expect.
        own = np.log(stored[f"true_{name}"]) - stored[f"attained_ln_{name}"]
        assert abs(own.mean()) < 4 * 0.3 / np.sqrt(len(own))
        assert own.abs().max() < 1.2


def test_same_seed_same_bytes_whatever_else_was_written(small, written, tmp_path):
    folder, _, trials = written
    write(small, tmp_path, "P02")
    for file in trials.loc[trials["participant"] == "P02", "file"]:
        assert (tmp_path / "raw" / file).read_bytes() == (folder / "raw" / file).read_bytes()
    first = (folder / "truth" / "P02.tsv").read_bytes()
    assert (tmp_path / "truth" / "P02.tsv").read_bytes() == first


def test_adding_a_participant_changes_nobody_elses_data(small, tmp_path):
    quiet = replace(small, radio=replace(small.radio, n_lost_trials=0))
    participants, trials = design_tables(quiet, SEED)
    larger, more_trials = design_tables(
        replace(quiet, protocol=replace(quiet.protocol, n_participants=3)), SEED
    )
    # The printed group means tie the bodies of a cohort together; keep those of the small one.
    tables = pd.concat([participants, larger.iloc[2:]], ignore_index=True), more_trials
    write(quiet, tmp_path / "small", "P01", (participants, trials))
    write(quiet, tmp_path / "large", "P01", tables)
    for file in trials.loc[trials["participant"] == "P01", "file"]:
        small_file, large_file = (tmp_path / size / "raw" / file for size in ("small", "large"))
        assert small_file.read_bytes() == large_file.read_bytes()


def test_tables_survive_the_way_through_files(small, tmp_path):
    participants, trials = design_tables(small, SEED)
    write_study_table(participants, tmp_path / "participants.tsv")
    write_study_table(trials, tmp_path / "trials.tsv")
    tables = tuple(
        pd.read_csv(tmp_path / name, sep="\t") for name in ("participants.tsv", "trials.tsv")
    )
    write(small, tmp_path / "memory", "P02", (participants, trials))
    write(small, tmp_path / "files", "P02", tables)
    for path in (tmp_path / "memory").rglob("*.t*"):
        other = tmp_path / "files" / path.relative_to(tmp_path / "memory")
        assert not path.is_file() or path.read_bytes() == other.read_bytes()


def test_lost_trials_are_drawn_over_the_whole_cohort(cohort):
    _, trials = design_tables(cohort, 1)
    drawn = [lost_trials(trials, cohort, seed) for seed in range(300)]
    assert all(len(rows) == 3 and rows["file"].is_unique for rows in drawn)
    share = pd.concat(drawn)["participant"].value_counts() / 900
    assert len(share) == 19
    assert share.max() < 0.1
    again = lost_trials(trials, cohort, 7)
    pd.testing.assert_frame_equal(again, drawn[7])


def test_the_sensor_keeps_its_errors_through_the_session(written):
    folder, truth, trials = written
    offsets = []
    for file, kind in zip(trials["file"], truth["radio"], strict=True):
        if kind == "complete":
            gyr = read_recording(folder / "raw" / file)["gyr"].to_numpy()[0]
            offsets.append((file[:3], *np.rad2deg(gyr.mean(axis=1))))
    means = pd.DataFrame(offsets, columns=["participant", "x", "y", "z"]).groupby("participant")
    # Turn-on bias of each unit: noise of 0.1 °/s/√Hz moves a mean over 30 s by .013 °/s; about the
    # horizontal axes the sway between first and last sample adds some 1.5° / 30 s.
    assert means["z"].std().max() < 0.03
    assert means[["x", "y"]].std().to_numpy().max() < 0.15
    assert np.abs(means.mean().diff().dropna().to_numpy()).max() > 0.1
