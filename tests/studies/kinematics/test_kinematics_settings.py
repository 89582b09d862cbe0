"""From the configuration to the parameters of the steps."""

import json
import math

import pytest

from study_parameters import load_study
from swaystride.errors import ConfigurationError
from swaystride.studies.kinematics import settings

VARIANTS = ("printed", "joint_axis_noise_swapped", "recommended", "recommended_optical_start")


def method_of(given):
    return settings.filter_method(given["erkf"], given["contacts"], given["zero_velocity"])


def test_these_are_the_variants():
    assert set(load_study("kinematics")["variants"]) == set(VARIANTS)


@pytest.mark.parametrize("variant", VARIANTS)
def test_every_variant_can_be_built(analysis, variant):
    given = analysis(variant)
    rules = settings.import_rules(given)
    assert rules.labels.in_order()[5:] == ("Right Foot", "Left Foot")
    assert rules.markers.names()[-7:] == rules.markers.faces.in_order()
    settings.optical_method(given["optics"])
    method = method_of(given)
    assert math.degrees(method.noise.gyr_sd_rad_s) == pytest.approx(
        given["erkf"]["noise"]["gyr_sd_deg_s"]
    )
    assert math.degrees(method.start.tilt_rad) == pytest.approx(given["erkf"]["start"]["tilt_deg"])
    assert math.degrees(method.start.gyr_bias_rad_s) == pytest.approx(
        given["erkf"]["start"]["gyr_bias_deg_s"]
    )


def test_the_printed_filter_is_that_of_table_4_2(analysis):
    method = method_of(analysis("printed"))
    assert (method.method, method.initialisation.source) == ("filter", "optical")
    assert method.zero_velocity == "gyroscopic_energy"
    assert math.degrees(method.noise.hip_axis_sd) == pytest.approx(0.75)
    assert math.degrees(method.noise.knee_axis_sd) == pytest.approx(45.84)
    assert method.options.gate == math.inf
    assert method.options.longest_refusal_s == math.inf


def test_variants_change_what_their_names_say(analysis):
    printed, swapped, recommended, optical = (method_of(analysis(v)) for v in VARIANTS)
    assert swapped.noise.hip_axis_sd == printed.noise.knee_axis_sd
    assert swapped.noise.knee_axis_sd == printed.noise.hip_axis_sd
    assert swapped.options == printed.options
    assert (recommended.method, recommended.initialisation.source) == ("smoother", "imu")
    assert optical.initialisation.source == "optical"
    assert (optical.noise, optical.options) == (recommended.noise, recommended.options)


def spoilt(given, path, change):
    """A copy of plain values with one group changed."""
    copy = json.loads(json.dumps(given))
    node = copy
    for part in path.split(".") if path else ():
        node = node[part]
    change(node)
    return copy


@pytest.mark.parametrize(
    ("build", "path", "place"),
    [
        (settings.import_rules, "recording.trial", "analysis.recording.trial"),
        (settings.import_rules, "recording.clocks", "analysis.recording.clocks"),
        (settings.import_rules, "recording.cleaning", "analysis.recording.cleaning"),
        (settings.import_rules, "recording.cleaning.limits", "analysis.recording.cleaning.limits"),
        (settings.import_rules, "sensors", "analysis.sensors"),
        (settings.import_rules, "markers", "analysis.markers"),
        (settings.import_rules, "markers.faces", "analysis.markers.faces"),
        (settings.import_rules, "contacts", "analysis.contacts"),
        (lambda given: settings.optical_method(given["optics"]), "optics", "analysis.optics"),
        (method_of, "erkf", "analysis.erkf"),
        (method_of, "erkf.initialisation", "analysis.erkf.initialisation"),
        (method_of, "erkf.centres", "analysis.erkf.centres"),
        (method_of, "erkf.start", "analysis.erkf.start"),
        (method_of, "erkf.noise", "analysis.erkf.noise"),
        (method_of, "erkf.options", "analysis.erkf.options"),
        (method_of, "zero_velocity", "analysis.zero_velocity"),
    ],
)
def test_an_unknown_key_is_an_error_with_its_place(analysis, build, path, place):
    given = spoilt(analysis("printed"), path, lambda node: node.update(newton_m=1.0))
    with pytest.raises(ConfigurationError, match=f"{place}.*newton_m") as told:
        build(given)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("build", "path", "key"),
    [
        (settings.import_rules, "recording.trial", "longest_gap_s"),
        (settings.import_rules, "sensors", "left_foot"),
        (method_of, "erkf.noise", "acc_sd_m_s2"),
        (method_of, "erkf.options", "integrator"),
    ],
)
def test_a_missing_key_is_an_error(analysis, build, path, key):
    given = spoilt(analysis("printed"), path, lambda node: node.pop(key))
    with pytest.raises(ConfigurationError, match=key):
        build(given)
