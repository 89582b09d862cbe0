"""What a lab gets to read when a recording is not what it should be."""

import re

import numpy as np
import pytest

from swaystride.errors import DesignError, RecordingError
from swaystride.studies.kinematics.truth import angle_errors, stride_errors

RUN, FILM = "P01/P01_01_running.h5", "P01/P01_01_running.c3d"
STAND, STATIC = "P01/P01_01_standing.h5", "P01/P01_01_standing.c3d"
PAIRS = [(f"Right {part}", f"Left {part}") for part in ("Thigh", "Shank", "Foot")]


def relabelled(pairs):
    """Sensors with the labels of some pairs exchanged."""
    other = {a: b for one, two in pairs for a, b in ((one, two), (two, one))}

    def change(recording):
        labels = [other.get(str(name), str(name)) for name in recording["sensor"].values]
        return recording.assign_coords(sensor=labels)

    return change


def without_samples(sensors, start_s, stop_s, *, frozen=False):
    """Sensors that stop: no sample, or always the same."""

    def change(recording):
        out = recording.copy(deep=True)
        part = slice(round(200 * start_s), round(200 * stop_s))
        for row, name in enumerate(out["sensor"].values):
            if str(name) in sensors:
                for signal in ("acc", "gyr"):
                    channels = out[signal].values[row]
                    channels[:, part] = channels[:, [part.start]] if frozen else np.nan
        return out

    return change


def never_seen(marker):
    def change(recording):
        out = recording.copy(deep=True)
        out["position"].loc[{"marker": marker}] = np.nan
        return out

    return change


def half_rate(recording):
    out = recording.isel(time=slice(None, None, 2))
    out.attrs["rate_hz"] = 100.0
    return out


def seven_times(recording):
    n = recording.sizes["time"]
    out = recording.isel(time=np.tile(np.arange(n), 7))
    return out.assign_coords(time=np.arange(7 * n) / 200.0)


def stopped_with(lab, message):
    """The participant stops with one line; nothing is left behind."""
    with pytest.raises((RecordingError, DesignError), match=message) as told:
        lab.import_all()
    assert "\n" not in str(told.value)
    assert not (lab.folder / "recordings.nc").exists()


def left_out(lab):
    """The only row of the exclusions, and that no trial is left."""
    tables = lab.import_all()
    assert tables.n_usable == 0
    assert len(tables.exclusions) == 1
    row = tables.exclusions.iloc[0]
    assert (row["participant"], row["trial"]) == ("P01", "01")
    return row


def finding(tables, check):
    found = tables.findings[tables.findings["check"] == check]
    assert len(found) == 1
    return found.iloc[0]


def test_left_and_right_exchanged(lab):
    """A gait is alike half a period later: only strides that differ tell the sides."""
    for phase in ("running", "standing"):
        lab.change_sensors(phase, relabelled(PAIRS))
    stopped_with(
        lab,
        f"{RUN}: Right Thigh, Left Thigh, Right Shank, .*: sensors are not on the segments .*"
        "Right Thigh moves like the left thigh.*Left Foot moves like the right foot",
    )


def test_two_sensors_exchanged(lab):
    lab.change_sensors("running", relabelled([("Right Thigh", "Right Shank")]))
    stopped_with(
        lab,
        f"{RUN}: Right Thigh, Right Shank: sensors are not .*"
        "found Right Thigh moves like the right shank, Right Shank moves like the right thigh$",
    )


def test_markers_of_another_run(lab):
    """The film backwards is a run too, but not this one."""

    def backwards(recording):
        out = recording.copy(deep=True)
        out["position"].values[:] = recording["position"].values[:, :, ::-1]
        return out

    lab.change_markers("running", backwards)
    stopped_with(lab, f"{RUN}: Lumbar: sensor and markers show different movements")


def test_a_trigger_that_fails_by_seconds(lab):
    """Three seconds later, another stride of the other foot fits best."""
    lab.change_markers("running", lambda r: r.isel(time=slice(600, None)))
    stopped_with(
        lab,
        f"^{RUN}: sensors and markers are out of step by too much; expected a delay of 1 s at most.*"
        r"found 1\.\d\d s or more$",
    )


def test_sensors_that_repeat_themselves_have_stopped(lab):
    sensors = ["Lumbar", "Left Shank"]
    lab.change_sensors("running", without_samples(sensors, 0.5, 3.5, frozen=True))
    tables = lab.import_all()
    cut = finding(tables, "recording_interrupted")
    assert cut["place"] == "pelvis, left shank"
    told = tables.findings[tables.findings["check"] == "sensor_frozen"]
    assert told["place"].tolist() == [
        f"{name}, first at t = 0.500 s" for name in ("pelvis", "left shank")
    ]
    assert told["found"].str.startswith("2.995 s of repeated samples").all()
    assert lab.recordings().running.attrs["start_s"] == 3.5


def test_a_sensor_that_stops_for_three_seconds(lab, known, last_strides):
    lab.change_sensors("running", without_samples(["Left Shank"], 0.5, 3.5))
    tables = lab.import_all()
    cut = finding(tables, "recording_interrupted")
    assert (cut["severity"], cut["file"], cut["place"]) == ("warning", RUN, "left shank")
    assert cut["found"] == "the part from 3.50 s to 24.50 s is used"
    estimates, _ = lab.estimate("recommended")
    assert estimates.attrs["first_usable_s"] == 3.5
    np.testing.assert_allclose(estimates["time"].values[[0, -1]], [3.5, 24.5 - 0.005])
    strides = lab.measure("recommended", estimates)["strides"]
    assert strides["initial_contact_s"].min() > 3.5 + 10 * 0.6
    last = last_strides(strides)
    errors = angle_errors(estimates, last, known).query("source == 'erkf'")
    assert errors["rmsd_trial_deg"].max() < 5.0
    optic = stride_errors(last, known).query("source == 'optic' and measure == 'stride_length_m'")
    assert np.abs(optic["estimate"] - optic["truth"]).max() < 0.005


def test_a_sensor_that_stops_in_the_middle_leaves_too_little(lab):
    lab.change_sensors("running", without_samples(["Lumbar"], 10.0, 13.0))
    row = left_out(lab)
    assert row["reason"] == "data loss: no uninterrupted part that is long enough"
    assert (row["file"], row["found"]) == (RUN, "11.50 s")


@pytest.mark.parametrize(
    ("phase", "change", "file", "found"),
    [
        ("running", never_seen("RKNE"), FILM, "RKNE: in none"),
        ("running", never_seen("LIMF"), FILM, "LIMF: in none"),
        ("running", lambda r: r.drop_sel(marker="RKNE"), FILM, "RKNE: no such label"),
        ("standing", never_seen("LASI"), STATIC, "LASI: in none"),
        (
            "standing",
            lambda r: r.drop_sel(marker=["LHEE", "LTOE"]),
            STATIC,
            "LHEE, LTOE: no such label",
        ),
    ],
)
def test_a_marker_missing_throughout(lab, phase, change, file, found):
    lab.change_markers(phase, change)
    row = left_out(lab)
    assert (row["reason"], row["file"]) == ("marker missing throughout", file)
    assert row["found"] == found


def test_what_harms_nobody(lab, sound_lab):
    """A gap too short to hide an impact is filled; markers that are not needed may be missing."""
    lab.change_sensors("running", without_samples(["Left Shank"], 12.0, 12.015))
    lab.change_markers("running", lambda r: r.drop_sel(marker=["C7", "RELB"]))
    lab.change_markers("standing", lambda r: r.drop_sel(marker=["RIMF", "IMUP"]))
    tables = lab.import_all()
    assert tables.n_usable == 1
    assert "recording_interrupted" not in set(tables.findings["check"])
    filled, sound = (place.recordings().running["gyr"].values for place in (lab, sound_lab))
    assert np.isfinite(filled).all()
    around = np.r_[0:2400, 2403 : sound.shape[2]]
    np.testing.assert_array_equal(filled[..., around], sound[..., around])


@pytest.mark.parametrize(
    ("kind", "reason"),
    [
        ("standing_imu", "static trial of the sensors missing"),
        ("standing_markers", "static trial of the markers missing"),
        ("running_markers", "running recording of the markers missing"),
    ],
)
def test_a_recording_without_a_row(lab, kind, reason):
    lab.change_table("trials", lambda t: t[t["kind"] != kind])
    row = left_out(lab)
    assert (row["reason"], row["expected"]) == (reason, f"a row {kind}")


@pytest.mark.parametrize("file", [RUN, FILM, STAND, STATIC])
def test_a_file_that_is_not_there(lab, file):
    (lab.folder / file).unlink()
    stopped_with(lab, f"^{file}: no such file; expected the file named in trials.tsv$")


@pytest.mark.parametrize(
    ("file", "content", "message"),
    [
        (RUN, b"no recording", "P01_01_running.h5: first line: unknown format"),
        (STATIC, b"no recording", "P01_01_standing.c3d: this is no C3D file"),
        (RUN, 100_000, "P01_01_running.h5: the HDF5 file is damaged or cut off"),
        (FILM, 100_000, "P01_01_running.c3d: header: the file does not hold what it declares"),
    ],
)
def test_a_file_that_cannot_be_read(lab, file, content, message):
    path = lab.folder / file
    path.write_bytes(path.read_bytes()[:content] if isinstance(content, int) else content)
    stopped_with(lab, message)


def test_markers_in_place_of_sensors(lab):
    (lab.folder / RUN).write_bytes((lab.folder / FILM).read_bytes())
    stopped_with(lab, "P01_01_running.h5: the file holds no inertial sensors")


@pytest.mark.parametrize("late", [True, False])
def test_clocks_out_of_step_by_a_tenth_of_a_second(lab, sound_lab, estimated, known, late):
    """Markers begin late, or the sensors do: found, told, and taken out."""

    def later(recording):
        return recording.isel(time=slice(20, None))

    (lab.change_markers if late else lab.change_sensors)("running", later)
    told = finding(lab.import_all(), "clocks_out_of_step")
    assert (told["severity"], told["file"]) == ("warning", RUN)
    delay_ms = float(re.fullmatch(r"sensors ([\d.]+) ms (late|early); .*", told["found"])[1])
    assert ("late" in told["found"]) == late
    jitter_ms = 1e3 * known.marker_start_s
    assert delay_ms == pytest.approx(100.0 + (jitter_ms if late else -jitter_ms), abs=3.0)
    ours, sound = lab.recordings(), sound_lab.recordings()
    offset = 0 if late else 20
    n = ours.running.sizes["time"]
    np.testing.assert_array_equal(
        ours.running["acc"].values, sound.running["acc"].values[..., offset : offset + n]
    )
    inside = slice(40, n - 40)
    both = [
        place["position"].values[..., slice(first + 40, first + n - 40)]
        for place, first in ((ours.markers, 0), (sound.markers, offset))
    ]
    # a foot moves by 8 mm within a millisecond
    assert np.sqrt(np.nanmean((both[0] - both[1]) ** 2)) < 0.006
    time_s = sound.running["time"].values[offset : offset + n][inside]
    true = known.sensor_position_m(time_s)[:, 5]
    true[:, 0] -= known.motion.belt_way_m(time_s)
    foot = ours.markers["position"].sel(marker="RIMF").values.T[inside]
    assert np.sqrt(np.nanmean((foot - true) ** 2)) < 0.003
    if late:
        angles = [
            e["angle_deg"].values for e in (lab.estimate("printed")[0], estimated("printed")[0])
        ]
        missed = np.abs(angles[0] - angles[1])[..., 2000:-60]
        # the filter of the dissertation starts from the markers and does not forget it
        assert np.nanmedian(missed[0]) < 0.5
        assert np.nanmedian(missed[1]) < 3.0


@pytest.mark.parametrize(
    ("measure", "typed", "message"),
    [
        ("leg_length_right_m", "0.45", "^participants.tsv: P01: leg_length_m, right: .*cannot be right"),
        ("leg_length_left_m", "45", r"participants.tsv: line 2, column leg_length_left_m: .*found '45'"),
        ("knee_width_left_m", "0.01", "^participants.tsv: P01: knee_width_m, left: .*0.07 to 0.17 m"),
        ("ankle_width_right_m", "7.1", "line 2, column ankle_width_right_m"),
        ("leg_length_right_m", "", "line 2, column leg_length_right_m"),
    ],
)  # fmt: skip
def test_a_length_that_nobody_has(lab, measure, typed, message):
    lab.change_table("participants", lambda t: t.assign(**{measure: typed}))
    stopped_with(lab, message)


def test_a_leg_that_contradicts_the_markers(lab):
    def wrong(people):
        true = float(people.loc[0, "leg_length_left_m"])
        return people.assign(leg_length_left_m=f"{1.1 * true:.3f}")

    lab.change_table("participants", wrong)
    stopped_with(
        lab,
        r"P01_01_standing.c3d: left leg: leg length contradicts the markers; "
        r"expected within 8% of 0\.\d+ m",
    )


def test_nobody_runs(lab):
    for kind in ("imu", "markers"):
        lab.file(f"running_{kind}").write_bytes(lab.file(f"standing_{kind}").read_bytes())
    lab.change_sensors("running", seven_times)
    lab.change_markers("running", seven_times)
    row = left_out(lab)
    assert (row["reason"], row["file"]) == ("nobody runs in the trial", RUN)
    assert row["found"].startswith("right foot: one rhythm in 0 of ")


def test_a_standing_recording_in_place_of_the_run(lab):
    def swap(trials):
        files = trials.set_index("kind")["file"]
        named = {f"running_{what}": files[f"standing_{what}"] for what in ("imu", "markers")}
        return trials.assign(file=trials["kind"].map(named).fillna(trials["file"]))

    lab.change_table("trials", swap)
    row = left_out(lab)
    assert (row["file"], row["found"]) == (STAND, "4.00 s")


@pytest.mark.parametrize(
    ("kind", "other", "message"),
    [
        ("standing_imu", RUN, f"{STAND}: .* foot: the static trial is not quiet standing; expected .*20 deg/s"),
        ("standing_markers", FILM, r"P01_01_standing.c3d: \w+: the static trial is not quiet standing"),
    ],
)  # fmt: skip
def test_a_run_in_place_of_the_standing(lab, kind, other, message):
    lab.file(kind).write_bytes((lab.folder / other).read_bytes())
    stopped_with(lab, message)


@pytest.mark.parametrize(("phase", "file"), [("running", RUN), ("standing", STAND)])
def test_a_label_that_is_missing(lab, phase, file):
    def renamed(recording):
        labels = [str(name).replace("Left Foot", "Foot L") for name in recording["sensor"].values]
        return recording.assign_coords(sensor=labels)

    lab.change_sensors(phase, renamed)
    row = left_out(lab)
    assert (row["reason"], row["file"]) == ("sensor missing", file)
    assert row["found"].startswith("Left Foot: only Lumbar, Right Thigh,")
    assert row["found"].endswith(", Foot L")


@pytest.mark.parametrize(("what", "rates"), [("markers", (200, 100)), ("sensors", (100, 200))])
def test_different_rates(lab, what, rates):
    getattr(lab, f"change_{what}")("running", half_rate)
    stopped_with(
        lab,
        f"{FILM}: sensors and cameras have different rates; "
        f"expected {rates[0]} Hz as in {RUN}; found {rates[1]} Hz",
    )


def test_a_film_that_is_too_short(lab):
    lab.change_markers("running", lambda r: r.isel(time=slice(0, 300)))
    row = left_out(lab)
    assert row["reason"] == "too little is recorded by sensors and markers at once"
    assert (row["file"], row["expected"], row["found"]) == (FILM, "20 s", "1.50 s")


def test_a_standing_that_is_too_short(lab):
    lab.change_sensors("standing", lambda r: r.isel(time=slice(0, 100)))
    row = left_out(lab)
    assert (row["reason"], row["found"]) == ("static trial of the sensors too short", "0.50 s")
